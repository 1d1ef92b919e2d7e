"""Why a glance finds a place salient: the parts add up to its saliency, and name what stands out."""

import numpy as np
import pytest

from haptic_glance.look.glance import FEATURES
from haptic_glance.look.points import saliency
from haptic_glance.look.points.reasons import WORDS, contributions, reasons
from haptic_glance.look.weights.weights import GLANCES
from haptic_glance.mesh.mesh import Mesh

from .conftest import raised_ball

SIDE, TOP = (1.0, 0, 0), (0, 0, 1.0)


@pytest.fixture(scope="module")
def knob():
    return raised_ball([SIDE], [0.15], [0.3], 5)


def nearest(mesh, place):
    return np.array([np.linalg.norm(mesh.vertices - place, axis=1).argmin()])


@pytest.mark.parametrize("method", GLANCES)
def test_the_parts_add_up_to_the_log_of_the_saliency(knob, method):
    some = np.arange(0, len(knob.vertices), 37)
    total = np.sum(list(contributions(knob, some, method).values()), axis=0)
    rest = total - np.log(saliency(knob, method)[some])
    assert np.std(rest) < 0.05 * np.std(total)


def test_a_knob_is_found_for_its_shape(knob):
    said = reasons(contributions(knob, nearest(knob, (1.3, 0, 0))))[0]
    assert "bulges out" in dict(said) and [amount for _, amount in said] == sorted(dict(said).values(), reverse=True)


def test_a_hollow_counts_against_a_place():
    dent = raised_ball([SIDE], [0.2], [-0.3], 5)
    found = contributions(dent, nearest(dent, (0.7, 0, 0)))
    assert found["convexity"] < 0 and "a hollow" not in dict(reasons(found, count=len(found))[0])
    assert dict(reasons(found, against=True)[0])["a hollow"] == pytest.approx(found["convexity"][0])


def test_words_follow_the_feature_where_its_weight_is_negative():
    assert reasons({"below": np.array([0.5])}) == [[("hidden from below", 0.5)]]
    assert reasons({"below": np.array([-0.5])}, against=True) == [[("seen from below", -0.5)]]


def test_the_axis_that_points_up_decides_what_is_high(knob):
    top = nearest(knob, TOP)
    turned = Mesh(knob.vertices[:, [1, 2, 0]], knob.faces)  # what was z is y now
    ours, theirs = contributions(knob, top), contributions(turned, top, up="y")
    assert ours["rank"][0] == pytest.approx(theirs["rank"][0], abs=0.02)
    assert contributions(turned, top)["rank"][0] < ours["rank"][0] - 0.3


def test_every_feature_has_words_and_other_methods_are_refused(knob):
    assert list(WORDS) == list(FEATURES) and len({word for pair in WORDS.values() for word in pair}) == 2 * len(WORDS)
    assert not any("up" in name for name in contributions(knob, np.array([0]), "glance_any_pose"))
    with pytest.raises(ValueError, match="glance_any_pose"):
        contributions(knob, np.array([0]), "itti")

"""The thesis's formulas as a setting: what they refuse, and what sets their two readings apart."""

import numpy as np
import pytest

from haptic_glance.look.camera import Viewpoint
from haptic_glance.look.channels import CHANNELS, conspicuity
from haptic_glance.look.channels.channels import OTHERS
from haptic_glance.look.channels.operators import pyramid
from haptic_glance.look.channels.printed import centre_surround, normalise
from haptic_glance.look.views import View, render


@pytest.fixture
def view(ball):
    return render(ball, Viewpoint(30, 20), (225, 300), renderer="raster")


@pytest.mark.parametrize(("formulas", "filled", "said"), [
    ("exact", False, "conspicuity.formulas='exact': choose one of ours, printed, mended"),
    ("printed", True, "conspicuity.formulas=printed filters whole pictures: set conspicuity.background=kept"),
])  # fmt: skip
def test_formulas_that_do_not_exist_or_do_not_go_with_the_background_are_refused(ball, view, formulas, filled, said):
    with pytest.raises(ValueError, match=said):
        conspicuity(ball, view, ["edge"], filled=filled, formulas=formulas)


@pytest.mark.parametrize("formulas", ["printed", "mended"])
def test_maps_lie_in_0_to_1_on_the_object_alone(ball, view, formulas):
    maps = conspicuity(ball, view, [*CHANNELS, *OTHERS], filled=False, formulas=formulas)
    for name, values in maps.items():
        assert values.shape == (56, 75) and values.min() >= 0 and values.max() <= 1, name
    assert maps["intensity"].max() > 0.1 and not maps["contrast"][:1].any()


def test_red_amid_red_is_conspicuous_with_the_printed_sign_alone():
    levels = pyramid(np.where(np.arange(512) < 256, 0.8, 0).astype(np.float32)[None].repeat(512, axis=0))
    printed, mended = (centre_surround(levels, True, sign)[16] for sign in (-1, 1))
    assert printed[2] > 0.8 and mended[2] < 0.01  # far from the border of the red half


def test_a_single_peak_vanishes_when_m_counts_it():
    values = np.zeros((9, 9), dtype=np.float32)
    values[4, 4] = 2
    assert not normalise(values, mended=False).any() and normalise(values, mended=True).max() == 1


def test_a_view_without_the_object_gives_maps_of_zeros(ball, view):
    away = View(view.rgb * 0, np.full_like(view.depth, np.inf), np.full_like(view.face, -1), view.viewpoint)
    maps = conspicuity(ball, away, [*CHANNELS], filled=False, formulas="printed")
    assert not any(values.any() for values in maps.values())

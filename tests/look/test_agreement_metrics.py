"""Agreement at the vertices: known values and invariances."""

from dataclasses import replace

import numpy as np
import pytest
from sklearn.metrics import roc_auc_score

from haptic_glance.look.agreement import METRICS, GroundTruth, agreement, auc, cc, kl, nss, sim


@pytest.fixture
def draw():
    return np.random.default_rng(3)


@pytest.fixture
def truth(draw):
    """Sixty vertices of different areas, gaze on about half of them."""
    amounts = draw.exponential(size=60) * (draw.random(60) < 0.5)
    return GroundTruth(amounts, draw.random(60) ** 2, draw.random(60) + 0.05)


def test_auc_equals_scikit_learn_with_weights_and_ties(truth, draw):
    saliency = np.round(draw.random(60), 1)
    labels, amounts = np.repeat([1, 0], 60), np.r_[truth.amounts / truth.amounts.sum(), truth.shares]
    expected = roc_auc_score(labels, np.r_[saliency, saliency], sample_weight=amounts)
    assert auc(saliency, truth) == pytest.approx(expected, abs=1e-12)


def test_values_worked_out_by_hand():
    # Areas 1, 1, 2; all gaze at the first vertex; the human density is 4, 0, 0 once its mean is one.
    truth = GroundTruth([5.0, 0.0, 0.0], [2.0, 0.0, 0.0], [1.0, 1.0, 2.0])
    saliency = [3.0, 1.0, 0.0]  # mean over area 1, variance (4 + 0 + 2) / 4
    assert nss(saliency, truth) == pytest.approx(2 / np.sqrt(1.5))
    assert cc(saliency, truth) == pytest.approx(2 / np.sqrt(1.5) / np.sqrt(3))
    assert cc(saliency, replace(truth, density=1e200 * truth.density)) == pytest.approx(cc(saliency, truth))
    assert auc(saliency, truth) == pytest.approx(3 / 4 + 1 / 4 / 2)
    assert sim(saliency, truth) == pytest.approx(3 / 4)
    assert kl(saliency, truth) == pytest.approx(np.log(4 / 3))


@pytest.mark.parametrize("name", METRICS)
def test_metric_ignores_vertex_order_units_and_splits(name, truth, draw):
    """Half the vertices become five each, with a fifth of the area and of the gaze: the surface is the same."""
    saliency, order, times = draw.random(60), draw.permutation(60), np.where(np.arange(60) < 30, 5, 1)
    saliency[::7] = 0  # KL's epsilon must not see the meshing either
    expected = METRICS[name](saliency, truth)
    shuffled = GroundTruth(1e-9 * truth.amounts[order], 1e12 * truth.density[order], 1e6 * truth.areas[order])
    assert METRICS[name](1e-300 * saliency[order], shuffled) == pytest.approx(expected, rel=1e-9)
    split = GroundTruth(
        np.repeat(truth.amounts / times, times), np.repeat(truth.density, times), np.repeat(truth.areas / times, times)
    )
    assert METRICS[name](np.repeat(saliency, times), split) == pytest.approx(expected, rel=1e-9)


@pytest.mark.parametrize("value", [0.0, 0.1])
def test_a_constant_saliency_is_chance_whatever_the_value_of_a_vertex_in_no_face(truth, value):
    constant = agreement(np.full(60, value), truth)
    assert (constant["cc"], constant["nss"]) == (0, 0)
    assert constant["auc"] == pytest.approx(0.5)
    assert constant["sim"] == pytest.approx(sim(np.ones(60), truth)) and 0 < constant["sim"] < 1
    assert constant["kl"] == pytest.approx(kl(np.ones(60), truth)) and constant["kl"] > 0
    lone = GroundTruth(truth.amounts, truth.density, np.r_[0.0, truth.areas[1:]])
    assert cc(np.r_[5.0, np.full(59, 0.1)], lone) == nss(np.r_[5.0, np.full(59, 0.1)], lone) == 0


def test_kl_is_zero_for_the_human_density_and_finite_for_zeros_where_people_looked(truth):
    assert 0 <= kl(truth.density, truth) < 1e-12
    half = GroundTruth([1.0, 1.0], [1.0, 1.0], [1.0, 1.0])
    assert kl([1.0, 0.0], half) == pytest.approx(0.5 * np.log(0.5) + 0.5 * np.log(2**52), rel=1e-6)


@pytest.mark.parametrize(
    ("changed", "named"),
    [
        ({"amounts": np.zeros(3)}, "empty, amounts"),
        ({"areas": [1.0, np.nan, 1.0]}, "areas must be finite"),
        ({"density": [1.0, -1.0, 1.0]}, "density must be finite and not negative"),
        ({"amounts": np.ones(4)}, "amounts must have shape"),
        ({"density": [0.0, 1.0, 1.0], "areas": [1.0, 0.0, 0.0]}, "empty, density"),  # it lies on no surface
    ],
)
def test_bad_truth_is_named(changed, named):
    arrays = {"amounts": np.ones(3), "density": np.ones(3), "areas": np.ones(3)}
    with pytest.raises(ValueError, match=named):
        GroundTruth(**arrays | changed)

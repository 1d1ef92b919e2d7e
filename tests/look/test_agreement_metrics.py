"""Agreement at the vertices: known values, invariances, and every metric again in a second, slower way."""

import numpy as np
import pytest
import trimesh
from scipy import stats

from haptic_glance.look.agreement import METRICS, GroundTruth, agreement, auc, cc, kl, nss, sim

from .conftest import as_mesh


@pytest.fixture
def draw():
    return np.random.default_rng(3)


@pytest.fixture
def truth(draw):
    """Sixty vertices of different areas, gaze on about half of them."""
    amounts = draw.exponential(size=60) * (draw.random(60) < 0.5)
    return GroundTruth(amounts, draw.random(60) ** 2, draw.random(60) + 0.05)


# Second ways: no matrix products, no ranks, every vertex as many equal samples or every pair compared.


def slow_cc(p, t):
    return np.cov(p, t.density, aweights=t.areas)[0, 1] / np.sqrt(
        np.cov(p, aweights=t.areas) * np.cov(t.density, aweights=t.areas)
    )


def slow_nss(p, t):
    mean = np.average(p, weights=t.areas)
    deviation = np.average((p - mean) ** 2, weights=t.areas) ** 0.5
    return np.average((p - mean) / deviation, weights=t.amounts)


def slow_auc(p, t):
    wins = sum(
        t.amounts[i] * t.areas[j] * (1.0 if p[i] > p[j] else 0.5 if p[i] == p[j] else 0.0)
        for i in range(len(p))
        for j in range(len(p))
    )
    return wins / t.amounts.sum() / t.areas.sum()


def slow_sim(p, t):
    a, b = p * t.areas, t.density * t.areas
    return 1 - np.abs(a / a.sum() - b / b.sum()).sum() / 2  # one minus the total variation


def slow_kl(p, t):
    return stats.entropy(t.density * t.areas, p * t.areas)


SLOW = {"cc": slow_cc, "nss": slow_nss, "auc": slow_auc, "sim": slow_sim, "kl": slow_kl}


@pytest.mark.parametrize("name", METRICS)
def test_metric_equals_its_second_way(name, truth, draw):
    saliency = np.round(draw.random(60), 1) + 0.02  # with ties
    assert METRICS[name](saliency, truth) == pytest.approx(SLOW[name](saliency, truth), rel=1e-9)


def test_values_worked_out_by_hand():
    # Areas 1, 1, 2; all gaze at the first vertex; the human density is 4, 0, 0 once its mean is one.
    truth = GroundTruth([5.0, 0.0, 0.0], [2.0, 0.0, 0.0], [1.0, 1.0, 2.0])
    saliency = [3.0, 1.0, 0.0]  # mean over area 1, variance (4 + 0 + 2) / 4
    assert nss(saliency, truth) == pytest.approx(2 / np.sqrt(1.5))
    assert cc(saliency, truth) == pytest.approx(2 / np.sqrt(1.5) / np.sqrt(3))
    assert auc(saliency, truth) == pytest.approx(3 / 4 + 1 / 4 / 2)
    assert sim(saliency, truth) == pytest.approx(3 / 4)
    assert kl(saliency, truth) == pytest.approx(np.log(4 / 3))


def test_the_human_density_itself_gets_the_best_values(truth):
    best = agreement(truth.density, truth)
    assert best["cc"] == pytest.approx(1) and best["sim"] == pytest.approx(1) and best["kl"] == pytest.approx(0)
    assert best["kl"] >= 0


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


@pytest.mark.parametrize("name", METRICS)
def test_metric_ignores_how_finely_a_place_is_meshed(name):
    """The upper half of a sphere with sixteen times the faces: the same value, but for the sampling."""
    ball = trimesh.creation.icosphere(3)
    upper = ball.triangles_center[:, 2] > 0
    lower, fine = (trimesh.Trimesh(ball.vertices, ball.faces[half]) for half in (~upper, upper))
    mixed = trimesh.util.concatenate([lower, fine.subdivide().subdivide()])
    even, uneven = as_mesh(ball), as_mesh(mixed)
    assert smooth_case(name, uneven) == pytest.approx(smooth_case(name, even), abs=0.01)
    by_count = smooth_case(name, uneven, count=True) - smooth_case(name, even, count=True)
    assert abs(by_count) > 0.03  # what vertices without their areas would give


def smooth_case(name, mesh, count=False):
    at = mesh.vertices / np.linalg.norm(mesh.vertices, axis=1, keepdims=True)
    areas = np.ones(len(at)) if count else mesh.vertex_areas
    density = np.exp(2 * at @ [0.0, 0.6, 0.8])
    return METRICS[name](np.exp(at @ [0.6, 0.0, 0.8]), GroundTruth(density * areas, density, areas))


@pytest.mark.parametrize("value", [0.0, 0.1])
def test_a_constant_saliency_is_chance(truth, value):
    constant = agreement(np.full(60, value), truth)
    assert (constant["cc"], constant["nss"]) == (0, 0)
    assert constant["auc"] == pytest.approx(0.5)
    assert constant["sim"] == pytest.approx(sim(np.ones(60), truth)) and 0 < constant["sim"] < 1
    assert constant["kl"] == pytest.approx(kl(np.ones(60), truth)) and constant["kl"] > 0


def test_a_constant_saliency_or_density_stays_chance_when_only_vertices_in_no_face_differ(truth, draw):
    lone = GroundTruth(truth.amounts, truth.density, np.r_[0.0, truth.areas[1:]])
    saliency = np.r_[5.0, np.full(59, 0.1)]
    assert cc(saliency, lone) == nss(saliency, lone) == 0
    assert cc(draw.random(60), GroundTruth(truth.amounts, np.full(60, 0.1), truth.areas)) == 0


def test_zeros_where_people_looked_are_finite_and_cost_most():
    truth = GroundTruth([1.0, 1.0], [1.0, 1.0], [1.0, 1.0])
    assert kl([1.0, 0.0], truth) == pytest.approx(0.5 * np.log(0.5) + 0.5 * np.log(2**52), rel=1e-6)


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


@pytest.mark.parametrize("name", METRICS)
def test_bad_saliency_is_named(name, truth):
    for bad in (np.ones(59), np.full(60, np.inf)):
        with pytest.raises(ValueError, match="saliency"):
            METRICS[name](bad, truth)
    if name in ("sim", "kl"):
        with pytest.raises(ValueError, match="negative"):
            METRICS[name](np.linspace(-0.5, 0.5, 60), truth)

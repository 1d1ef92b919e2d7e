"""Agreement at the vertices: known values, invariances, and every metric again in a second, slower way."""

import numpy as np
import pytest
import trimesh
from scipy import stats
from sklearn.metrics import roc_auc_score

from haptic_glance.look.agreement import METRICS, GroundTruth, agreement, auc, cc, kl, nss, sim
from haptic_glance.mesh.mesh import Mesh, corner_sum


@pytest.fixture
def draw():
    return np.random.default_rng(3)


@pytest.fixture
def truth(draw):
    """Sixty vertices of different areas, gaze on about half of them."""
    amounts = draw.exponential(size=60) * (draw.random(60) < 0.5)
    return GroundTruth(amounts, draw.random(60) ** 2, draw.random(60) + 0.05)


def vertex_areas(mesh):
    return corner_sum(mesh, np.repeat(mesh.face_areas[:, None] / 3, 3, axis=1))


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
@pytest.mark.parametrize("seed", range(4))
def test_metric_equals_its_second_way(name, seed):
    draw = np.random.default_rng(seed)
    saliency = np.round(draw.random(50) + 0.01, 1 + seed % 2)  # ties in every other round
    truth = GroundTruth(draw.exponential(size=50) * (draw.random(50) < 0.4), draw.random(50), draw.random(50))
    assert METRICS[name](saliency + 0.01, truth) == pytest.approx(SLOW[name](saliency + 0.01, truth), rel=1e-9)


@pytest.mark.parametrize("seed", range(3))
def test_auc_equals_scikit_learn_with_weights(seed):
    draw = np.random.default_rng(seed)
    saliency, amounts, areas = np.round(draw.random(300), 2), draw.exponential(size=300), draw.random(300)
    labels, weights = np.repeat([1, 0], 300), np.r_[amounts / amounts.sum(), areas / areas.sum()]
    expected = roc_auc_score(labels, np.r_[saliency, saliency], sample_weight=weights)
    assert auc(saliency, GroundTruth(amounts, amounts, areas)) == pytest.approx(expected, abs=1e-12)


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
    assert kl(truth.density, truth) >= 0


def test_no_saliency_has_a_higher_auc_than_gaze_per_area(truth, draw):
    best = auc(truth.amounts / truth.areas, truth)
    others = [truth.density, *(truth.amounts / truth.areas + draw.normal(size=(50, 60)))]
    assert 0.5 < max(auc(other, truth) for other in others) < best < 1


@pytest.mark.parametrize("transform", [np.sqrt, np.exp, lambda x: 7 * x - 3])
def test_auc_depends_on_the_order_only(truth, transform):
    assert auc(transform(truth.density), truth) == pytest.approx(auc(truth.density, truth), abs=1e-15)


def test_an_upside_down_saliency_mirrors_cc_nss_and_auc(truth, draw):
    saliency = draw.random(60)
    assert cc(-saliency, truth) == pytest.approx(-cc(saliency, truth))
    assert nss(-saliency, truth) == pytest.approx(-nss(saliency, truth))
    assert auc(-saliency, truth) == pytest.approx(1 - auc(saliency, truth))


@pytest.mark.parametrize("name", METRICS)
def test_metric_ignores_vertex_order_and_units(name, truth, draw):
    saliency, order = draw.random(60), draw.permutation(60)
    expected = METRICS[name](saliency, truth)
    shuffled = GroundTruth(1e-9 * truth.amounts[order], 1e12 * truth.density[order], 1e6 * truth.areas[order])
    assert METRICS[name](1e-300 * saliency[order], shuffled) == pytest.approx(expected, rel=1e-9)


@pytest.mark.parametrize("name", METRICS)
def test_metric_ignores_that_a_vertex_is_split_in_two(name, truth, draw):
    """Half the vertices become five each, with a fifth of the area and of the gaze: the surface is the same."""
    saliency, times = draw.random(60), np.where(np.arange(60) < 30, 5, 1)
    saliency[::7] = 0  # KL's epsilon must not see the meshing either
    split = GroundTruth(
        np.repeat(truth.amounts / times, times), *(np.repeat(x, t) for x, t in _density_areas(truth, times))
    )
    expected = METRICS[name](saliency, truth)
    assert METRICS[name](np.repeat(saliency, times), split) == pytest.approx(expected, rel=1e-9)


def _density_areas(truth, times):
    return (truth.density, times), (truth.areas / times, times)


@pytest.mark.parametrize("name", METRICS)
def test_metric_ignores_how_finely_a_place_is_meshed(name):
    """The upper half of a sphere with sixteen times the faces: the same value, but for the sampling."""
    ball = trimesh.creation.icosphere(3)
    upper = ball.triangles_center[:, 2] > 0
    lower, fine = (trimesh.Trimesh(ball.vertices, ball.faces[half]) for half in (~upper, upper))
    mixed = trimesh.util.concatenate([lower, fine.subdivide().subdivide()])
    even, uneven = (Mesh(shape.vertices, shape.faces) for shape in (ball, mixed))
    assert _smooth_case(name, uneven) == pytest.approx(_smooth_case(name, even), abs=0.01)
    by_count = _smooth_case(name, uneven, count=True) - _smooth_case(name, even, count=True)
    assert abs(by_count) > 0.03  # what vertices without their areas would give


def _smooth_case(name, mesh, count=False):
    at = mesh.vertices / np.linalg.norm(mesh.vertices, axis=1, keepdims=True)
    areas = np.ones(len(at)) if count else vertex_areas(mesh)
    density = np.exp(2 * at @ [0.0, 0.6, 0.8])
    return METRICS[name](np.exp(at @ [0.6, 0.0, 0.8]), GroundTruth(density * areas, density, areas))


@pytest.mark.parametrize("value", [0.0, 0.1, 1e9])
def test_a_constant_saliency_is_chance(truth, value):
    found = agreement(np.full(60, value), truth)
    assert (found["cc"], found["nss"]) == (0, 0)
    assert found["auc"] == pytest.approx(0.5)
    assert found["sim"] == pytest.approx(sim(np.ones(60), truth)) and 0 < found["sim"] < 1
    assert found["kl"] == pytest.approx(kl(np.ones(60), truth)) and found["kl"] > 0


def test_a_constant_saliency_stays_chance_when_only_vertices_in_no_face_differ(truth):
    lone = GroundTruth(truth.amounts, truth.density, np.r_[0.0, truth.areas[1:]])
    saliency = np.r_[5.0, np.full(59, 0.1)]
    assert cc(saliency, lone) == nss(saliency, lone) == 0


def test_an_even_density_correlates_with_nothing(truth, draw):
    assert cc(draw.random(60), GroundTruth(truth.amounts, np.full(60, 0.1), truth.areas)) == 0


def test_zeros_where_people_looked_are_finite_and_cost_most():
    truth = GroundTruth([1.0, 1.0], [1.0, 1.0], [1.0, 1.0])
    assert kl([1.0, 0.0], truth) == pytest.approx(0.5 * np.log(0.5) + 0.5 * np.log(2**52), rel=1e-6)


def test_vertices_without_area_count_for_no_distribution(truth, draw):
    saliency = draw.random(60)
    more = GroundTruth(np.r_[truth.amounts, 0.0], np.r_[truth.density, 9.0], np.r_[truth.areas, 0.0])
    assert agreement(np.r_[saliency, 0.5], more) == pytest.approx(agreement(saliency, truth))


@pytest.mark.parametrize("name", ["amounts", "density", "areas"])
@pytest.mark.parametrize("bad", [np.zeros(3), [1.0, np.nan, 1.0], [1.0, -1.0, 1.0], [1.0, np.inf, 1.0]])
def test_bad_truth_is_named(name, bad):
    arrays = {"amounts": np.ones(3), "density": np.ones(3), "areas": np.ones(3)}
    with pytest.raises(ValueError, match=name):
        GroundTruth(**arrays | {name: bad})


@pytest.mark.parametrize("name", ["amounts", "density"])
def test_truth_of_another_length_is_named(name):
    arrays = {"amounts": np.ones(3), "density": np.ones(3), "areas": np.ones(3)}
    with pytest.raises(ValueError, match=name):
        GroundTruth(**arrays | {name: np.ones(4)})


def test_density_that_lies_on_no_surface_is_empty():
    with pytest.raises(ValueError, match="empty, density"):
        GroundTruth([1.0, 1.0], [0.0, 1.0], [1.0, 0.0])


@pytest.mark.parametrize("name", METRICS)
@pytest.mark.parametrize("bad", [np.ones(59), np.ones((60, 1)), np.full(60, np.nan), np.full(60, np.inf)])
def test_bad_saliency_is_named(name, bad, truth):
    with pytest.raises(ValueError, match="saliency"):
        METRICS[name](bad, truth)


@pytest.mark.parametrize("name", ["sim", "kl"])
def test_a_negative_saliency_is_no_density(name, truth, draw):
    with pytest.raises(ValueError, match="negative"):
        METRICS[name](draw.random(60) - 0.5, truth)

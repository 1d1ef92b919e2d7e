"""Centres of fixation, their distance, and what is judged."""

import numpy as np
import pytest

from stages.fixation.agreement import agreement_rows, centre_prior, half_share, summary, task_correlations
from stages.fixation.fusion import subtractive_clusters
from stages.fixation.places import centre_distance, centres


@pytest.fixture(scope="module")
def blobs():
    """(90, 2) points of three groups of equal spread: 45, 30 and 15 points."""
    draw = np.random.default_rng(0)
    return np.concatenate([m + 0.02 * draw.normal(size=(k, 2)) for m, k in (((0, 0), 45), ((1, 0), 30), ((0, 1), 15))])


def test_each_group_has_its_centre_the_largest_first_whatever_scale_and_order(blobs):
    centre = blobs[subtractive_clusters(blobs)]
    assert np.allclose(centre, [[0, 0], [1, 0], [0, 1]], atol=0.05)
    order = np.random.default_rng(1).permutation(len(blobs))
    stretched = (blobs * [3, 50] - 7)[order]
    assert np.allclose(stretched[subtractive_clusters(stretched)], centre * [3, 50] - 7)


def test_one_place_is_one_cluster_and_the_first_has_the_highest_potential_of_the_paper():
    assert subtractive_clusters(np.ones((5, 3))).tolist() == subtractive_clusters(np.ones((1, 3))).tolist() == [0]
    points = np.array([[0.0], [0.3], [0.5], [1.0]])
    potential = np.exp(-4 * (points - points.T) ** 2 / 0.25).sum(axis=1)
    assert subtractive_clusters(points)[0] == potential.argmax() == 1


def bump(mesh, *places):
    return sum(np.exp(-((mesh.vertices - place) ** 2).sum(axis=1) / 0.01) for place in np.array(places, dtype=float))


@pytest.fixture(scope="module")
def ball(shapes):
    """(vertices, all of them seen, a bump at +x, a bump at +y)."""
    ball = shapes["ball"]
    return ball.vertices, np.ones(len(ball.vertices), bool), bump(ball, [0.5, 0, 0]), bump(ball, [0, 0.5, 0])


def test_distance_is_that_between_the_bumps_each_used_once_and_zero_to_itself(ball):
    vertices, seen, first, second = ball
    assert len(centres(vertices, first + second, seen)) == 2
    assert centre_distance(vertices, first + second, first + second, seen) == (0, 0)
    least, mean = centre_distance(vertices, first, second, seen)
    assert least == pytest.approx(np.sqrt(0.5), abs=0.06) and mean == least
    least, mean = centre_distance(vertices, first + second, second, seen)  # the first centre may take the only answer
    assert least == mean


def test_only_what_is_seen_counts_and_a_constant_map_has_no_centre(ball):
    vertices, seen, first, second = ball
    assert centre_distance(vertices, second, 5 * first + second, vertices[:, 0] < 0.2)[0] < 0.1
    for even in (np.zeros(len(seen)), np.ones(len(seen))):
        assert np.isnan(centre_distance(vertices, first, even, seen)).all()


def test_maximum_to_the_letter_is_one_place_where_the_regions_are_two(ball):
    vertices, seen, first, second = ball
    joined = first + 1.01 * second
    assert len(centres(vertices, joined, seen)) == 2 and len(centres(vertices, joined, seen, top=1)) == 1
    assert centre_distance(vertices, first, joined, seen)[0] < 0.05
    assert centre_distance(vertices, first, joined, seen, top=1)[0] == pytest.approx(np.sqrt(0.5), abs=0.06)


def test_an_even_saliency_has_half_on_half_of_the_surface_and_a_small_one_on_less():
    areas = np.random.default_rng(0).random(4000)
    even = np.where(np.arange(4000) < 3999, 1.0, 0.0)
    assert half_share(even, areas) == pytest.approx(0.5, abs=0.01)
    tenth = (np.cumsum(areas) < areas.sum() / 10).astype(float)
    assert half_share(tenth, areas) == pytest.approx(0.05, abs=0.002)
    assert half_share(tenth, areas) == pytest.approx(half_share(3 * tenth + 7, areas))  # of no zero and no unit
    assert np.isnan(half_share(np.ones(4000), areas)) and np.isnan(half_share(even, np.zeros(4000)))
    assert half_share(np.array([1.0, 1.0, 0.0]), np.array([3.0, 3.0, 6.0])) == pytest.approx(0.25)


@pytest.fixture
def lesson(shapes):
    ball = shapes["ball"]
    density = bump(ball, [0.5, 0, 0], [-0.3, 0.4, 0])
    return {"amounts": np.where(density > 0.5, 1.0, 0), "density": density, "areas": ball.vertex_areas}


def value_of(rows, metric, view):
    return next(row["value"] for row in rows if row["metric"] == metric and row["view"] == view)


def test_the_truth_agrees_with_itself_and_noise_does_not(shapes, lesson):
    ball, seen = shapes["ball"], np.stack([shapes["ball"].vertices[:, k] > 0 for k in range(3)])
    same = agreement_rows(ball, lesson, seen, np.stack([lesson["density"]] * 3), lesson["density"])
    values = np.random.default_rng(0).random(len(ball.vertices))
    noise = agreement_rows(ball, lesson, seen, np.stack([values] * 3), values)
    for view in range(3):
        assert value_of(same, "pcc", view) == pytest.approx(1) and value_of(same, "distance", view) == 0
        assert abs(value_of(noise, "pcc", view)) < 0.1
        assert value_of(same, "half_share", view) < 0.1 < 0.25 < value_of(noise, "half_share", view) < 0.35
        assert value_of(same, "distance_maximum", view) == 0
    assert value_of(same, "auc", "all") > 0.95 > 0.6 > value_of(noise, "auc", "all")
    assert value_of(same, "nss", "all") > 3 > abs(value_of(noise, "nss", "all"))


@pytest.mark.slow
def test_a_view_where_nobody_looked_is_left_out_and_what_is_visible_passes_for_agreement_where_the_hidden_count(
    shapes, lesson
):
    ball = shapes["ball"]
    front, back = ball.vertices[:, 0] > 0, ball.vertices[:, 0] < -0.1
    lesson = lesson | {"amounts": np.where(front, lesson["amounts"], 0)}
    even = np.random.default_rng(0).uniform(0.99, 1, (3, len(ball.vertices)))
    rows = agreement_rows(ball, lesson, np.stack([front, back, np.ones_like(front)]), even, even[0])
    assert {row["view"] for row in rows} == {0, 2, "all"}
    assert abs(value_of(rows, "pcc", 0)) < 0.1 < value_of(rows, "pcc_masked", 0)


def test_tasks_correlate_where_they_are_seen_and_constant_maps_with_nothing():
    values = np.random.default_rng(0).random((2, 3, 50))
    values[:, 1] = values[:, 0] * 2 + 1
    values[0, 2] = 0.5
    seen = np.ones((2, 50), dtype=bool)
    rows = {row["task"]: row["value"] for row in task_correlations(values, seen, ["a", "b", "c"])}
    assert rows["a~b"] == pytest.approx(1)
    assert rows["a~c"] == pytest.approx(np.corrcoef(values[1, 0], values[1, 2])[0, 1])
    assert {row["value"] for row in task_correlations(np.ones((1, 2, 5)), seen[:1, :5], ["a", "b"])} == {None}


def test_the_centre_prior_is_highest_in_the_middle():
    prior = centre_prior(9)
    assert np.unravel_index(prior.argmax(), prior.shape) == (4, 4) and prior[4, 4] == 1 and (prior == prior.T).all()


def test_models_and_controls_have_their_mean_correlation_in_the_metrics():
    rows = [
        {"item": k, "method": method, "task": task, "view": view, "metric": "pcc", "value": base + slope * k}
        for k in range(6)
        for view in range(3)
        for method, task, base, slope in (  # equal differences would have no interval
            ("net-frozen", "ewigc", 0.4, 0.01), ("net-random", "ewigc", 0.1, 0.02),
            ("control", "centre_prior", 0.7, 0.02), ("other-random", "ewigc", 0.0, 0.01),
        )
    ]  # fmt: skip
    numbers = summary(rows, {"level_1": 2}, 0)
    assert numbers["pcc"]["net-frozen"]["value"] == pytest.approx(0.425) and numbers["classes"] == {"level_1": 2}

"""Points of a whole object, by every method."""

import dataclasses

import numpy as np
import pytest
import trimesh

from haptic_glance.base.rng import rng
from haptic_glance.look.channels import ViewMaps
from haptic_glance.look.points import METHODS, best_viewpoints, find_points, saliency
from haptic_glance.look.points.detectors import FusedDetector, random_vertices
from haptic_glance.look.points.fuse import continue_on_surface, merge_views
from haptic_glance.look.points.methods import find_all, split_runnable
from haptic_glance.look.points.options import Options
from haptic_glance.look.views import FOUR, TWELVE
from haptic_glance.look.weights import LearnedWeights, weights
from haptic_glance.mesh import normalise
from haptic_glance.mesh.mesh import Mesh
from stages.conspicuity.measure import parse_viewpoint
from tests.shapes import flat_grid, mesh_of, together

RUNS, _ = split_runnable(METHODS, LearnedWeights())  # the others need a run of the stage `weights`
NOTHING = Mesh(np.zeros((3, 3)), [[0, 1, 2]])


def weighted(channel_weights):
    """Options whose method `thesis_ssim` has these weights."""
    return Options(LearnedWeights({"thesis_ssim": channel_weights}))


def shuffled(mesh):
    """(the same mesh with its vertices in another order, old id of each new vertex)."""
    old = np.random.default_rng(0).permutation(len(mesh.vertices))
    return Mesh(mesh.vertices[old], np.argsort(old)[mesh.faces]), old


@pytest.fixture(scope="module")
def nose(ball):
    """The ball with a small ball on it."""
    return together(ball, mesh_of(trimesh.creation.icosphere(2, 0.12).apply_translation([0.45, 0, 0.2])))


@pytest.fixture(scope="module")
def box(make_maps):
    """(a box with a vertex in no face, its ViewMaps)."""
    shape = trimesh.creation.box(extents=[0.5, 0.5, 0.5])
    mesh = Mesh(np.r_[shape.vertices, [[0, 0, 0]]], shape.faces)
    return mesh, ViewMaps(mesh, FOUR, make_maps(mesh, np.array([0.25, 0.25, 0.25]), FOUR))


@pytest.mark.parametrize("method", RUNS)
@pytest.mark.slow
def test_count_is_honoured_without_duplicates_and_a_peak_on_the_maps_gives_the_vertex_there(
    method, sight, ball, spot, box
):
    detector = METHODS[method]
    if detector.channels:
        detection = detector.find(ball, sight, Options(), 200)
    else:  # of a smaller mesh, since spectra take the cube of its vertices
        small = trimesh.creation.icosphere(subdivisions=2, radius=0.5)
        detection = detector.find(Mesh(small.vertices, small.faces), None, Options(), 100)
    assert len(detection.points) == len(set(detection.points)) == (200 if detector.channels else 100)
    if isinstance(detector, FusedDetector):
        for vertex in (detection.points[0], detection.saliency.argmax()):
            assert np.linalg.norm(ball.vertices[vertex] - spot) < 0.04
    assert sorted(detector.find(*box, Options(), 20).points) == list(range(8))  # too few vertices: all of them


class Everywhere:
    """An SVM that takes every pixel for salient."""

    def predict(self, rows):
        return np.ones(len(rows))


def test_an_svm_keeps_32_points_far_apart(sight, ball):
    options = Options(LearnedWeights(svms={"svm": {0: Everywhere()}}))
    detection = METHODS["svm"].find(ball, sight, options, 60)
    assert detection.strong == 32 and len(detection.points) == len(set(detection.points)) == 60
    far = ball.vertices[detection.points[:32]]
    gaps = np.linalg.norm(far[:, None] - far, axis=2) + 9 * np.eye(32)
    assert gaps.min() > 3 * options.radius
    assert METHODS["svm"].find(ball, sight, options).points.tolist() == detection.points[:32].tolist()


def test_strong_points_come_first_and_more_points_change_none_of_them_and_keep_apart(sight, ball):
    strong = METHODS["thesis_ssim"].find(ball, sight, Options(radius=0.1))
    more = METHODS["thesis_ssim"].find(ball, sight, Options(radius=0.1), 60)
    assert strong.strong == len(strong.points) == more.strong
    assert (more.points[: more.strong] == strong.points).all()
    places = ball.vertices[more.points]
    assert np.linalg.norm(places[:, None] - places[None], axis=2)[np.triu_indices(60, 1)].min() > 0.1
    detections, _ = find_all(ball, sight, ["random", "itti"], Options(), 30)
    assert detections["random"].strong == detections["itti"].strong < 30  # random has as many as the first method


def test_maps_without_a_signal_have_no_strong_points_but_honour_a_count(ball):
    blank = ViewMaps(ball, FOUR, dict.fromkeys(weights("equal"), np.zeros((4, 75, 100))))
    assert len(METHODS["thesis_ssim"].find(ball, blank, Options()).points) == 0
    detection = METHODS["thesis_ssim"].find(ball, blank, Options(), 10)
    assert (len(detection.points), detection.strong) == (10, 0) and not detection.saliency.any()


def test_weights_decide_between_channels_and_merged_methods_hold_the_points_of_their_parts(ball, make_maps):
    on_x, on_y = np.array([0.5, 0, 0]), np.array([0, 0.5, 0])
    maps = make_maps(ball, on_x) | make_maps(ball, on_y, channels=("curvature",))
    sight = ViewMaps(ball, TWELVE, maps)
    for winner, place in (("edge", on_x), ("curvature", on_y)):
        options = weighted(dict.fromkeys(weights("equal"), 0.01) | {winner: 1.0})
        first = METHODS["thesis_ssim"].find(ball, sight, options, 1).points[0]
        assert np.linalg.norm(ball.vertices[first] - place) < 0.05
    places = ball.vertices[METHODS["VisAttCurvP"].find(ball, sight, Options()).points]
    for place in (on_x, on_y):
        assert min(np.linalg.norm(places - place, axis=1)) < 0.05
    pair = [METHODS[method].saliency(ball, sight, Options()) for method in ("VisAttCurvP", "VisAtt")]
    assert (pair[0] == pair[1]).all()


def test_one_feature_seen_in_many_views_is_one_point(ball):
    near = np.argsort(np.linalg.norm(ball.vertices - [0.5, 0, 0], axis=1))
    candidates = np.r_[near[:3], near[-1]]
    points, strong = merge_views(ball, candidates, np.array([0.5, 0.7, 0.6, 0.9]), np.array([1, 1, 1, 0], bool), 0.1)
    assert points.tolist() == [near[1], near[-1]]  # the brightest of the strong ones, then the weak one
    assert strong == 1


def test_coincident_and_equally_salient_vertices_do_not_hold_up_a_count_or_go_by_their_number(ball):
    none = np.zeros(0, dtype=np.int64)
    mesh = Mesh(np.tile(np.eye(3), (2, 1)), [[0, 1, 2], [3, 4, 5]])
    assert sorted(continue_on_surface(mesh, none, np.ones(6), 0.1, 6)) == list(range(6))
    other, old = shuffled(ball)
    flat = np.ones(len(ball.vertices))
    points = continue_on_surface(other, none, flat, 0.1, 20)
    assert (continue_on_surface(ball, none, flat, 0.1, 20) == old[points]).all()


@pytest.mark.slow
@pytest.mark.parametrize("selection", ["suppression", "centroid"])
def test_points_do_not_depend_on_the_order_of_the_vertices(selection, ball, spot, make_maps):
    other, old = shuffled(ball)
    options, maps = Options(selection=selection), make_maps(ball, spot)
    before, after = (
        find_all(mesh, ViewMaps(mesh, TWELVE, maps), ["thesis_ssim", "random"], options, 60)[0]
        for mesh in (ball, other)
    )
    for method in ("thesis_ssim", "random"):
        assert (before[method].points == old[after[method].points]).all()
    assert np.allclose(before["thesis_ssim"].saliency[old], after["thesis_ssim"].saliency, atol=1e-5)


@pytest.mark.slow
def test_points_and_saliency_from_a_bare_mesh_do_not_depend_on_its_place_and_size(ball, nose):
    moved = Mesh(nose.vertices * 8 + 0.25, nose.faces)
    values = [saliency(mesh, "VisAttCurv", viewpoints=FOUR[:2]) for mesh in (nose, moved)]
    assert values[0].shape == (len(nose.vertices),) and values[0].max() == 1 and values[0].min() >= 0
    assert np.abs(values[0] - values[1]).max() < 0.02
    first = [find_points(mesh, "VisAttCurv", 1, viewpoints=FOUR[:2])[0] for mesh in (nose, moved)]
    assert np.linalg.norm(normalise(nose).vertices[first[0]] - normalise(nose).vertices[first[1]]) < 0.02
    assert first[0] >= len(ball.vertices)  # on the nose


@pytest.mark.parametrize("method", ["glance", "height"])
@pytest.mark.slow
def test_the_axis_that_points_up_may_be_named(method):
    shape = trimesh.creation.revolve([[0, -0.4], [0.3, -0.3], [0.1, 0.4], [0, 0.45]], sections=24)
    upright, lying = (Mesh(vertices, shape.faces) for vertices in (shape.vertices, shape.vertices[:, [1, 2, 0]]))
    values = [saliency(mesh, method) for mesh in (upright, lying)]
    turned = saliency(lying, method, up="y")
    assert np.abs(turned - values[0]).max() < 0.1 < np.abs(values[1] - values[0]).max()
    with pytest.raises(ValueError, match="up axis 'w'"):
        saliency(lying, method, up="w")
    if method == "glance":  # for which a vertex in no face changes nothing
        stray = saliency(Mesh(np.r_[shape.vertices, [[3, 3, 3]]], shape.faces), method)
        assert np.abs(values[0] - stray[:-1]).max() < 1e-6 and stray[-1] == 0


def test_random_points_are_uniform_over_the_area():
    # A square whose left half is one large square, its right half 50 x 50 small ones; 3 in 4 of the area on the left.
    big = Mesh([[0, 0, 0], [0.75, 0, 0], [0.75, 1, 0], [0, 1, 0]], [[0, 1, 2], [0, 2, 3]])
    fine = Mesh(flat_grid(51, 51).vertices / [200, 50, 1] + [0.75, 0, 0], flat_grid(51, 51).faces)
    mesh = together(big, fine)
    first = np.array([random_vertices(mesh, 1, rng(0, f"draw {k}"))[0] for k in range(800)])
    assert abs((first < 4).mean() - 0.75) < 0.05  # standard error 0.015
    assert np.abs(np.bincount(first[first < 4], minlength=4) / 800 - [0.25, 0.125, 0.25, 0.125]).max() < 0.08


def test_random_points_depend_on_seed_name_and_number_of_the_draw_alone(ball):
    draws = {
        key: find_points(ball, key[0], 20, seed=key[1], name=key[2]).tolist()
        for key in (("random", 3, "duck"), ("random", 3, "cup"), ("random", 4, "duck"), ("random+2", 3, "duck"))
    }
    assert len(set(map(tuple, draws.values()))) == 4
    assert find_points(ball, "random", 20, seed=3, name="duck").tolist() == draws["random", 3, "duck"]
    assert sorted(find_points(ball, "random", 10**7)) == list(range(len(ball.vertices)))  # more than there are: all


@pytest.mark.parametrize("method", ["random", "farthest"])
def test_methods_without_a_saliency_give_as_many_points_as_asked_for_where_there_are_any(method):
    parts = [trimesh.creation.icosphere(1, radius=1e-4)] * 2 + [trimesh.Trimesh(np.eye(3), [[0, 1, 2]])]
    tiny_and_doubled = trimesh.util.concatenate(parts)
    points = find_points(Mesh(tiny_and_doubled.vertices, tiny_and_doubled.faces), method, 87)
    assert sorted(points) == list(range(87))


def test_a_viewpoint_comes_back_from_its_name():
    for viewpoint in TWELVE:
        turned = dataclasses.replace(viewpoint, roll=-22.5)
        assert parse_viewpoint(viewpoint.name) == viewpoint and parse_viewpoint(turned.name) == turned


@pytest.mark.parametrize(
    ("call", "message"),
    [
        (lambda mesh: find_points(mesh, "glanc"), "unknown method 'glanc'.*glance"),
        (lambda mesh: find_points(mesh, "random"), "give a count"),
        (lambda mesh: find_points(mesh, "random", 0), "at least 1"),
        (lambda mesh: find_points(mesh, "random", 2.5), "whole number"),
        (lambda mesh: find_points(mesh, "random", np.nan), "whole number of at least 1, got nan"),
        (lambda mesh: find_points(mesh, "random", "3"), "whole number of at least 1, got '3'"),
        (lambda mesh: find_points(mesh, True), "whole number of at least 1, got True"),
        (lambda mesh: find_points(mesh, 3, radius="1mm"), "radius is a length in units .*, got '1mm'"),
        (lambda mesh: saliency(mesh, "itti", viewpoints=[1]), "viewpoints must be of the class Viewpoint, got 1"),
        (lambda mesh: find_points(mesh, "random", 5, selection="brightest"), "unknown selection 'brightest'"),
        (lambda mesh: find_points(mesh, "random", 5, radius=0), "radius must be positive"),
        (lambda mesh: find_points(mesh, "random", 5, radius=np.inf), "both finite, got inf"),
        (lambda mesh: saliency(mesh, "height", smoothing=np.inf), "both finite, got .*inf"),
        (lambda mesh: find_points(mesh, "glance", weights="ssim"), "unknown weights 'ssim'"),
        (lambda mesh: find_points(mesh, "itti", weights="equal"), "'itti' has no weights"),
        (lambda mesh: saliency(mesh, "guided_ssim"), "needs weights that the stage `weights` learns"),
        (lambda mesh: saliency(mesh, "glance", weights={"shine": 1.0}), "no feature shine"),
        (lambda mesh: saliency(mesh, "guided_ssim", weights=[1, 2]), "must be a dict of channels"),
        (lambda mesh: saliency(mesh, "guided_ssim", weights={"color": "much"}), "weights as numbers"),
        (lambda mesh: saliency(mesh, "svm", weights="equal"), "run the pipeline for it"),
        (lambda mesh: saliency(mesh, "itti", viewpoints=[]), "no viewpoints"),
        (lambda mesh: saliency(mesh, "height", viewpoints=[]), "no viewpoints"),
        (lambda mesh: find_points(mesh, viewpoints=[]), "no viewpoints"),
        (lambda mesh: best_viewpoints(mesh, "glance"), "unknown channel"),
        (lambda mesh: saliency(mesh, "random"), "has no saliency"),
        (lambda mesh: find_points(NOTHING, "random", 5), "no extent"),
        (lambda mesh: random_vertices(NOTHING, 5, rng(0, "")), "no area"),
        (lambda mesh: parse_viewpoint("front"), "'front' is not the name of a viewpoint"),
    ],
)
def test_bad_input_is_an_error_with_a_remedy(call, message, ball):
    with pytest.raises(ValueError, match=message):
        call(ball)


def test_bad_weights_and_a_channel_without_a_map_are_named(box, ball, make_maps):
    equal = dict.fromkeys(weights("equal"), 1.0)
    for wrong, message in (({"edge": -1.0}, "not negative"), ({"shine": 1.0}, "without a map: shine")):
        with pytest.raises(ValueError, match=message):
            METHODS["thesis_ssim"].find(*box, weighted(equal | wrong))
    sight = ViewMaps(ball, FOUR, make_maps(ball, np.zeros(3), FOUR, channels=("color", "intensity")))
    with pytest.raises(ValueError, match="no map for orientation"):
        METHODS["itti"].find(ball, sight, Options())


@pytest.mark.slow
@pytest.mark.parametrize("shape", [trimesh.creation.capsule(1, 0.3), trimesh.creation.icosphere(3)])
def test_places_of_a_symmetric_mesh_depend_neither_on_units_nor_on_the_corner_that_comes_first(shape):
    mesh = Mesh(shape.vertices * [1, 0.7, 0.5], shape.faces)
    other = Mesh(mesh.vertices * 1e-3, np.roll(mesh.faces, 1, axis=1))
    points = find_points(mesh, "glance", 6)
    assert len(points) == 6 and points.tolist() == find_points(other, "glance", 6).tolist()
    assert points[:2].tolist() == find_points(mesh, "glance")[:2].tolist()  # the strongest places come first in both

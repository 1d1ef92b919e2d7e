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
from stages.salient_points.measure import read_points, read_saliency, read_strong_points, write_points

RUNS, _ = split_runnable(METHODS, LearnedWeights())  # the others need a run of the stage `weights`
FUSED = [name for name in RUNS if isinstance(METHODS[name], FusedDetector)]


def weighted(given):
    """Options whose method `thesis_ssim` has these weights."""
    return Options(LearnedWeights({"thesis_ssim": given}))


def shuffled(mesh, seed=0):
    """(the same mesh with its vertices in another order, old id of each new vertex)."""
    old = np.random.default_rng(seed).permutation(len(mesh.vertices))
    return Mesh(mesh.vertices[old], np.argsort(old)[mesh.faces]), old


@pytest.mark.parametrize("method", FUSED)
def test_a_peak_on_the_maps_gives_the_vertex_there(method, sight, ball, spot):
    found = METHODS[method].find(ball, sight, Options())
    assert np.linalg.norm(ball.vertices[found.points[0]] - spot) < 0.04
    assert np.linalg.norm(ball.vertices[found.saliency.argmax()] - spot) < 0.04


def test_only_the_glance_for_any_pose_ignores_the_pose():
    head = trimesh.creation.icosphere(3, radius=0.15).apply_translation([0.3, 0, 0.3])
    shape = trimesh.util.concatenate([trimesh.creation.box((0.7, 0.3, 0.4)).subdivide_to_size(0.05), head])
    turned = shape.vertices @ trimesh.transformations.rotation_matrix(2.0, [1, 2, 3])[:3, :3].T
    agreement = {}
    for method in ("glance", "glance_any_pose"):
        values = [saliency(Mesh(vertices, shape.faces), method) for vertices in (shape.vertices, turned)]
        agreement[method] = np.corrcoef(*values)[0, 1]
    assert agreement["glance_any_pose"] > 0.85 and agreement["glance"] < 0.7, agreement  # samples are drawn anew


@pytest.mark.slow
@pytest.mark.parametrize("method", RUNS)
@pytest.mark.parametrize("count", [1, 25, 200])
def test_count_is_honoured_without_duplicates(method, count, sight, ball):
    if not METHODS[method].channels:  # of a smaller mesh, since spectra take the cube of its vertices
        small = trimesh.creation.icosphere(subdivisions=3, radius=0.5)
        ball, sight = Mesh(small.vertices, small.faces), None
    points = METHODS[method].find(ball, sight, Options(), count).points
    assert len(points) == len(set(points)) == count


@pytest.mark.slow
@pytest.mark.parametrize("method", RUNS)
def test_a_mesh_with_too_few_vertices_gives_all_of_them(method, make_maps):
    box = trimesh.creation.box(extents=[0.5, 0.5, 0.5])
    mesh = Mesh(np.r_[box.vertices, [[0, 0, 0]]], box.faces)  # the last vertex is in no face
    sight = ViewMaps(mesh, FOUR, make_maps(mesh, np.array([0.25, 0.25, 0.25]), FOUR))
    assert sorted(METHODS[method].find(mesh, sight, Options(), 20).points) == list(range(8))


def test_points_keep_apart_while_there_is_room(sight, ball):
    options = Options(radius=0.1)
    places = ball.vertices[METHODS["thesis_ssim"].find(ball, sight, options, 60).points]
    apart = np.linalg.norm(places[:, None] - places[None], axis=2)[np.triu_indices(60, 1)]
    assert apart.min() > 0.1


class Everywhere:
    """An SVM that takes every pixel for salient."""

    def predict(self, rows):
        return np.ones(len(rows))


@pytest.mark.parametrize("count", [None, 60])
def test_an_svm_keeps_32_points_far_apart(sight, ball, count):
    options = Options(LearnedWeights(svms={"svm": {0: Everywhere()}}))
    found = METHODS["svm"].find(ball, sight, options, count)
    assert found.strong == 32 and len(found.points) == len(set(found.points)) == (count or 32)
    far = ball.vertices[found.points[:32]]
    gaps = np.linalg.norm(far[:, None] - far, axis=2) + 9 * np.eye(32)
    assert gaps.min() > 3 * options.radius


def test_strong_points_come_first_and_more_points_change_none_of_them(sight, ball):
    strong = METHODS["thesis_ssim"].find(ball, sight, Options())
    more = METHODS["thesis_ssim"].find(ball, sight, Options(), 40)
    assert strong.strong == len(strong.points) == more.strong
    assert (more.points[: more.strong] == strong.points).all()


def test_maps_without_a_signal_have_no_strong_points_but_honour_a_count(ball):
    blank = ViewMaps(ball, FOUR, dict.fromkeys(weights("equal"), np.zeros((4, 75, 100))))
    assert len(METHODS["thesis_ssim"].find(ball, blank, Options()).points) == 0
    found = METHODS["thesis_ssim"].find(ball, blank, Options(), 10)
    assert (len(found.points), found.strong) == (10, 0)
    assert not found.saliency.any()


def test_weights_decide_between_channels(ball, make_maps):
    here, there = np.array([0.5, 0, 0]), np.array([0, 0.5, 0])
    maps = make_maps(ball, here, channels=("edge",)) | make_maps(ball, there, channels=("color",))
    blank = dict.fromkeys(weights("equal"), np.zeros_like(maps["edge"]))
    sight = ViewMaps(ball, TWELVE, blank | maps)
    for winner, place in (("edge", here), ("color", there)):
        options = weighted(dict.fromkeys(weights("equal"), 0.1) | {winner: 1.0})
        first = METHODS["thesis_ssim"].find(ball, sight, options, 1).points[0]
        assert np.linalg.norm(ball.vertices[first] - place) < 0.05


def test_merged_methods_hold_the_points_of_their_parts(ball, make_maps):
    here, there = np.array([0.5, 0, 0]), np.array([-0.5, 0, 0])
    maps = make_maps(ball, here) | make_maps(ball, there, channels=("curvature",))
    sight = ViewMaps(ball, TWELVE, maps)
    places = ball.vertices[METHODS["VisAttCurvP"].find(ball, sight, Options()).points]
    assert min(np.linalg.norm(places - here, axis=1)) < 0.05
    assert min(np.linalg.norm(places - there, axis=1)) < 0.05
    pair = [METHODS[method].saliency(ball, sight, Options()) for method in ("VisAttCurvP", "VisAtt")]
    assert (pair[0] == pair[1]).all()


def test_one_feature_seen_in_many_views_is_one_point(ball):
    near = np.argsort(np.linalg.norm(ball.vertices - [0.5, 0, 0], axis=1))
    candidates = np.r_[near[:3], near[-1]]
    points, strong = merge_views(ball, candidates, np.array([0.5, 0.7, 0.6, 0.9]), np.array([1, 1, 1, 0], bool), 0.1)
    assert points.tolist() == [near[1], near[-1]]  # the brightest of the strong ones, then the weak one
    assert strong == 1


def test_coincident_vertices_do_not_hold_up_a_count():
    mesh = Mesh(np.tile(np.eye(3), (2, 1)), [[0, 1, 2], [3, 4, 5]])
    points = continue_on_surface(mesh, np.zeros(0, dtype=np.int64), np.ones(6), 0.1, 6)
    assert sorted(points) == list(range(6))


def test_equally_salient_vertices_do_not_go_by_their_number(ball):
    other, old = shuffled(ball)
    none, flat = np.zeros(0, dtype=np.int64), np.ones(len(ball.vertices))
    points = continue_on_surface(other, none, flat, 0.1, 20)
    assert (continue_on_surface(ball, none, flat, 0.1, 20) == old[points]).all()


@pytest.mark.slow
@pytest.mark.parametrize("selection", ["suppression", "centroid"])
def test_points_do_not_depend_on_the_order_of_the_vertices(selection, ball, spot, make_maps):
    other, old = shuffled(ball)
    options = Options(selection=selection)
    found = []
    for mesh in (ball, other):
        sight = ViewMaps(mesh, TWELVE, make_maps(mesh, spot))
        found.append(find_all(mesh, sight, ["thesis_ssim", "random"], options, 60)[0])
    for method in ("thesis_ssim", "random"):
        assert (found[0][method].points == old[found[1][method].points]).all()
    assert np.allclose(found[0]["thesis_ssim"].saliency[old], found[1]["thesis_ssim"].saliency, atol=1e-5)


@pytest.mark.slow
def test_points_and_saliency_from_a_bare_mesh_do_not_depend_on_its_place_and_size(ball):
    nose = trimesh.creation.icosphere(subdivisions=2, radius=0.12)
    mesh = Mesh(
        np.r_[ball.vertices, nose.vertices + [0.45, 0, 0.2]], np.r_[ball.faces, nose.faces + len(ball.vertices)]
    )
    moved = Mesh(mesh.vertices * 8 + 0.25, mesh.faces)
    values = [saliency(m, "VisAttCurv", viewpoints=FOUR[:2]) for m in (mesh, moved)]
    assert values[0].shape == (len(mesh.vertices),) and values[0].max() == 1 and values[0].min() >= 0
    assert np.abs(values[0] - values[1]).max() < 0.02
    first = [find_points(m, "VisAttCurv", 1, viewpoints=FOUR[:2])[0] for m in (mesh, moved)]
    assert np.linalg.norm(normalise(mesh).vertices[first[0]] - normalise(mesh).vertices[first[1]]) < 0.02
    assert first[0] >= len(ball.vertices)  # on the nose


@pytest.mark.slow
@pytest.mark.parametrize("method", ["glance", "height"])
def test_the_axis_that_points_up_may_be_named(method):
    profile = [[0, -0.4], [0.3, -0.3], [0.1, 0.4], [0, 0.45]]
    shape = trimesh.creation.revolve(profile, sections=24)
    upright = Mesh(shape.vertices, shape.faces)
    lying = Mesh(shape.vertices[:, [1, 2, 0]], shape.faces)  # its y points up
    found = [saliency(*given, viewpoints=FOUR[:2]) for given in ((upright, method), (lying, method))]
    turned = saliency(lying, method, viewpoints=FOUR[:2], up="y")
    assert np.abs(turned - found[0]).max() < 0.1 < np.abs(found[1] - found[0]).max()
    with pytest.raises(ValueError, match="up axis 'w'"):
        saliency(lying, method, up="w")


@pytest.mark.slow
def test_random_points_are_uniform_over_the_area():
    # A square whose left half is one large square, its right half 50 x 50 small ones; 3 in 4 of the area on the left.
    line = np.linspace(0.75, 1, 51)
    y, x = (grid.ravel() for grid in np.meshgrid(np.linspace(0, 1, 51), line, indexing="ij"))
    ids = np.arange(51 * 51).reshape(51, 51)
    a, b, c, d = (part.ravel() for part in (ids[:-1, :-1], ids[:-1, 1:], ids[1:, 1:], ids[1:, :-1]))
    big = np.array([[0, 0, 0], [0.75, 0, 0], [0.75, 1, 0], [0, 1, 0]])
    faces = np.r_[[[0, 1, 2], [0, 2, 3]], 4 + np.c_[a, b, c], 4 + np.c_[a, c, d]]
    mesh = Mesh(np.r_[big, np.c_[x, y, 0 * x]], faces)
    first = np.array([random_vertices(mesh, 1, rng(0, f"draw {k}"))[0] for k in range(800)])
    assert abs((first < 4).mean() - 0.75) < 0.05  # standard error 0.015
    assert np.abs(np.bincount(first[first < 4], minlength=4) / 800 - [0.25, 0.125, 0.25, 0.125]).max() < 0.08


def test_more_random_points_than_vertices_are_all_vertices(ball):
    assert sorted(find_points(ball, "random", 10**7)) == list(range(len(ball.vertices)))


@pytest.mark.slow
@pytest.mark.parametrize("method", ["glance", "mesh_saliency", "salient_points", "harris"])
def test_a_vertex_in_no_face_changes_nothing(method, ball):
    nose = trimesh.creation.icosphere(subdivisions=2, radius=0.12)
    vertices = np.r_[ball.vertices, nose.vertices + [0.45, 0, 0.2]]
    mesh = Mesh(vertices, np.r_[ball.faces, nose.faces + len(ball.vertices)])
    stray = Mesh(np.r_[vertices, [[3, 3, 3]]], mesh.faces)
    clean, odd = (saliency(each, method, viewpoints=FOUR[:2]) for each in (mesh, stray))
    assert np.abs(clean - odd[:-1]).max() < 1e-6 and odd[-1] == 0


def test_random_points_depend_on_seed_and_name_alone(ball):
    first = find_points(ball, "random", 20, seed=3, name="duck")
    find_points(ball, "random", 20, seed=3, name="cup")
    assert (find_points(ball, "random", 20, seed=3, name="duck") == first).all()
    assert (find_points(ball, "random", 20, seed=3, name="cup") != first).any()
    assert (find_points(ball, "random", 20, seed=4, name="duck") != first).any()


def test_draws_of_blind_touch_differ_and_the_first_is_random_itself(ball):
    draws = [find_points(ball, name, 20, name="duck").tolist() for name in ("random", "random_2", "random_3")]
    assert draws[0] != draws[1] != draws[2] != draws[0]
    assert find_points(ball, "random_2", 20, name="duck").tolist() == draws[1]


def test_random_gets_as_many_strong_points_as_the_first_method(sight, ball):
    found, _ = find_all(ball, sight, ["random", "itti"], Options(), 30)
    assert found["random"].strong == found["itti"].strong < 30


def test_file_gives_back_points_strong_points_and_saliency(sight, ball, tmp_path):
    found, _ = find_all(ball, sight, ["glance", "random"], Options(), 30)
    write_points(tmp_path / "ball.npz", found)
    points, strong = read_points(tmp_path / "ball.npz"), read_strong_points(tmp_path / "ball.npz")
    assert list(points) == ["glance", "random"]
    assert (points["glance"] == found["glance"].points).all()
    assert len(strong["glance"]) == found["glance"].strong
    assert list(read_saliency(tmp_path / "ball.npz")) == ["glance"]


@pytest.mark.parametrize("viewpoint", TWELVE, ids=lambda viewpoint: viewpoint.name)
def test_a_viewpoint_comes_back_from_its_name(viewpoint):
    assert parse_viewpoint(viewpoint.name) == viewpoint
    turned = dataclasses.replace(viewpoint, roll=-22.5)
    assert parse_viewpoint(turned.name) == turned


@pytest.mark.slow
@pytest.mark.parametrize(
    ("call", "message"),
    [
        (lambda mesh: find_points(mesh, "glanc"), "unknown method 'glanc'.*glance"),
        (lambda mesh: find_points(mesh, "random"), "give a count"),
        (lambda mesh: find_points(mesh, "random", 0), "at least 1"),
        (lambda mesh: find_points(mesh, "random", 2.5), "whole number"),
        (lambda mesh: find_points(mesh, "random", 5, selection="brightest"), "unknown selection 'brightest'"),
        (lambda mesh: find_points(mesh, "random", 5, radius=0), "radius must be positive"),
        (lambda mesh: find_points(mesh, "glance", weights="ssim"), "unknown weights 'ssim'"),
        (lambda mesh: find_points(mesh, "itti", weights="equal"), "'itti' has no weights"),
        (lambda mesh: saliency(mesh, "guided_ssim"), "needs weights that the stage `weights` learns"),
        (lambda mesh: saliency(mesh, "glance", weights={"shine": 1.0}), "no feature shine"),
        (lambda mesh: saliency(mesh, "svm", weights="equal"), "run the pipeline for it"),
        (lambda mesh: saliency(mesh, "itti", viewpoints=[]), "no viewpoints"),
        (lambda mesh: best_viewpoints(mesh, "glance"), "unknown channel"),
        (lambda mesh: saliency(mesh, "random"), "has no saliency"),
        (lambda mesh: find_points(Mesh(np.zeros((3, 3)), [[0, 1, 2]]), "random", 5), "no extent"),
        (lambda mesh: random_vertices(Mesh(np.zeros((3, 3)), [[0, 1, 2]]), 5, rng(0, "")), "no area"),
        (lambda mesh: parse_viewpoint("front"), "'front' is not the name of a viewpoint"),
    ],
)
def test_bad_input_is_an_error_with_a_remedy(call, message, ball):
    with pytest.raises(ValueError, match=message):
        call(ball)


@pytest.mark.parametrize(
    ("given", "message"),
    [
        (dict.fromkeys(weights("equal"), 1.0) | {"edge": -1.0}, "not negative"),
        (dict.fromkeys(weights("equal"), 1.0) | {"shine": 1.0}, "without a map: shine"),
    ],
)
def test_bad_weights_are_errors(given, message, sight, ball):
    with pytest.raises(ValueError, match=message):
        METHODS["thesis_ssim"].find(ball, sight, weighted(given))


def test_a_channel_without_a_map_is_named(ball, make_maps):
    sight = ViewMaps(ball, FOUR, make_maps(ball, np.zeros(3), FOUR, channels=("color", "intensity")))
    with pytest.raises(ValueError, match="no map for orientation"):
        METHODS["itti"].find(ball, sight, Options())

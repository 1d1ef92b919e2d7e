"""The perspective camera, placing, and what one ray cast object shows."""

import numpy as np
import pytest

from haptic_glance.lod.scene import Camera, Placed, Scene, fly
from haptic_glance.lod.scene.level_renders import pixel_box, rays_of, render_level
from haptic_glance.mesh.mesh import Mesh


@pytest.fixture
def camera():
    return Camera((1.0, -3.0, 1.5), (0.1, 0.0, 0.2), 40.0, (90, 120))


def test_a_ray_through_a_projected_point_meets_it(camera):
    points = np.random.default_rng(0).normal(size=(50, 3)) * 0.3
    rows, columns, depth = camera.project(points)
    along = camera.directions(rows, columns)
    hits = np.array(camera.eye) + along * (depth / (along @ camera.axes[2]))[:, None]
    assert np.allclose(hits, points, atol=1e-9)


def test_the_view_angle_spans_the_rows(camera):
    half = camera.axes[2] + np.tan(np.radians(20)) * camera.axes[1]
    rows = camera.project((np.array(camera.eye) + half)[None])[0]
    assert rows == pytest.approx(-0.5)


def test_up_is_up_and_a_metre_twice_as_far_is_half_as_large(camera):
    near, far = (camera.project(np.array(camera.eye) + d * camera.axes[2] + [[0, 0, 0], [0, 0, 0.1]]) for d in (1, 2))
    assert near[0][1] < near[0][0]
    assert (near[0][0] - near[0][1]) / (far[0][0] - far[0][1]) == pytest.approx(2, rel=0.15)


def test_a_path_goes_through_its_keyframes_and_stays_within_them():
    eyes = [[0, -4, 1], [0, -2, 1], [0, -2, 3]]
    cameras = fly(eyes, [[0, 0, 0]] * 3, 9, 40, (10, 10))
    places = np.array([camera.eye for camera in cameras])
    assert np.allclose(places[[0, 4, 8]], eyes)
    assert places[:, 1].max() <= -2 and places[:, 2].min() >= 1
    assert len({camera.eye for camera in fly([[0, -4, 1]], [[0, 0, 0]], 3, 40, (10, 10))}) == 1


def test_a_placed_object_stands_on_its_foot_at_its_size(meshes):
    pose = Placed("one", (1.0, 2.0, 3.0), 90.0, 0.4).pose(meshes["one"])
    world = pose.to_world(meshes["one"].vertices)
    assert np.ptp(meshes["one"].vertices, axis=0).max() * pose.scale == pytest.approx(0.4)
    assert world[:, 2].min() == pytest.approx(3.0)
    assert np.allclose((world.min(axis=0) + world.max(axis=0))[:2] / 2, [1.0, 2.0])
    assert np.allclose(pose.to_mesh(world), meshes["one"].vertices)
    quarter = world - [1.0, 2.0, 3.0]  # what lay on +x now lies on +y
    assert np.allclose(quarter[:, 1], (meshes["one"].vertices - pose.foot)[:, 0] * pose.scale)


def test_a_rendering_shows_the_surface_where_it_is(meshes, chains):
    camera = Camera((0.0, -2.0, 0.3), (0.0, 0.0, 0.1), 30.0, (60, 80))
    pose = Placed("one", (0.05, 0.0, 0.0), 40.0, 0.3).pose(meshes["one"])
    level = chains["one"][0]
    seen = render_level(level, camera, pose)
    points, _ = rays_of(seen, camera, pose)
    rows, columns, depth = camera.project(pose.to_world(points))
    assert len(seen.pixels) > 200
    assert np.allclose(rows * 80 + columns, seen.pixels, atol=1e-2) and np.allclose(depth, seen.depth)
    assert level.surface.nearest(points)[0].max() < 1e-9


def test_an_object_covers_the_pixels_between_its_corners_none_behind_the_camera_and_all_where_it_reaches_there(meshes):
    def box(place, target=(0.0, 0.0, 0.3)):
        camera, pose = Camera((0.0, -2.0, 0.3), target, 30.0, (60, 80)), Placed("one", place, 40.0, 0.3)
        return np.reshape(pixel_box(camera, pose.pose(meshes["one"])), (2, 2)), camera, pose.pose(meshes["one"])

    covered, camera, pose = box((0.05, 0.0, 0.1))
    for (first, end), corners in zip(covered, camera.project(pose.corners())[:2], strict=True):
        assert 0 < first - 1 < corners.min() <= first and end - 1 <= corners.max() < end < 60
    (top, bottom), (left, right) = box((-0.75, 0.0, 0.7))[0]  # beyond the upper left corner of the screen
    assert top == left == 0 and 0 < bottom < 60 and 0 < right < 80
    assert box((0.0, -2.0, 0.2))[0].tolist() == [[0, 60], [0, 80]]
    (top, bottom), (left, right) = box((0.0, 0.0, 0.0), target=(0.0, -4.0, 0.3))[0]
    assert bottom <= top or right <= left


def looking(**changes):
    return Camera(**{"eye": (0, -1, 0), "target": (0, 0, 0), "angle": 40, "size": (5, 5)} | changes)


@pytest.mark.parametrize(
    ("work", "words"),
    [
        (lambda _, __: looking(eye=(0, 0, 0)), "camera"),
        (lambda _, __: looking(eye=(0, 0, 5)), "camera"),
        (lambda _, __: looking(eye=(np.nan, -1, 0)), r"at \(nan, -1, 0\) that looks at .* is nowhere: give finite"),
        (lambda _, __: looking(angle=0), "angle"),
        (lambda _, __: looking(size=(0, 5)), "screen"),
        (lambda _, __: looking(size=(np.nan, 5)), "screen of .*: give rows and columns, whole numbers"),
        (lambda _, __: looking(size=(5,)), "screen of .*: give rows and columns"),
        (lambda _, __: looking(eye=(0, 1), target=(0, 0)), "give x, y, z of both"),
        (lambda _, __: fly([[3, 0, 0], [np.inf, 0, 0]], [[0, 0, 0]] * 2, 3, 40, (5, 5)), "keyframes .* must be finite"),
        (lambda all_of, _: Placed("one", (np.nan, 0, 0), 0, 1).pose(all_of["one"]), "one has position .*nan.*: give"),
        (lambda all_of, _: Placed("one", (0, 0, 0), np.nan, 1).pose(all_of["one"]), "one has position .*nan.*: give"),
        (lambda _, __: Placed("dot", (0, 0, 0), 0, 1).pose(Mesh(np.ones((3, 3)), [[0, 1, 2]])), "dot has no extent"),
        (lambda all_of, make: make((Placed("one", (0, -4, 0.5), 0, 0.5),)).poses(all_of), "0 is in the .* box of one"),
        (
            lambda all_of, make: make((Placed("no", (0, 0, 0), 0, 1),)).poses(all_of),
            "no mesh of no: there are one, two",
        ),
        (lambda _, make: make(tolerance=0.0), "tolerance"),
        (lambda _, make: make(tolerance=np.nan), "tolerance"),
        (lambda _, make: make(kind="metres"), "kind"),
        (lambda _, make: make(limit=-1), "limit"),
        (lambda _, make: make(limit=np.nan), "limit"),
        (lambda _, make: make(hold=0), "hold"),
        (lambda _, make: make(hold=1.5), "whole number"),
        (lambda _, __: Scene((), (), 1.0), "one object"),
    ],
)
def test_scenes_that_cannot_be_say_why(meshes, make_scene, work, words):
    with pytest.raises(ValueError, match=words):
        work(meshes, make_scene)

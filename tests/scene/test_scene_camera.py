"""The perspective camera, placing, and what one ray cast object shows."""

import numpy as np
import pytest

from haptic_glance.lod.scene import Camera, Placed, Scene, fly
from haptic_glance.lod.scene.pictures import pixel_box, rays_of, render_level


@pytest.fixture
def camera():
    return Camera((1.0, -3.0, 1.5), (0.1, 0.0, 0.2), 40.0, (90, 120))


def test_a_ray_through_a_projected_point_meets_it(camera):
    points = np.random.default_rng(0).normal(size=(50, 3)) * 0.3
    rows, columns, depth = camera.project(points)
    along = camera.directions(rows, columns)
    there = np.array(camera.eye) + along * (depth / (along @ camera.axes[2]))[:, None]
    assert np.allclose(there, points, atol=1e-9)


def test_the_view_angle_spans_the_rows(camera):
    half = camera.axes[2] + np.tan(np.radians(20)) * camera.axes[1]
    rows = camera.project((np.array(camera.eye) + half)[None])[0]
    assert rows == pytest.approx(-0.5)


def test_up_is_up_and_a_metre_twice_as_far_is_half_as_large(camera):
    near, far = (camera.project(np.array(camera.eye) + d * camera.axes[2] + [[0, 0, 0], [0, 0, 0.1]]) for d in (1, 2))
    assert near[0][1] < near[0][0]
    assert (near[0][0] - near[0][1]) / (far[0][0] - far[0][1]) == pytest.approx(2, rel=0.15)


def test_axes_are_right_handed_and_orthonormal(camera):
    right, up, forward = camera.axes
    assert np.allclose(camera.axes @ camera.axes.T, np.eye(3))
    assert np.allclose(np.cross(right, up), -forward)


def test_a_path_goes_through_its_keyframes_and_stays_within_them():
    eyes = [[0, -4, 1], [0, -2, 1], [0, -2, 3]]
    cameras = fly(eyes, [[0, 0, 0]] * 3, 9, 40, (10, 10))
    found = np.array([camera.eye for camera in cameras])
    assert np.allclose(found[[0, 4, 8]], eyes)
    assert found[:, 1].max() <= -2 and found[:, 2].min() >= 1


def test_one_keyframe_stands_still():
    assert len({camera.eye for camera in fly([[0, -4, 1]], [[0, 0, 0]], 3, 40, (10, 10))}) == 1


@pytest.mark.parametrize("change", [{"eye": (0, 0, 0)}, {"eye": (0, 0, 5)}, {"angle": 0}, {"size": (0, 5)}])
def test_a_camera_that_cannot_look_says_why(change):
    with pytest.raises(ValueError, match=r"camera|angle|screen"):
        Camera(**{"eye": (0, -1, 0), "target": (0, 0, 0), "angle": 40, "size": (5, 5)} | change)


def test_a_camera_or_an_object_at_no_number_is_named(meshes):
    with pytest.raises(ValueError, match=r"at \(nan, -1, 0\) that looks at \(0, 0, 0\) is nowhere: give finite"):
        Camera((np.nan, -1, 0), (0, 0, 0), 40, (5, 5))
    with pytest.raises(ValueError, match="keyframes of a camera path must be finite"):
        fly([[3, 0, 0], [np.inf, 0, 0]], [[0, 0, 0]] * 2, 3, 40, (5, 5))
    for placed in (Placed("one", (np.nan, 0, 0), 0, 1), Placed("one", (0, 0, 0), np.nan, 1)):
        with pytest.raises(ValueError, match="one has position .*nan.*: give finite numbers"):
            placed.pose(meshes["one"])


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


def test_an_object_behind_the_camera_covers_nothing(meshes):
    camera = Camera((0.0, -2.0, 0.3), (0.0, -4.0, 0.3), 30.0, (60, 80))
    top, bottom, left, right = pixel_box(camera, Placed("one", (0.0, 0.0, 0.0), 0.0, 0.3).pose(meshes["one"]))
    assert bottom <= top or right <= left


def test_an_eye_in_an_object_is_named(meshes, make_scene):
    scene = make_scene(objects=(Placed("one", (0.0, -4.0, 0.5), 0.0, 0.5),))
    with pytest.raises(ValueError, match=r"frame 0 is inside one"):
        scene.poses(meshes)


def test_an_unknown_object_is_named_with_the_known_ones(meshes, make_scene):
    with pytest.raises(ValueError, match=r"no mesh of nothing: there are one, two"):
        make_scene(objects=(Placed("nothing", (0, 0, 0), 0, 1),)).poses(meshes)


@pytest.mark.parametrize(
    "change",
    [{"tolerance": 0.0}, {"tolerance": -1.0}, {"tolerance": np.nan}, {"kind": "metres"}, {"limit": -1}, {"hold": 0}],
)
def test_a_scene_without_sense_is_refused(make_scene, change):
    with pytest.raises(ValueError, match=next(iter(change))):
        make_scene(**change)


def test_an_empty_scene_is_refused():
    with pytest.raises(ValueError, match="one object"):
        Scene((), (), 1.0)

"""Errors rendered beforehand: the known sums of two balls, the sums of frames, and the fewest faces of all plans."""

from functools import cache
from itertools import product

import numpy as np
import pytest
import trimesh

from haptic_glance.lod.scene import Frames, Level, Placed
from haptic_glance.lod.scene.beforehand import _cube, by_profiles, by_sums, profile, rendered_sums
from haptic_glance.mesh.mesh import Mesh


def ball(radius, subdivisions=4):
    made = trimesh.creation.icosphere(subdivisions=subdivisions, radius=radius)
    return Level(Mesh(made.vertices, made.faces), {})


@pytest.mark.slow
def test_two_balls_are_apart_by_the_difference_of_their_radii_in_both_pictures():
    radius = 0.4
    lookup = profile([ball(0.5), ball(radius, 3)], rows=100)
    wanted = np.pi * (0.5 - radius) * (0.5**2 + radius**2)
    assert lookup.sums[:, 0].tolist() == [0] * len(lookup.directions)
    assert lookup.sums[:, 1] == pytest.approx(wanted, rel=0.08)  # the coarser ball lies inside its sphere


def test_directions_are_spread_evenly():
    directions = profile([ball(0.5, 1)]).directions
    assert np.linalg.norm(directions, axis=1) == pytest.approx(1) and np.abs(directions.mean(axis=0)).max() < 0.02
    nearest = np.degrees(np.arccos(np.sort(directions @ directions.T, axis=1)[:, -2]))
    assert nearest.min() > 31 and nearest.mean() > 34  # golden angles


@pytest.fixture(scope="module")
def alone(make_scene, frames_of, chains):
    """Frames of one object, which nothing hides, its levels, the sums of each level in each frame, its profile."""
    frames = frames_of(make_scene([Placed("one", (0.0, 0.0, 0.0), 30.0, 0.25)], size=(240, 320)))
    return frames, (chains["one"],), rendered_sums(frames, (chains["one"],)), [profile(chains["one"])]


@pytest.mark.slow
def test_a_look_up_foretells_what_frames_show(alone):
    frames, chains, (sums,), profiles = alone
    for price in (0.01, 0.1, 1.0):
        ahead, known = by_profiles(frames, chains, profiles, price), by_sums(frames, chains, [sums], price)
        assert np.abs(ahead.levels - known.levels).max() <= 1
        cost = [plan.faces[:, 0] + price * sums[range(len(sums)), plan.levels[:, 0]] for plan in (ahead, known)]
        assert (cost[0] <= 1.1 * cost[1]).all()


@pytest.mark.slow
def test_no_plan_with_as_few_faces_has_less_displacement(alone):
    frames, (chain,), (sums,), _ = alone
    few = slice(2, 8)  # six levels in five frames: 7,776 plans
    faces = np.array([level.faces for level in chain])[few]
    plans = np.array(list(product(range(len(faces)), repeat=len(sums))))
    counts, moved = faces[plans].sum(axis=1), sums[:, few][range(len(sums)), plans].sum(axis=1)
    for price in (0.02, 0.1, 0.5):
        levels = by_sums(frames, (chain[few],), [sums[:, few]], price).levels[:, 0]
        totals = faces[levels].sum(), sums[:, few][range(len(sums)), levels].sum()
        assert not ((counts <= totals[0]) & (moved < totals[1] - 1e-9)).any()


def test_the_price_decides_between_all_faces_and_the_fewest(alone):
    frames, chains, sums, profiles = alone
    for price, level in ((1e9, 0), (1e-9, len(chains[0]) - 1)):
        assert (by_profiles(frames, chains, profiles, price).levels == level).all()
        assert (by_sums(frames, chains, sums, price).levels == level).all()
    for price in (0, -1.0, np.nan):
        with pytest.raises(ValueError, match=f"^the price is {price} faces"):
            by_profiles(frames, chains, profiles, price)


@pytest.mark.parametrize(("turn", "level"), [(-90.0, 0), (90.0, 1), (0.0, 1)])
def test_a_dent_matters_where_it_faces_the_camera(make_scene, turn, level):
    full = ball(0.5)
    dented = full.mesh.vertices.copy()
    dented[dented[:, 0] > 0.4, 0] = 0.4  # a flat place where x is largest
    chain = (full, Level(Mesh(dented, full.mesh.faces[::2]), {}))  # every other face: fewer, though with holes
    scene = make_scene([Placed("ball", (0.0, 0.0, 0.0), turn, 0.25)], frames=1)  # the camera is at y = -4 m
    frames = Frames(scene, {"ball": full.mesh}, [full])
    flat = Level(Mesh(dented, full.mesh.faces), {})
    lookup = profile((full, flat))
    facing = lookup.directions[lookup.sums[:, 1].argmax()]
    assert facing[0] > 0.8
    price = 2 * (len(full.mesh.faces) - len(chain[1].mesh.faces)) / _moved(frames, lookup)
    assert by_profiles(frames, (chain,), [lookup], price).levels.item() == level


def _moved(frames, lookup):
    """The displacement of the dent in the frame where it faces the camera."""
    pose, (camera,) = frames.poses[0], frames.scene.cameras
    depth = camera.axes[2] @ (pose.corners().mean(axis=0) - camera.eye)
    return lookup.sums[:, 1].max() * (pose.scale * camera.focal / depth) ** 3


@cache
def of_two_balls():
    return profile((ball(0.5, 3), ball(0.45, 3)))


@pytest.mark.parametrize(
    ("place", "share"), [((0, 0, 0), 1.0), ((1.475, 0, 0), 0.5), ((2, 0, 0), 0.0), ((0, -6, 0), 0.0), ((0, 0, 2), 0.0)]
)
def test_displacement_counts_where_it_is_in_the_frame(make_scene, place, share):
    full = ball(0.5)
    scene = make_scene([Placed("ball", place, 0.0, 0.25)], frames=1, size=(100, 100))  # seen from y = -4 m
    pose, (camera,) = scene.poses({"ball": full.mesh})[0], scene.cameras
    counted = _cube(camera, pose, of_two_balls().points)
    whole = (pose.scale * camera.focal / (camera.axes[2] @ (pose.corners().mean(axis=0) - camera.eye))) ** 3
    assert counted == pytest.approx(share * whole, rel=0.1, abs=1e-9)

"""Curvature and symmetry of the surface, on shapes with a known answer."""

import functools

import numpy as np
import pytest
import trimesh

from haptic_glance.look.channels import conspicuity
from haptic_glance.look.channels.channels import SYMMETRIES
from haptic_glance.look.channels.curvature import capped_curvature, mean_curvature
from haptic_glance.look.channels.surface import nearest_corners
from haptic_glance.look.channels.symmetry import shape_symmetries, symmetric_points
from haptic_glance.look.views import Viewpoint, render
from haptic_glance.mesh.mesh import Mesh
from tests.shapes import lopsided, mesh_of

SIZE = (300, 400)
BOX = mesh_of(trimesh.creation.box((0.6, 0.42, 0.24)))
CONE = mesh_of(trimesh.creation.revolve([[0, -0.4], [0.3, -0.4], [0.15, 0], [0, 0.4]], sections=48))
SPHERE = mesh_of(trimesh.creation.icosphere(subdivisions=3))


@functools.cache
def mirrored():
    """The lopsided blob welded to its mirror image at x = 0."""
    half = lopsided()
    v, f = half.vertices + [0.2, 0, 0], half.faces
    return Mesh(np.r_[v, v * [-1, 1, 1]] * 0.7, np.r_[f, f[:, ::-1] + len(v)])


def test_curvature_of_a_sphere_is_one_over_r_and_of_a_flat_mesh_nothing():
    curvature = mean_curvature(mesh_of(trimesh.creation.icosphere(subdivisions=4, radius=0.4)))
    assert np.median(curvature) == pytest.approx(2.5, rel=0.01)
    np.testing.assert_allclose(curvature, 2.5, rtol=0.09)
    grid = trimesh.creation.box((1, 1, 0)).subdivide().subdivide()
    assert not capped_curvature(Mesh(grid.vertices, grid.faces[:8])).any()


def test_curvature_stands_slivers_and_noise():
    smooth = mesh_of(trimesh.creation.uv_sphere(radius=0.4, count=[200, 24]))
    assert np.quantile(np.abs(mean_curvature(smooth) / 2.5 - 1), 0.95) < 0.15
    ball = trimesh.creation.icosphere(subdivisions=5, radius=0.4)
    noise = np.random.default_rng(0).normal(0, 0.0005, (len(ball.vertices), 1))
    noisy = mean_curvature(Mesh(ball.vertices * (1 + noise), ball.faces), smoothing=0.03)
    assert np.median(noisy) == pytest.approx(2.5, rel=0.05) and (noisy > 0).mean() > 0.95


def test_curvature_ignores_vertex_order_and_splitting_and_flips_with_the_winding():
    mesh = lopsided()
    order = np.random.default_rng(1).permutation(len(mesh.vertices))
    shuffled = Mesh(mesh.vertices[order], np.argsort(order)[mesh.faces])
    expected = mean_curvature(mesh)
    np.testing.assert_allclose(mean_curvature(shuffled), expected[order], rtol=1e-6)
    soup = Mesh(mesh.vertices[mesh.faces].reshape(-1, 3), np.arange(3 * len(mesh.faces)).reshape(-1, 3))
    np.testing.assert_allclose(mean_curvature(soup), expected[mesh.faces.ravel()], rtol=1e-6)
    inward = Mesh(mesh.vertices, mesh.faces[:, ::-1])
    np.testing.assert_allclose(mean_curvature(inward), -expected, rtol=1e-6)


def test_a_place_takes_the_corner_nearest_to_it():
    sliver = Mesh([[0, -0.4, 0], [0, 0.4, 0], [0, 0.4, 0.01]], [[0, 1, 2]])
    places = np.array([[0, -0.39, 1e-4], [0, 0.39, 1e-3], [0, 0.399, 9e-3]])
    corners = nearest_corners(sliver, np.zeros(3, dtype=np.int64), places)
    assert corners.tolist() == [0, 1, 2]  # the centroid's is 1 or 2


def test_the_mirror_plane_is_found_however_the_shape_lies_and_shows_where_it_is_seen_edge_on():
    turn = trimesh.transformations.euler_matrix(*np.radians([111, -35, 63]))[:3, :3]
    (normal, offset, score), *_ = shape_symmetries(Mesh(mirrored().vertices @ turn.T, mirrored().faces)).planes
    assert abs(normal @ turn[:, 0]) > np.cos(np.radians(1))
    assert abs(offset) < 0.005 and score > 0.9
    mesh = mirrored()
    ridge = mesh.vertices[np.abs(mesh.vertices[:, 0]).argmin()][None]
    assert symmetric_points(mesh, ridge, np.array([0.0, 1.0, 0.0]))[0] > 0.8
    assert symmetric_points(mesh, ridge, np.array([1.0, 0.0, 0.0]))[0] < 0.05


@pytest.mark.slow
def test_a_lopsided_shape_has_no_symmetry_but_its_strongest_plane_and_axis_count_in_full():
    none = shape_symmetries(lopsided())
    assert not none.planes and not none.axes
    assert not symmetric_points(lopsided(), lopsided().vertices).any()
    best = shape_symmetries(lopsided(), True)
    assert [score for _, _, score in best.planes] == [1.0]
    assert [(score, revolves) for _, score, revolves in best.axes] == [(1.0, False)]
    (axis, _, _), *_ = best.axes
    away = lopsided().vertices - best.centre
    pierced = lopsided().vertices[[(away @ axis / np.linalg.norm(away, axis=1)).argmax()]]
    assert symmetric_points(lopsided(), pierced, kinds=["radial"], strongest=True)[0] > 0.5
    assert not symmetric_points(lopsided(), pierced, kinds=["radial"]).any()


@pytest.mark.slow
def test_a_box_has_three_planes_and_a_cone_and_a_cylinder_one_axis_in_either_setting_and_a_sphere_nothing():
    tin = mesh_of(trimesh.creation.cylinder(0.2, 1.0, sections=64))
    for strongest in (False, True):
        normals = np.abs([normal for normal, _, _ in shape_symmetries(BOX, strongest).planes])
        np.testing.assert_allclose(normals[normals.argmax(axis=1).argsort()], np.eye(3), atol=0.02)
        for mesh in (CONE, tin):
            symmetries = shape_symmetries(mesh, strongest)
            ((axis, score, revolves),) = symmetries.axes
            assert abs(axis[2]) > 0.999 and score > 0.9 and revolves
        none = shape_symmetries(SPHERE, strongest)
        assert not none.planes and not none.axes
    assert not shape_symmetries(CONE).planes


def test_a_prism_of_five_sides_has_one_axis_and_five_planes_through_it():
    angle = 2 * np.pi * np.arange(5) / 5
    outline = np.c_[0.35 * np.cos(angle), 0.35 * np.sin(angle)]
    v = np.r_[np.c_[outline, np.full(5, -0.3)], np.c_[outline, np.full(5, 0.3)], [[0, 0, -0.3], [0, 0, 0.3]]]
    k, n = np.arange(5), (np.arange(5) + 1) % 5
    sides = np.r_[np.c_[k, n, n + 5], np.c_[k, n + 5, k + 5]]
    symmetries = shape_symmetries(Mesh(v, np.r_[sides, np.c_[n, k, k * 0 + 10], np.c_[k + 5, n + 5, k * 0 + 11]]))
    ((_, score, revolves),) = [axis for axis in symmetries.axes if abs(axis[0][2]) > 0.99]
    assert score > 0.9 and not revolves
    upright = [normal for normal, _, _ in symmetries.planes if abs(normal[2]) < 0.05]
    turns = np.degrees([np.arctan2(normal[1], normal[0]) for normal in upright]) % 36
    np.testing.assert_allclose(turns, [18] * 5, atol=2.5)


def test_a_mirror_plane_is_lateral_and_an_axis_radial_and_both_together_the_stronger():
    tip, flank, edge = np.array([[0, 0, 0.4]]), np.array([[0.0, 0.15, 0.0]]), np.array([[0.15, 0, 0]])
    across, along = np.array([1.0, 0, 0]), np.array([0, 0, 1.0])
    assert symmetric_points(CONE, tip, along, ("radial",))[0] > 0.9
    assert symmetric_points(CONE, tip, along, ("lateral",))[0] < 1e-4  # seen along its axis, no plane is special
    assert symmetric_points(CONE, edge, across, ("lateral",))[0] > 0.9
    assert symmetric_points(CONE, flank, across, ("lateral",))[0] < 0.1
    assert symmetric_points(CONE, tip, across, ("radial",))[0] < 1e-6
    assert symmetric_points(CONE, np.r_[tip, [[0.3, 0, -0.4]]]) == pytest.approx([1, 0], abs=0.05)
    back = Viewpoint(25, 35).axes[2]
    kinds = [symmetric_points(CONE, CONE.vertices, back, (kind,)) for kind in ("lateral", "radial")]
    np.testing.assert_array_equal(symmetric_points(CONE, CONE.vertices, back), np.maximum(*kinds))


def test_the_lateral_map_shows_the_plane_and_the_radial_map_the_pole():
    maps = conspicuity(CONE, render(CONE, Viewpoint(0, 60), SIZE, "raster"), ["symmetry_lateral", "symmetry_radial"])
    lateral, radial = maps.values()
    columns = np.argmax(lateral, axis=1)[lateral.max(axis=1) > 0.3 * lateral.max()]
    assert np.abs(columns - 49.5).max() < 3  # down the middle
    rows, columns = np.nonzero(radial > 0.5 * radial.max())
    assert np.ptp(rows) < 15 and np.ptp(columns) < 15 and (lateral > 0.5 * lateral.max()).sum() > 2 * len(rows)
    maps = conspicuity(BOX, render(BOX, Viewpoint(30, 20), SIZE, "raster"), ["symmetry", *maps])
    assert maps["symmetry_lateral"].any() and not maps["symmetry_radial"].any()  # a box has no axis
    np.testing.assert_array_equal(maps["symmetry"], maps["symmetry_lateral"])


@pytest.mark.slow
def test_the_setting_replaces_the_maps_of_symmetry_alone():
    channels, view = (
        ["symmetry", "symmetry_radial", "intensity"],
        render(lopsided(), Viewpoint(-84, 33), SIZE, "raster"),
    )
    perceived, strongest = (conspicuity(lopsided(), view, channels, symmetry=setting) for setting in SYMMETRIES)
    assert [perceived[name].any() for name in channels] == [False, False, True]
    assert all(strongest[name].any() for name in channels)
    np.testing.assert_array_equal(perceived["intensity"], strongest["intensity"])

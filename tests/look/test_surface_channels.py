"""Curvature and symmetry of the surface, on shapes with a known answer."""

import functools

import numpy as np
import pytest
import trimesh

from haptic_glance.look.channels import CHANNELS, conspicuity
from haptic_glance.look.channels.channels import SYMMETRIES
from haptic_glance.look.channels.curvature import capped_curvature, mean_curvature
from haptic_glance.look.channels.symmetry import mirror, rotate, shape_symmetries, symmetric_points
from haptic_glance.look.views import Viewpoint, render
from haptic_glance.mesh.mesh import Mesh

SIZE = (300, 400)


def kit_mesh(source, colors=None):
    return Mesh(source.vertices, source.faces, colors)


def rotation(*degrees):
    return trimesh.transformations.euler_matrix(*np.radians(degrees))[:3, :3]


@functools.cache
def lopsided():
    """A blob with bumps of different size in no symmetric order."""
    source = trimesh.creation.icosphere(subdivisions=4)
    v = source.vertices.copy()
    for direction, height, width in (((1, 0.2, 0), 1.2, 0.3), ((-0.3, 1, 0.5), 0.7, 0.2), ((0.1, -0.4, -1), 0.9, 0.5)):
        towards = np.array(direction) / np.linalg.norm(direction)
        v *= 1 + height * np.exp(-(1 - v @ towards / np.linalg.norm(v, axis=1)) / width**2)[:, None]
    v -= (v.max(axis=0) + v.min(axis=0)) / 2
    return Mesh(v / (2 * np.linalg.norm(v, axis=1).max()), source.faces)


@functools.cache
def mirrored():
    """The lopsided blob welded to its mirror image at x = 0."""
    half = lopsided()
    v, f = half.vertices + [0.2, 0, 0], half.faces
    return Mesh(np.r_[v, v * [-1, 1, 1]] * 0.7, np.r_[f, f[:, ::-1] + len(v)])


@functools.cache
def bumpy_view():
    return render(lopsided(), Viewpoint(20, 10), SIZE, "raster")


def test_curvature_of_a_sphere_is_one_over_r():
    found = mean_curvature(kit_mesh(trimesh.creation.icosphere(subdivisions=4, radius=0.4)))
    assert np.median(found) == pytest.approx(2.5, rel=0.01)
    np.testing.assert_allclose(found, 2.5, rtol=0.09)


def test_curvature_of_a_cylinder_is_half_of_one_over_r():
    angle, height = np.meshgrid(np.linspace(0, 2 * np.pi, 80, endpoint=False), np.linspace(-0.4, 0.4, 60))
    v = np.stack([0.2 * np.cos(angle), 0.2 * np.sin(angle), height], axis=-1).reshape(-1, 3)
    k = np.arange(59 * 80)
    right = k - k % 80 + (k + 1) % 80
    mesh = Mesh(v, np.r_[np.c_[k, right, right + 80], np.c_[k, right + 80, k + 80]])
    np.testing.assert_allclose(mean_curvature(mesh)[20 * 80 : 40 * 80], 2.5, rtol=0.01)


def test_curvature_stands_slivers_and_noise():
    smooth = kit_mesh(trimesh.creation.uv_sphere(radius=0.4, count=[200, 24]))
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


def test_a_flat_mesh_has_no_curvature():
    grid = trimesh.creation.box((1, 1, 0)).subdivide().subdivide()
    flat = Mesh(grid.vertices, grid.faces[:8])
    assert not capped_curvature(flat).any()


@pytest.mark.slow
@pytest.mark.parametrize("angles", [(0, 0, 0), (20, 50, -70), (111, -35, 63)])
def test_the_mirror_plane_is_found_however_the_shape_lies(angles):
    turned = Mesh(mirrored().vertices @ rotation(*angles).T, mirrored().faces)
    (normal, offset, score), *_ = shape_symmetries(turned).planes
    assert abs(normal @ rotation(*angles)[:, 0]) > np.cos(np.radians(1))
    assert abs(offset) < 0.005 and score > 0.9


@pytest.mark.slow
def test_a_lopsided_shape_has_no_symmetry():
    found = shape_symmetries(lopsided())
    assert not found.planes and not found.axes
    assert not symmetric_points(lopsided(), lopsided().vertices).any()


def test_a_sphere_has_no_special_plane():
    found = shape_symmetries(kit_mesh(trimesh.creation.icosphere(subdivisions=3)))
    assert not found.planes and not found.axes


def test_a_cone_has_one_axis_and_its_tip_is_white():
    cone = kit_mesh(trimesh.creation.revolve([[0, 0], [0.3, 0], [0.15, 0.4], [0, 0.8]], sections=64))
    found = shape_symmetries(cone)
    assert not found.planes
    ((axis, score, revolves),) = found.axes
    assert abs(axis[2]) > 0.999 and score > 0.9 and revolves
    assert symmetric_points(cone, np.array([[0, 0, 0.8], [0.3, 0, 0]])) == pytest.approx([1, 0], abs=0.05)


def test_a_box_has_three_planes():
    normals = np.abs([n for n, _, _ in shape_symmetries(kit_mesh(trimesh.creation.box((1, 0.7, 0.4)))).planes])
    np.testing.assert_allclose(normals[normals.argmax(axis=1).argsort()], np.eye(3), atol=0.02)


@pytest.mark.slow
def test_the_strongest_plane_and_axis_of_a_lopsided_shape_count_in_full():
    found = shape_symmetries(lopsided(), strongest=True)
    assert [score for _, _, score in found.planes] == [1.0]
    assert [(score, revolves) for _, score, revolves in found.axes] == [(1.0, False)]
    (axis, _, _), *_ = found.axes
    away = lopsided().vertices - found.centre
    pierced = lopsided().vertices[[(away @ axis / np.linalg.norm(away, axis=1)).argmax()]]
    assert symmetric_points(lopsided(), pierced, kinds=["radial"], strongest=True)[0] > 0.5
    assert not symmetric_points(lopsided(), pierced, kinds=["radial"]).any()


def test_what_people_see_is_the_strongest_too():
    box, cone = trimesh.creation.box((1, 0.7, 0.4)), trimesh.creation.revolve([[0, 0], [0.3, 0], [0, 0.8]], sections=64)
    for mesh in map(kit_mesh, (box, cone)):
        seen, best = shape_symmetries(mesh), shape_symmetries(mesh, strongest=True)
        assert [n.tolist() for n, *_ in best.planes] == [n.tolist() for n, *_ in seen.planes]
        assert len(best.axes) == 1 and (not seen.axes or (best.axes[0][0] == seen.axes[0][0]).all())


def test_a_cylinder_has_one_radial_axis_and_a_sphere_none_in_either_setting():
    tin, ball = trimesh.creation.cylinder(0.2, 1.0, sections=64), trimesh.creation.icosphere(subdivisions=3)
    for strongest in (False, True):
        ((axis, score, revolves),) = shape_symmetries(kit_mesh(tin), strongest).axes
        assert abs(axis[2]) > 0.999 and score > 0.9 and revolves
        none = shape_symmetries(kit_mesh(ball), strongest)
        assert not none.planes and not none.axes


def test_the_setting_replaces_the_maps_of_symmetry_alone():
    channels, along_axis = (
        ["symmetry", "symmetry_radial", "intensity"],
        render(lopsided(), Viewpoint(-84, 33), SIZE, "raster"),
    )
    perceived, strongest = (conspicuity(lopsided(), along_axis, channels, symmetry=each) for each in SYMMETRIES)
    assert [perceived[name].any() for name in channels] == [False, False, True]
    assert all(strongest[name].any() for name in channels)
    np.testing.assert_array_equal(perceived["intensity"], strongest["intensity"])
    with pytest.raises(ValueError, match="conspicuity.symmetry 'all'"):
        conspicuity(lopsided(), bumpy_view(), channels, symmetry="all")


def test_a_mirror_plane_shows_where_it_is_seen_edge_on():
    mesh = mirrored()
    ridge = mesh.vertices[np.abs(mesh.vertices[:, 0]).argmin()][None]
    assert symmetric_points(mesh, ridge, np.array([0.0, 1.0, 0.0]))[0] > 0.8
    assert symmetric_points(mesh, ridge, np.array([1.0, 0.0, 0.0]))[0] < 0.05


def test_mirror_and_turn_undo_themselves():
    points = np.random.default_rng(0).normal(size=(20, 3))
    axis = np.array([0.6, 0, 0.8])
    np.testing.assert_allclose(mirror(mirror(points, axis, 0.3), axis, 0.3), points, atol=1e-12)
    np.testing.assert_allclose(rotate(rotate(points, axis, 50, points[0]), axis, -50, points[0]), points, atol=1e-12)
    np.testing.assert_allclose(rotate(np.eye(3)[:1], np.array([0, 0, 1.0]), 90, np.zeros(3)), [[0, 1, 0]], atol=1e-12)


def test_maps_are_of_one_size_in_0_to_1_and_zero_off_the_object():
    mesh, view = lopsided(), bumpy_view()
    found = conspicuity(mesh, view)
    assert list(found) == list(CHANNELS) == sorted(CHANNELS)
    off = ~view.mask.reshape(75, 4, 100, 4).any(axis=(1, 3))
    for values in found.values():
        assert values.shape == (75, 100) and values.dtype == np.float32
        assert np.isfinite(values).all() and values.min() >= 0 and values.max() <= 1 and not values[off].any()
    assert conspicuity(mesh, view, ["edge"], (30, 40))["edge"].shape == (30, 40)
    assert found["curvature"].max() > 0 and found["intensity"].max() > 0


def test_maps_are_the_same_when_object_and_camera_turn_together():
    mesh = lopsided()
    turned = Mesh(mesh.vertices @ rotation(0, 0, 77).T, mesh.faces)
    here = conspicuity(mesh, bumpy_view())
    there = conspicuity(turned, render(turned, Viewpoint(97, 10), SIZE, "raster"))
    for channel, values in here.items():
        assert np.abs(values - there[channel]).max() < 0.03, channel


def test_maps_ignore_vertex_and_face_order():
    mesh, rng = lopsided(), np.random.default_rng(5)
    order = rng.permutation(len(mesh.vertices))
    shuffled = Mesh(mesh.vertices[order], rng.permutation(np.argsort(order)[mesh.faces]))
    here = conspicuity(mesh, bumpy_view())
    there = conspicuity(shuffled, render(shuffled, Viewpoint(20, 10), SIZE, "raster"))
    for channel, values in here.items():
        assert np.abs(values - there[channel]).max() < 0.03, channel


def test_the_curved_tip_stands_out_in_curvature():
    mesh = lopsided()
    view = render(mesh, Viewpoint(90, 0), SIZE, "raster")
    found = conspicuity(mesh, view, ["curvature"])["curvature"]
    at = np.array(np.unravel_index(found.argmax(), found.shape)) * 4
    face = view.face[at[0], at[1]]
    assert capped_curvature(mesh)[mesh.faces[face]].max() > 0.5

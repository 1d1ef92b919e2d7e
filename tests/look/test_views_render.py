"""Every renderer draws known depths, limbs, brightness and highlights, the nearest face, the whole object."""

import numpy as np
import pytest
import trimesh
from scipy import ndimage

from haptic_glance.look.camera import DISTANCE, Viewpoint, pixel_rays, pixels_per_unit, project
from haptic_glance.look.points import compute_maps
from haptic_glance.look.views import Material, gl, render
from haptic_glance.look.views import renderer as renderers
from haptic_glance.look.views.shading import GREY, corner_groups
from haptic_glance.mesh.mesh import Mesh
from tests.shapes import mesh_of

SIZE = (225, 300)
FRONT, ASIDE = Viewpoint(0, 0), Viewpoint(120, 45)
SHINY = Material(0.1, 0.5, 0.4, 20)
PIXEL = 1 / pixels_per_unit(SIZE[0])
GRID = np.indices(SIZE)
RADIUS = np.hypot(GRID[0] - (SIZE[0] - 1) / 2, GRID[1] - (SIZE[1] - 1) / 2) * PIXEL
NO_EGL = pytest.mark.skipif(bool(gl.egl_error()), reason=f"no EGL context on this machine: {gl.egl_error()}")


def square(back=0.0, half=0.25, outwards=True, colour=None):
    """A square across the x axis, seen from FRONT."""
    corners = half * np.array([[-1, -1], [1, -1], [1, 1], [-1, 1]])
    faces = np.array([[0, 1, 2], [0, 2, 3]])
    colors = None if colour is None else np.tile(np.array(colour, dtype=np.uint8), (4, 1))
    return Mesh(np.c_[np.full(4, back), corners], faces if outwards else faces[:, ::-1], colors)


def lit(colour, cosine, material):
    """Blinn's model under a head light, whose half vector is the view axis."""
    matte = colour * (material.ambient + material.diffuse * cosine)
    return np.minimum(matte + 255 * material.specular * cosine**material.shininess, 255)


def test_sphere_has_the_depth_the_limb_the_brightness_and_the_highlight_of_a_sphere(shapes, renderer):
    view = render(shapes["sphere"], ASIDE, SIZE, renderer, material=SHINY)
    sag = 0.5 * (1 - np.cos(np.radians(3)))  # the faces' chords span under 6 degrees
    assert view.mask[-sag - PIXEL > RADIUS - 0.5].all() and not view.mask[RADIUS > 0.5 + PIXEL].any()
    assert (ndimage.binary_fill_holes(view.mask) == view.mask).all()  # no cracks
    inner = RADIUS < 0.4
    assert np.abs(view.depth[inner] - (DISTANCE - np.sqrt(0.25 - RADIUS[inner] ** 2))).max() < 2 * sag
    inner = RADIUS < 0.45
    cosine = np.sqrt(1 - (RADIUS[inner] / 0.5) ** 2)
    assert np.abs(view.rgb[inner, 0] - lit(GREY, cosine, SHINY)).max() <= 0.03 * 255
    assert RADIUS[view.rgb[..., 0] == view.rgb.max()].max() < 0.05
    matte = render(shapes["sphere"], ASIDE, SIZE, renderer)
    assert np.abs(matte.rgb[inner, 0] - GREY * cosine).max() <= 0.01 * 255


@pytest.mark.parametrize("angle", [0, 60])
@pytest.mark.parametrize("material", [Material(), SHINY, Material(1.0, 0.0), Material(0.0, 1.0, 1.0, 1.0)])
def test_plate_reflects_what_the_formula_says_and_never_more_than_white(renderer, angle, material):
    view = render(square(colour=[250, 100, 0]), Viewpoint(angle, 0), SIZE, renderer, material=material)
    expected = lit(np.array([250, 100, 0]), np.cos(np.radians(angle)), material)
    assert np.abs(view.rgb[view.mask] - expected).max() <= 1


def test_plane_seen_from_behind_is_lit_too_and_edges_of_a_cube_stay_sharp(shapes, renderer):
    front, behind = (render(square(outwards=side), FRONT, SIZE, renderer) for side in (True, False))
    assert (front.rgb == behind.rgb).all()
    assert front.mask.sum() == pytest.approx((0.5 / PIXEL) ** 2, rel=0.02)
    cube = render(shapes["cube"], Viewpoint(30, 0), SIZE, renderer)
    assert set(np.unique(cube.rgb[cube.mask])) == {round(GREY * np.cos(np.radians(angle))) for angle in (30, 60)}


@pytest.mark.parametrize(("background", "level"), [("black", 0), ("grey", 128), ("white", 255)])
def test_background_has_its_colour_and_no_depth(shapes, renderer, background, level):
    view = render(shapes["torus"], FRONT, SIZE, renderer, background)
    assert (view.rgb[~view.mask] == level).all() and (view.face[~view.mask] == -1).all()
    assert np.isinf(view.depth[~view.mask]).all() and np.isfinite(view.depth[view.mask]).all()


def test_pixel_rays_through_seen_pixels_meet_the_surface_where_project_says(shapes, renderer):
    mesh, viewpoint = shapes["torus"], Viewpoint(120, 45, 20)
    view = render(mesh, viewpoint, SIZE, renderer)
    rows, columns = np.nonzero(view.mask)
    origins, directions = pixel_rays(rows, columns, viewpoint, SIZE)
    points = origins + view.depth[view.mask][:, None] * directions
    for projected, expected in zip(
        project(points, viewpoint, SIZE), (rows, columns, view.depth[view.mask]), strict=True
    ):
        assert np.allclose(projected, expected, atol=1e-6)
    face = view.face[view.mask]
    height = np.abs(np.einsum("ij,ij->i", points - mesh.vertices[mesh.faces[face, 0]], mesh.face_normals[face]))
    assert height.max() < 1e-4


def test_no_faces_and_one_triangle_are_views_too(renderer):
    empty = render(Mesh(np.zeros((0, 3)), np.zeros((0, 3))), FRONT, SIZE, renderer)
    assert not empty.mask.any() and (empty.rgb == 0).all()
    triangle = render(Mesh([[0, 0, 0], [0, 0.4, 0], [0, 0, 0.4]], [[0, 1, 2]]), FRONT, SIZE, renderer)
    assert triangle.mask.sum() * PIXEL**2 == pytest.approx(0.08, rel=0.05)
    assert set(np.unique(triangle.face)) == {-1, 0}


@NO_EGL
@pytest.mark.parametrize(
    ("name", "viewpoint", "material"),
    [("cube", ASIDE, Material()), ("bowl", Viewpoint(0, 90), Material()), ("coloured", ASIDE, SHINY)],
)
def test_renderers_agree(shapes, name, viewpoint, material):
    rays, drawn = (
        render(shapes[name], viewpoint, (300, 400), method, material=material) for method in ("raster", "pyrender")
    )
    footprint = 1 / pixels_per_unit(300)
    on = rays.mask & drawn.mask
    assert on.sum() > 0.99 * (rays.mask | drawn.mask).sum()
    # On the pixels of an edge between a near and a far surface either may be right.
    assert (rays.face[on] == drawn.face[on]).mean() > 0.99
    same = on & (rays.face == drawn.face)
    assert np.abs(rays.depth[same] - drawn.depth[same]).max() < footprint
    assert np.quantile(np.abs(rays.depth[on] - drawn.depth[on]), 0.999) < footprint
    assert np.abs(rays.rgb[same].astype(int) - drawn.rgb[same]).max() <= 2
    assert np.abs(rays.rgb[on].astype(int) - drawn.rgb[on]).mean() < 0.5


def test_without_egl_auto_takes_the_rays_and_says_so_once_and_pyrender_says_what_to_install(
    shapes, monkeypatch, capsys
):
    monkeypatch.setattr(gl, "egl_error", lambda: "no libEGL")
    renderers._available.cache_clear()
    try:
        views = [render(shapes["cube"], FRONT, (90, 120), "auto") for _ in range(2)]
    finally:
        renderers._available.cache_clear()
    assert all(view.mask.any() for view in views)
    assert capsys.readouterr().err.count("raster") == 1
    with pytest.raises(OSError, match="libegl1"):
        render(shapes["cube"], FRONT, (90, 120), "pyrender")


def test_the_default_draws_the_same_bytes_on_every_machine(shapes, monkeypatch):
    monkeypatch.setitem(renderers.RENDERERS, "pyrender", None)  # what EGL, where it is installed, would call
    assert render(shapes["cube"], FRONT, (90, 120)).mask.any()
    assert compute_maps(shapes["cube"], ["edge"], [FRONT]).vertices.size


@pytest.mark.parametrize("change", [lambda v: 3 * v, lambda v: v + [0, 0.6, 0], lambda v: v + [30, 0, 0]])
def test_mesh_outside_the_frame_is_told_to_normalise(shapes, renderer, change):
    mesh = Mesh(change(shapes["sphere"].vertices), shapes["sphere"].faces)
    with pytest.raises(ValueError, match="normalise"):
        render(mesh, FRONT, SIZE, renderer)


@pytest.mark.parametrize(
    ("call", "says"),
    [
        (lambda cube: render(cube, FRONT, renderer="blender"), "raster"),
        (lambda cube: render(cube, FRONT, background="pink"), "white"),
        (lambda cube: render(cube, FRONT, size=(0, 10)), "positive"),
        (lambda cube: render(cube, FRONT, size=(10.5, 10)), "whole"),
        (lambda cube: render(cube, FRONT, size=(10,)), "rows, columns"),
        (lambda _: Material(specular=1.2), "specular=1.2 of a material must be between 0 and 1"),
        (lambda _: Material(diffuse=-0.1), "diffuse=-0.1 .* between 0 and 1"),
        (lambda _: Material(ambient=float("nan")), "ambient=nan .* between 0 and 1"),
        (lambda _: Material(shininess=0.5), "shininess=0.5 .* between 1 and 1000"),
    ],
)
def test_wrong_arguments_are_named_with_what_is_right(shapes, call, says):
    with pytest.raises(ValueError, match=says):
        call(shapes["cube"])


def folded(angle):
    """Two triangles with one edge in common, folded by an angle in degrees."""
    c, s = np.cos(np.radians(angle)), np.sin(np.radians(angle))
    return Mesh([[0, 0, 0], [0, 1, 0], [-1, 0, 0], [c, 0, -s]], [[0, 1, 2], [1, 0, 3]])


@pytest.mark.parametrize(("angle", "groups"), [(0, 4), (39, 4), (41, 6)])
def test_normals_split_beyond_the_crease_and_where_windings_disagree(angle, groups):
    mesh = folded(angle)
    assert len(corner_groups(mesh)[1]) == groups
    assert len(corner_groups(Mesh(mesh.vertices, [mesh.faces[0], mesh.faces[1][::-1]]))[1]) == 6
    fin = Mesh(np.r_[mesh.vertices, [[1.0, 0, 0]]], np.r_[mesh.faces, [[1, 0, 4]]])
    assert len(corner_groups(fin)[1]) == 9  # three faces at an edge share no normal


def test_corners_of_a_cube_have_the_normals_of_its_sides_and_a_smooth_sphere_one_a_vertex():
    cube, ball = mesh_of(trimesh.creation.box()), mesh_of(trimesh.creation.icosphere(subdivisions=3))
    groups, normals = corner_groups(cube)
    assert len(normals) == 24 and np.allclose(normals[groups], cube.face_normals[:, None])
    groups, normals = corner_groups(ball)
    assert len(normals) == len(ball.vertices)
    assert np.einsum("ijk,ijk->ij", normals[groups], ball.vertices[ball.faces]).min() > 0.999
    groups, normals = corner_groups(Mesh(np.zeros((3, 3)), np.zeros((0, 3))))
    assert groups.shape == (0, 3) and normals.shape == (0, 3)


def test_narrow_bevel_leaves_the_wide_face_beside_it_flat():
    wide = folded(30)
    bevel = Mesh(wide.vertices * [[1], [1], [1], [0.02]], wide.faces)
    groups, normals = corner_groups(bevel)
    assert np.degrees(np.arccos(normals[groups[0, :2]] @ bevel.face_normals[0])).max() < 2

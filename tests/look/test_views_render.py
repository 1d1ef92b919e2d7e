"""What every renderer must draw: known depths, limbs and brightness, the nearest face, the whole object."""

import numpy as np
import pytest
from scipy import ndimage

from haptic_glance.look.camera import DISTANCE, Viewpoint, pixel_rays, pixels_per_unit, project
from haptic_glance.look.views import TWELVE, render
from haptic_glance.look.views.shading import GREY
from haptic_glance.mesh.mesh import Mesh

SIZE = (225, 300)
FRONT = Viewpoint(0, 0)
PIXEL = 1 / pixels_per_unit(SIZE[0])
GRID = np.indices(SIZE)
Y, X = ((SIZE[0] - 1) / 2 - GRID[0]) * PIXEL, (GRID[1] - (SIZE[1] - 1) / 2) * PIXEL


def turned(mesh, azimuth):
    c, s = np.cos(np.radians(azimuth)), np.sin(np.radians(azimuth))
    return Mesh(mesh.vertices @ np.array([[c, -s, 0], [s, c, 0], [0, 0, 1]]).T, mesh.faces)


def square(back=0.0, half=0.25, outwards=True):
    """A square across the x axis, seen from FRONT."""
    corners = half * np.array([[-1, -1], [1, -1], [1, 1], [-1, 1]])
    faces = np.array([[0, 1, 2], [0, 2, 3]])
    return Mesh(np.c_[np.full(4, back), corners], faces if outwards else faces[:, ::-1])


def both(*meshes):
    offsets = np.cumsum([0, *(len(mesh.vertices) for mesh in meshes)])
    faces = [mesh.faces + offset for mesh, offset in zip(meshes, offsets, strict=False)]
    return Mesh(np.concatenate([mesh.vertices for mesh in meshes]), np.concatenate(faces))


@pytest.mark.slow
@pytest.mark.parametrize("viewpoint", TWELVE, ids=lambda viewpoint: viewpoint.name)
def test_sphere_has_the_depth_and_the_limb_of_a_sphere(shapes, renderer, viewpoint):
    view = render(shapes["sphere"], viewpoint, SIZE, renderer)
    radius = np.hypot(X, Y)
    sag = 0.5 * (1 - np.cos(np.radians(3)))  # the faces' chords span under 6 degrees
    assert view.mask[radius < 0.5 - sag - PIXEL].all()
    assert not view.mask[radius > 0.5 + PIXEL].any()
    inner = radius < 0.4
    expected = DISTANCE - np.sqrt(0.25 - radius[inner] ** 2)
    assert np.abs(view.depth[inner] - expected).max() < 2 * sag


def test_brightness_of_a_sphere_falls_as_the_cosine(shapes, renderer):
    view = render(shapes["sphere"], FRONT, SIZE, renderer)
    inner = np.hypot(X, Y) < 0.45
    cosine = np.sqrt(1 - (np.hypot(X, Y)[inner] / 0.5) ** 2)
    assert np.abs(view.rgb[inner, 0] - GREY * cosine).max() <= 0.01 * 255


@pytest.mark.parametrize("angle", [0, 30, 60])
def test_plane_is_brightest_facing_the_light_and_falls_as_the_cosine(renderer, angle):
    view = render(square(), Viewpoint(angle, 0), SIZE, renderer)
    assert set(np.unique(view.rgb[view.mask])) == {round(GREY * np.cos(np.radians(angle)))}


def test_plane_seen_from_behind_is_lit_too(renderer):
    front, behind = (render(square(outwards=side), FRONT, SIZE, renderer) for side in (True, False))
    assert (front.rgb == behind.rgb).all()
    assert front.mask.sum() == pytest.approx((0.5 / PIXEL) ** 2, rel=0.02)


def test_edges_of_a_cube_stay_sharp(shapes, renderer):
    view = render(shapes["cube"], Viewpoint(30, 0), SIZE, renderer)
    expected = {round(GREY * np.cos(np.radians(angle))) for angle in (30, 60)}
    assert set(np.unique(view.rgb[view.mask])) == expected


@pytest.mark.parametrize("azimuth", [90, 37])
def test_turning_the_mesh_is_turning_the_camera(shapes, renderer, azimuth):
    mesh = both(shapes["torus"], square(back=0.3, half=0.1))
    still = render(mesh, Viewpoint(10, 30), SIZE, renderer)
    moved = render(turned(mesh, azimuth), Viewpoint(10 + azimuth, 30), SIZE, renderer)
    same = still.face == moved.face
    assert same.mean() > 0.999
    on = same & still.mask
    assert np.abs(still.depth[on] - moved.depth[on]).max() < 1e-3
    assert np.abs(still.rgb[on].astype(int) - moved.rgb[on]).max() <= 2


def test_hidden_faces_are_hidden(renderer):
    mesh = both(square(back=-0.1), square(back=0.1))
    from_front, from_behind = (render(mesh, Viewpoint(a, 0), SIZE, renderer) for a in (0, 180))
    assert set(np.unique(from_front.face)) == {-1, 2, 3}
    assert set(np.unique(from_behind.face)) == {-1, 0, 1}
    assert np.allclose(from_front.depth[from_front.mask], DISTANCE - 0.1, atol=1e-4)


def test_silhouette_of_a_closed_surface_has_no_cracks(shapes, renderer):
    mask = render(shapes["sphere"], Viewpoint(120, 45), SIZE, renderer).mask
    assert (ndimage.binary_fill_holes(mask) == mask).all()


@pytest.mark.parametrize(("background", "level"), [("black", 0), ("grey", 128), ("white", 255)])
def test_background_has_its_colour_and_no_depth(shapes, renderer, background, level):
    view = render(shapes["torus"], FRONT, SIZE, renderer, background)
    assert (view.rgb[~view.mask] == level).all()
    assert np.isinf(view.depth[~view.mask]).all()
    assert (view.face[~view.mask] == -1).all()
    assert np.isfinite(view.depth[view.mask]).all()


def test_vertex_colours_tint_the_light(renderer):
    plain = square()
    red = Mesh(plain.vertices, plain.faces, np.tile(np.array([[250, 20, 0]], dtype=np.uint8), (4, 1)))
    view = render(red, Viewpoint(60, 0), SIZE, renderer)
    assert np.abs(view.rgb[view.mask].astype(int) - [125, 10, 0]).max() <= 1


def test_pixel_rays_through_seen_pixels_meet_the_surface_where_project_says(shapes, renderer):
    viewpoint = Viewpoint(120, 45, 20)
    view = render(shapes["torus"], viewpoint, SIZE, renderer)
    rows, columns = np.nonzero(view.mask)
    origins, directions = pixel_rays(rows, columns, viewpoint, SIZE)
    points = origins + view.depth[view.mask][:, None] * directions
    back = project(points, viewpoint, SIZE)
    assert np.allclose(back[0], rows, atol=1e-6)
    assert np.allclose(back[1], columns, atol=1e-6)
    assert np.allclose(back[2], view.depth[view.mask], atol=1e-6)
    corners = shapes["torus"].vertices[shapes["torus"].faces[view.face[view.mask]]]
    normals = shapes["torus"].face_normals[view.face[view.mask]]
    height = np.abs(np.einsum("ij,ij->i", points - corners[:, 0], normals))
    assert height.max() < 1e-4


@pytest.mark.slow
def test_sphere_of_the_normalised_size_fits_the_frame_of_the_thesis(shapes):
    view = render(shapes["sphere"], FRONT, renderer="raster")
    rows = np.flatnonzero(view.mask.any(axis=1))
    assert len(rows) == pytest.approx(858.7, abs=2)
    assert rows[0] > 0 and rows[-1] < 899


def test_no_faces_and_one_triangle_are_views_too(renderer):
    empty = render(Mesh(np.zeros((0, 3)), np.zeros((0, 3))), FRONT, SIZE, renderer)
    assert not empty.mask.any() and (empty.rgb == 0).all()
    one = render(Mesh([[0, 0, 0], [0, 0.4, 0], [0, 0, 0.4]], [[0, 1, 2]]), FRONT, SIZE, renderer)
    assert one.mask.sum() * PIXEL**2 == pytest.approx(0.08, rel=0.05)
    assert set(np.unique(one.face)) == {-1, 0}


@pytest.mark.parametrize("change", [lambda v: 3 * v, lambda v: v + [0, 0.6, 0], lambda v: v + [30, 0, 0]])
def test_mesh_outside_the_frame_is_told_to_normalise(shapes, renderer, change):
    mesh = Mesh(change(shapes["sphere"].vertices), shapes["sphere"].faces)
    with pytest.raises(ValueError, match="normalise"):
        render(mesh, FRONT, SIZE, renderer)


@pytest.mark.parametrize(
    ("arguments", "says"),
    [
        ({"renderer": "blender"}, "raster"),
        ({"background": "pink"}, "white"),
        ({"size": (0, 10)}, "positive"),
        ({"size": (10.5, 10)}, "whole"),
        ({"size": (10,)}, "rows, columns"),
    ],
)
def test_wrong_arguments_are_named_with_what_is_right(shapes, arguments, says):
    with pytest.raises(ValueError, match=says):
        render(shapes["cube"], FRONT, **arguments)

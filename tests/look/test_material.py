"""A surface with a highlight: where it lies and how bright it is, and that without one every byte is as before."""

import zlib

import numpy as np
import pytest

from haptic_glance.look.camera import Viewpoint, pixels_per_unit
from haptic_glance.look.views import Material, gl, render
from haptic_glance.look.views.shading import GREY
from haptic_glance.mesh.mesh import Mesh

SIZE = (225, 300)
SHINY = Material(0.1, 0.5, 0.4, 20)
GRID = np.indices(SIZE)
RADIUS = np.hypot(GRID[0] - (SIZE[0] - 1) / 2, GRID[1] - (SIZE[1] - 1) / 2) / pixels_per_unit(SIZE[0])


def lit(colour, cosine, material):
    """Blinn's model under a head light, whose half vector is the view axis."""
    own = colour * (material.ambient + material.diffuse * cosine)
    return np.minimum(own + 255 * material.specular * cosine**material.shininess, 255)


def plate(colour):
    corners = 0.25 * np.array([[0, -1, -1], [0, 1, -1], [0, 1, 1], [0, -1, 1]])
    return Mesh(corners, [[0, 1, 2], [0, 2, 3]], np.tile(np.array(colour, dtype=np.uint8), (4, 1)))


@pytest.mark.parametrize("viewpoint", [Viewpoint(0, 0), Viewpoint(120, 45)], ids=lambda viewpoint: viewpoint.name)
def test_sphere_has_its_highlight_where_the_half_vector_is_the_normal(shapes, renderer, viewpoint):
    rgb = render(shapes["sphere"], viewpoint, SIZE, renderer, material=SHINY).rgb
    inner = RADIUS < 0.45
    cosine = np.sqrt(1 - (RADIUS[inner] / 0.5) ** 2)
    assert np.abs(rgb[inner, 0] - lit(GREY, cosine, SHINY)).max() <= 0.03 * 255
    assert RADIUS[rgb[..., 0] == rgb.max()].max() < 0.05
    matte = render(shapes["sphere"], viewpoint, SIZE, renderer, material=Material(0.1, 0.5)).rgb
    assert (rgb[RADIUS < 0.02].astype(int) - matte[RADIUS < 0.02] > 90).all()


@pytest.mark.parametrize("angle", [0, 30, 60])
@pytest.mark.parametrize("material", [SHINY, Material(0.3, 0.7), Material(1.0, 0.0), Material(0.0, 1.0, 1.0, 1.0)])
def test_plate_reflects_what_the_formula_says_and_never_more_than_white(renderer, angle, material):
    colour = np.array([250, 100, 0])
    view = render(plate(colour), Viewpoint(angle, 0), SIZE, renderer, material=material)
    expected = lit(colour, np.cos(np.radians(angle)), material)
    assert np.abs(view.rgb[view.mask] - expected).max() <= 1


@pytest.mark.parametrize(("name", "digest"), [("torus", 619272885), ("coloured", 3043483328)])
def test_without_a_highlight_every_byte_is_that_of_lambert(shapes, name, digest):
    for material in ({}, {"material": Material(shininess=3)}):
        view = render(shapes[name], Viewpoint(120, 45), SIZE, "raster", **material)
        assert zlib.crc32(view.rgb.tobytes()) == digest


def test_the_material_holds_for_one_picture_alone(shapes, renderer):
    pictures = [
        render(shapes["coloured"], Viewpoint(0, 30), SIZE, renderer, material=material).rgb
        for material in (Material(), SHINY, Material(), SHINY)
    ]
    assert (pictures[0] == pictures[2]).all() and (pictures[1] == pictures[3]).all()
    assert (pictures[0] != pictures[1]).any()


def test_the_order_of_vertices_does_not_matter(shapes, renderer):
    mesh = shapes["coloured"]
    new = np.random.default_rng(0).permutation(len(mesh.vertices))
    old = np.argsort(new)
    shuffled = Mesh(mesh.vertices[old], new[mesh.faces], mesh.colors[old])
    one, other = (render(each, Viewpoint(0, 30), SIZE, renderer, material=SHINY) for each in (mesh, shuffled))
    assert (one.face == other.face).all() and (one.rgb == other.rgb).all()


@pytest.mark.skipif(bool(gl.egl_error()), reason=f"no EGL context on this machine: {gl.egl_error()}")
@pytest.mark.parametrize("name", ["sphere", "cube", "coloured"])
def test_renderers_agree_on_highlights(shapes, name):
    rays, drawn = (
        render(shapes[name], Viewpoint(120, 45), SIZE, which, "black", SHINY) for which in ("raster", "pyrender")
    )
    same = rays.mask & drawn.mask & (rays.face == drawn.face)
    assert same.sum() > 0.98 * rays.mask.sum()
    assert np.abs(rays.rgb[same].astype(int) - drawn.rgb[same]).max() <= 2


@pytest.mark.parametrize(
    ("settings", "says"),
    [
        ({"specular": 1.2}, "specular=1.2 of a material must be between 0 and 1"),
        ({"diffuse": -0.1}, "diffuse=-0.1 .* between 0 and 1"),
        ({"ambient": float("nan")}, "ambient=nan .* between 0 and 1"),
        ({"shininess": 0.5}, "shininess=0.5 .* between 1 and 1000"),
    ],
)
def test_a_value_out_of_range_is_named_with_the_range(settings, says):
    with pytest.raises(ValueError, match=says):
        Material(**settings)

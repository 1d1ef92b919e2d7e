"""Colours, texture coordinates and materials through simplification."""

from dataclasses import replace

import numpy as np
import pytest

from haptic_glance.lod import attributes, simplify
from haptic_glance.lod.attributes import carry
from haptic_glance.lod.borders import close_borders, cut_borders
from haptic_glance.lod.seams import charts
from haptic_glance.mesh.mesh import Mesh, Texture

from .conftest import GREY, sheet, tube


def painted_sheet():
    """The square with its plan as texture coordinates, and colours that grow with x and y."""
    mesh = sheet(24, height=0.03)
    plan = mesh.vertices[:, :2]
    colors = np.column_stack([200 * plan, np.full(len(plan), 50)]).round().astype(np.uint8)
    return Mesh(mesh.vertices, mesh.faces, colors, Texture(plan[mesh.faces], np.zeros(len(mesh.faces)), (GREY,)))


def bare(mesh):
    return Mesh(mesh.vertices, mesh.faces)


@pytest.mark.parametrize("make", [painted_sheet, tube])
def test_onto_itself_nothing_changes(make):
    mesh = make()
    assert carry(bare(mesh), mesh) is mesh
    carried = carry(mesh, bare(mesh))
    assert np.abs(carried.texture.uv - mesh.texture.uv).max() < 1e-6
    assert (carried.texture.image == mesh.texture.image).all()
    assert mesh.colors is None or (carried.colors == mesh.colors).all()


def test_colours_are_interpolated_where_a_vertex_has_moved():
    mesh = painted_sheet()
    shifted = bare(mesh).vertices[mesh.faces].mean(axis=1)
    corners = Mesh(shifted, np.arange(len(shifted) // 3 * 3).reshape(-1, 3))
    carried = carry(mesh, corners)
    assert np.abs(carried.colors[:, :2] - 200 * shifted[:, :2]).max() < 1.5


def test_no_face_shows_the_picture_between_the_two_sides_of_a_seam():
    mesh = tube()
    carried = carry(mesh, simplify(bare(mesh), 400))
    centre = carried.vertices[carried.faces].mean(axis=1)
    angle = np.arctan2(centre[:, 1], centre[:, 0]) / (2 * np.pi) % 1
    off = np.abs((carried.texture.uv.mean(axis=1)[:, 0] - angle + 0.5) % 1 - 0.5)
    assert np.ptp(carried.texture.uv[..., 0], axis=1).max() < 0.5
    assert off.max() < 0.03


def test_face_takes_the_chart_under_its_centre_and_no_other():
    # Two halves of a painted_sheet, whose pictures lie far apart.
    mesh = sheet(24, height=0.03)
    right = mesh.vertices[mesh.faces][:, :, 0].mean(axis=1) > 0.5
    uv = mesh.vertices[mesh.faces][:, :, :2] + np.where(right, 10, 0)[:, None, None]
    mesh = Mesh(mesh.vertices, mesh.faces, None, Texture(uv, np.zeros(len(uv)), (GREY,)))
    carried = carry(mesh, simplify(bare(mesh), 260))
    shifted = carried.texture.uv.mean(axis=1)[:, 0] > 5
    assert (shifted == (carried.vertices[carried.faces].mean(axis=1)[:, 0] > 0.5)).all()
    assert (np.ptp(carried.texture.uv, axis=1) < 1).all()


def test_charts_end_at_seams_and_at_other_materials():
    mesh = painted_sheet()
    assert (charts(mesh)[0] == 0).all()
    image = (mesh.vertices[mesh.faces][:, :, 0].mean(axis=1) > 0.5).astype(int)
    two = Mesh(mesh.vertices, mesh.faces, None, Texture(mesh.texture.uv, image, (GREY, GREY)))
    chart, seams = charts(two)
    assert len(np.unique(chart)) == 2 and (chart == chart[0]).sum() == (image == image[0]).sum()
    assert len(seams.chart) == 0
    assert len(charts(tube())[1].chart) == 2 * 24


@pytest.mark.parametrize("together", [1, 2])
def test_each_chart_is_searched_without_the_faces_of_all_others(together, monkeypatch):
    mesh = painted_sheet()
    uv = mesh.texture.uv + (10.0 * (np.arange(len(mesh.faces)) % 576 // together))[:, None, None]
    apart = replace(mesh, texture=replace(mesh.texture, uv=uv))
    sizes = []
    monkeypatch.setattr(attributes, "Mesh", lambda *arrays: sizes.append(len(arrays[0])) or Mesh(*arrays))
    carried = attributes.carry_texture(apart, bare(mesh))
    assert np.abs(carried.uv - uv).max() < 1e-6 and max(sizes, default=0) <= 6


def test_bad_surfaces_give_finite_coordinates():
    mesh = painted_sheet()
    flat = np.array([[0, 1, 1], [5, 5, 5], *mesh.faces])  # faces of no area beside the good ones
    uv = np.concatenate([np.zeros((2, 3, 2)), mesh.texture.uv])
    poor = Mesh(mesh.vertices, flat, mesh.colors, Texture(uv, np.zeros(len(uv)), (GREY,)))
    far = Mesh(100 + 0 * mesh.vertices[:3], [[0, 1, 2]])
    assert np.isfinite(carry(poor, far).texture.uv).all()
    with pytest.raises(ValueError, match="no faces"):
        carry(Mesh(mesh.vertices, np.zeros((0, 3), int), mesh.colors), mesh)


def striped():
    mesh = sheet(24, height=0.03)
    middle = mesh.vertices[mesh.faces][:, :, 0].mean(axis=1)
    image = ((middle > 0.25) & (middle < 0.75)).astype(int)
    return Mesh(mesh.vertices, mesh.faces, None, Texture(np.zeros((len(image), 3, 2)), image, (GREY, GREY)))


def test_cut_border_closed_again_is_the_mesh_itself():
    mesh = striped()
    cut, ids = cut_borders(mesh)
    assert len(cut.vertices) == len(mesh.vertices) + 2 * 25
    assert np.array_equal(cut.vertices, mesh.vertices[ids])
    assert np.array_equal(cut.vertices[cut.faces], mesh.vertices[mesh.faces])
    closed = close_borders(cut, cut, ids)
    assert len(closed.vertices) == len(mesh.vertices)
    assert np.array_equal(closed.vertices[closed.faces], mesh.vertices[mesh.faces])
    assert len(closed.edge_counts[1]) == len(mesh.edge_counts[1])


def test_border_between_materials_stays_in_its_place():
    mesh = striped()
    cut, ids = cut_borders(mesh)
    carried = carry(mesh, close_borders(simplify(bare(cut), 500), cut, ids))
    areas = [np.bincount(surface.texture.image, weights=surface.face_areas) for surface in (mesh, carried)]
    assert areas[1] == pytest.approx(areas[0], rel=0.01)
    middle = carried.vertices[carried.faces][:, :, 0]
    inside = (middle > 0.25 - 1e-9).all(axis=1) & (middle < 0.75 + 1e-9).all(axis=1)
    assert (inside == (carried.texture.image == 1)).all()
    assert (carried.edge_counts[1] == 1).sum() == (mesh.edge_counts[1] == 1).sum()


@pytest.mark.parametrize(
    ("uv", "image", "words"),
    [
        (np.zeros((4, 2)), np.zeros(4), "uv must be"),
        (np.zeros((4, 3, 2)), np.ones(4), "outside 0..0"),
        (np.zeros((4, 3, 2)), np.zeros(4), "of 1152 faces"),
    ],
)
def test_texture_says_what_is_wrong_with_it(uv, image, words):
    with pytest.raises(ValueError, match=words):
        Mesh(sheet(24).vertices, sheet(24).faces, None, Texture(uv, image, (GREY,)))

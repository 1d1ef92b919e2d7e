"""Colours, texture coordinates and normals in the error of simplification, on surfaces where the answer is known."""

import numpy as np
import pytest
import trimesh

from haptic_glance.lod import InfeasibleTarget, colour_error, fast, metro, simplify
from haptic_glance.lod.attribute_quadrics import attribute_quadrics
from haptic_glance.lod.kernels.collapse import decimate
from haptic_glance.mesh.mesh import Mesh, Texture
from haptic_glance.mesh.nearest import closest

from .conftest import GREY, ball, centres, grey, sheet, tube

COLORS, UV = {"colors": 1.0}, {"uv": 1.0}
RAMP = np.dstack([*np.meshgrid(np.arange(256), 255 - np.arange(256)), *2 * [np.full((256, 256), 255)]]).astype(np.uint8)


def charted(mesh, second, apart=3.0):
    """The mesh with its plan as texture coordinates, those of the faces `second` (m,) so far apart from the others."""
    uv = mesh.vertices[mesh.faces][:, :, :2] + np.where(second, apart, 0.0)[:, None, None]
    return Mesh(mesh.vertices, mesh.faces, None, Texture(uv, np.zeros(len(uv)), (GREY,)))


def disc(x, y):
    return np.where(np.hypot(x - 0.5, y - 0.5) < 0.3, 0, 255)


def test_faces_gather_at_a_painted_step_of_a_flat_square():
    mesh = sheet(paint=disc)
    blind, seeing = simplify(mesh, 500), simplify(mesh, 500, attributes=COLORS)
    assert len(seeing.faces) == len(blind.faces) == 500
    assert colour_error(mesh, blind) > 10 and colour_error(mesh, seeing) < 0.5

    def share_beside(simplified):
        """The share of the vertices within the square that lie beside the step."""
        inner = ((simplified.vertices[:, :2] > 0) & (simplified.vertices[:, :2] < 1)).all(axis=1)
        x, y = simplified.vertices[inner][:, :2].T
        around = [disc(x + dx, y + dy) for dx in (-0.03, 0.03) for dy in (-0.03, 0.03)]
        return np.mean(np.ptp(around, axis=0) > 0)

    assert share_beside(seeing) > 3 * share_beside(blind)


def test_smooth_colours_come_out_closer_and_the_shape_stays():
    plain = ball(5, radius=1.0)
    x, y, _ = plain.vertices.T
    mesh = Mesh(plain.vertices, plain.faces, grey(127 * (1 + np.sin(6 * x) * np.cos(5 * y))))
    blind, seeing = simplify(mesh, 2000), simplify(mesh, 2000, attributes={"colors": 0.1})
    assert colour_error(mesh, seeing) < colour_error(mesh, blind) / 2 < 2.5
    assert metro(mesh, seeing)["mean"] < 1.5 * metro(mesh, blind)["mean"]


def test_what_is_linear_costs_nothing():
    mesh = sheet(51, lambda x, y: 5 * np.rint(51 * x))
    turn = trimesh.transformations.rotation_matrix(0.7, [1, 2, 3])[:3, :3]
    mesh = Mesh(mesh.vertices @ turn.T, mesh.faces, mesh.colors)
    surface, added, wedges = quadrics_of(mesh, "colors")
    assert (added[:, 9] > 0).any()
    assert np.abs(left_of(added, wedges, surface)).max() < 1e-12
    assert colour_error(mesh, simplify(mesh, 600, attributes=COLORS)) < 0.6  # rounded to whole numbers


def quadrics_of(mesh, name):
    """(HalfEdgeMesh, quadrics to add, Wedges) of a mesh with one attribute, at a weight of 1."""
    surface, source, _ = fast.half_edge_mesh(mesh, np.zeros(len(mesh.faces), bool), None)
    place = surface.position, surface.corner, surface.opposite, np.ones(len(source))
    return surface, *attribute_quadrics(mesh, ((name, 1.0),), *place)


def left_of(added, wedges, surface):
    """(n, 4, 4) quadrics of the disagreement alone: the squares without those of the means."""
    excess = np.zeros((len(added), 4, 4))
    rows, columns = [0, 0, 0, 1, 1, 2, 0, 1, 2, 3], [0, 1, 2, 1, 2, 2, 3, 3, 3, 3]
    excess[:, rows, columns] = excess[:, columns, rows] = added
    owner = np.zeros(len(wedges.merged), dtype=int)
    owner[wedges.wedge] = surface.corner
    means = wedges.sums[:-1, 1:].reshape(len(owner) - 1, -1, 4)
    np.add.at(excess, owner[:-1], -np.einsum("wka,wkb,w->wab", means, means, 1 / wedges.sums[:-1, 0]))
    return excess


def test_no_face_covers_a_curved_seam():
    mesh = sheet()
    mesh = charted(mesh, np.hypot(*(centres(mesh)[:, :2] - 0.5).T) < 0.3)
    blind, seeing = simplify(mesh, 700), simplify(mesh, 700, attributes=UV)

    def strayed(simplified):
        return np.abs(simplified.texture.uv % 3 - simplified.vertices[simplified.faces][:, :, :2]).max(), wrong_area(
            mesh, simplified
        )

    assert strayed(blind)[1] > 0.003
    assert strayed(seeing) == pytest.approx((0, 0), abs=1e-8)


def wrong_area(mesh, simplified):
    """The share of the surface that shows another chart, 3 apart, than the mesh does there."""
    share = np.random.default_rng(0).dirichlet([1, 1, 1], 20_000)
    face = np.random.default_rng(1).integers(len(mesh.faces), size=len(share))
    points = np.einsum("ij,ijk->ik", share, mesh.vertices[mesh.faces[face]])
    nearest = closest(simplified, points)[1]
    return (
        np.abs(mesh.texture.uv[face].mean(axis=1) - simplified.texture.uv[nearest].mean(axis=1)).max(axis=1) > 1.5
    ).mean()


def test_a_straight_seam_costs_few_vertices():
    # Its vertices merge with each other, each side by itself: else all 47 of them would stay.
    mesh = sheet()
    simple = simplify(charted(mesh, centres(mesh)[:, 0] > 0.5), 500, attributes=UV)
    on = np.flatnonzero(np.abs(simple.vertices[:, 0] - 0.5) < 1e-9)
    assert 2 <= len(on) < 30


def test_a_seam_within_one_chart_holds():
    mesh = tube(96, 48)
    uv = mesh.texture.uv.copy()
    uv[..., 1] += 0.08 * np.sin(4 * np.pi * uv[..., 1])
    mesh = Mesh(mesh.vertices, mesh.faces, None, Texture(uv, mesh.texture.image, (RAMP,)))
    blind, seeing = (simplify(mesh, 800, attributes=way) for way in (None, UV))
    assert colour_error(mesh, seeing) < colour_error(mesh, blind) / 3
    assert np.ptp(seeing.texture.uv[..., 0], axis=1).max() < 0.6
    assert len(seeing.edge_counts[1]) - (seeing.edge_counts[1] == 1).sum() == 3 * 400 - 96  # no crack


def test_coordinates_that_agree_are_no_seam():
    mesh = sheet(24)
    first, second = charted(mesh, centres(mesh)[:, 0] > 0.5, apart=0.0), charted(mesh, np.zeros(len(mesh.faces), bool))
    simple = [simplify(variant, 300, attributes=UV) for variant in (first, second)]
    assert simple[0].vertices.tobytes() == simple[1].vertices.tobytes()


def test_normals_of_an_edged_solid_come_out_closer():
    made = trimesh.creation.box().subdivide().subdivide().subdivide().subdivide()
    mesh = Mesh(made.vertices + 0.05 * np.sin(9 * made.vertices[:, [1, 2, 0]]), made.faces)

    def off(simplified):
        _, face, share = closest(simplified, centres(mesh))
        normals = np.einsum("ij,ijk->ik", share, simplified.vertex_normals[simplified.faces[face]])
        expected = mesh.vertex_normals[mesh.faces].mean(axis=1)
        return np.sqrt(((expected - normals) ** 2).sum(axis=1).mean())

    assert off(simplify(mesh, 800, attributes={"normals": 0.1})) < off(simplify(mesh, 800)) / 2


def test_without_weights_nothing_changes():
    mesh = sheet(24, disc, 0.1)
    plain, zero = simplify(mesh, 300), simplify(mesh, 300, attributes={"colors": 0, "normals": 0.0})
    for name in ("vertices", "faces", "colors"):
        assert getattr(plain, name).tobytes() == getattr(zero, name).tobytes()


def test_what_is_kept_keeps_its_colours():
    mesh = sheet(32, height=0.1)
    colors = np.random.default_rng(0).integers(0, 256, (len(mesh.vertices), 3))
    mesh = Mesh(mesh.vertices, mesh.faces, colors)
    simple = simplify(mesh, 900, [500], 2, attributes=COLORS)
    old = {tuple(place): tuple(color) for place, color in zip(mesh.vertices, mesh.colors, strict=True)}
    new = {tuple(place): tuple(color) for place, color in zip(simple.vertices, simple.colors, strict=True)}
    places = {tuple(place) for place in mesh.vertices[mesh.rings([500], 2)]}
    assert places <= new.keys() and all(new[place] == old[place] for place in places)


def test_salient_places_weigh_more_in_colours_too():
    mesh = sheet(64, lambda x, y: 127 * (1 + np.sin(40 * x) * np.sin(40 * y)))
    left = mesh.vertices[:, 0] < 0.5
    simple = simplify(mesh, 1500, weights=left.astype(float), attributes=COLORS)
    inside = (simple.vertices[:, 1] > 0) & (simple.vertices[:, 1] < 1)
    assert (inside & (simple.vertices[:, 0] < 0.5)).sum() > 1.5 * (inside & (simple.vertices[:, 0] > 0.5)).sum()


def test_scale_and_place_change_nothing():
    mesh = sheet(32, disc, 0.05)
    large = Mesh(1024 * mesh.vertices, mesh.faces, mesh.colors)
    first, second = (simplify(variant, 400, attributes=COLORS) for variant in (mesh, large))
    assert np.array_equal(first.faces, second.faces) and np.array_equal(first.colors, second.colors)


def test_vertices_in_no_face_and_their_attributes_do_not_matter():
    small = sheet(24, disc, 0.1)
    ids = np.sort(np.random.default_rng(0).choice(9000, len(small.vertices), replace=False))
    vertices = np.random.default_rng(1).normal(size=(9000, 3))
    colors = np.random.default_rng(2).integers(0, 256, (9000, 3))
    vertices[ids], colors[ids] = small.vertices, small.colors
    first = simplify(small, 400, [5], attributes=COLORS)
    second = simplify(Mesh(vertices, ids[small.faces], colors), 400, [ids[5]], attributes=COLORS)
    assert first.vertices.tobytes() == second.vertices.tobytes() and first.colors.tobytes() == second.colors.tobytes()


def test_faces_without_area_and_all_corners_apart_do_no_harm():
    mesh = sheet(16, disc, 0.05)
    random = np.random.default_rng(0)
    bad = np.r_[mesh.faces, [[3, 3, 4], [5, 5, 5], [0, 1, 2]]]  # the last has its corners on a line
    texture = Texture(random.random((len(bad), 3, 2)), np.zeros(len(bad)), (GREY,))  # every edge is a seam
    mesh = Mesh(mesh.vertices, bad, mesh.colors, texture)
    try:
        simple = simplify(mesh, 300, attributes={**COLORS, **UV, "normals": 0.1})
    except InfeasibleTarget as error:
        simple = simplify(mesh, error.smallest, attributes={**COLORS, **UV, "normals": 0.1})
    assert len(simple.faces) < len(bad) and np.isfinite(simple.vertices).all() and np.isfinite(simple.texture.uv).all()


def test_slivers_say_nothing_of_gradients():
    mesh = sheet(16, disc)
    vertices = mesh.vertices.copy()
    vertices[60] = vertices[61] + [0, 1e-9, 0]  # faces of that height, and one of none
    colors = np.random.default_rng(0).integers(0, 256, mesh.colors.shape)
    mesh = Mesh(vertices, np.r_[mesh.faces, [[3, 3, 4]]], colors)
    assert 0 < quadrics_of(mesh, "colors")[1].max() < 100


def test_wedges_add_up_after_the_collapses():
    mesh = tube(48, 24)
    surface, added, wedges = quadrics_of(mesh, "uv")
    before = surface.corner.copy()
    surface.quadric[:] += added
    first = wedges.sums.copy()
    decimate(surface, wedges, 400, *fast.ATTEMPTS[0], fast.FOLD)
    root, top = wedges.merged.copy(), surface.parent.copy()
    while (root[root] != root).any() or (top[top] != top).any():
        root, top = root[root], top[top]
    expected = np.zeros_like(first)
    np.add.at(expected, root, first)
    alive = root == np.arange(len(root))
    assert wedges.sums[alive] == pytest.approx(expected[alive], abs=1e-12)
    vertex = np.full(len(root), -1)
    vertex[wedges.wedge] = top[before]  # of each first wedge, the vertex into which its own was merged
    rings = {}
    for w in np.flatnonzero(alive[:-1]):
        rings.setdefault(vertex[w], set()).add(w)
    for members in rings.values():
        w = next(iter(members))
        ring = [w]
        while wedges.following[ring[-1]] != w:
            ring.append(wedges.following[ring[-1]])
            assert len(ring) <= len(members)
        assert set(ring) == members
    assert max(map(len, rings.values())) == 2  # on the seam


def test_colour_error_is_zero_on_the_mesh_itself_and_known_on_two_greys():
    black, white = sheet(8, lambda x, y: 0 * x), sheet(8, lambda x, y: 0 * x + 200)
    assert colour_error(black, black) == 0 and colour_error(black, white) == 200
    half = sheet(8, lambda x, y: np.where(x > 0.49, 200, 0))
    assert colour_error(black, half) == pytest.approx(200 * np.sqrt(0.5 + 0.125 / 3), rel=0.02)
    plan = Texture(black.vertices[black.faces][..., :2], np.zeros(128), (RAMP,))
    shown = sheet(8, lambda x, y: 0 * x + 255)
    shown.colors[:, 0], shown.colors[:, 1] = (255 * black.vertices[:, :2]).T
    assert colour_error(Mesh(black.vertices, black.faces, None, plan), shown) < 1
    left = Mesh(half.vertices, half.faces[centres(half)[:, 0] < 0.3], half.colors)  # black, seen from there no error
    assert min(colour_error(left, half), colour_error(half, left)) > 100
    with pytest.raises(ValueError, match="no colours to compare"):
        colour_error(black, sheet(8))
    with pytest.raises(ValueError, match="samples"):
        colour_error(black, black, samples=0)

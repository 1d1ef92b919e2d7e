"""Colours and texture coordinates of a surface transferred to a coarser one of the same shape.

Each comes from the closest point of the original surface. Texture coordinates are transferred chart by chart: a chart
is a patch of faces whose coordinates are continuous across the edges between them, a seam is where they are not. A face
of the coarse mesh takes the chart under its centre, so that no face shows the stretch of image between two charts, and
all faces around a vertex within a chart share its coordinates, so that the picture is torn nowhere else.
"""

from dataclasses import dataclass, replace

import numpy as np
from scipy import sparse

from haptic_glance.mesh.materials import corner_colours, picture_of_corners, shown_at_corners
from haptic_glance.mesh.mesh import Mesh, Texture
from haptic_glance.mesh.nearest import SurfaceIndex, closest, same_place
from haptic_glance.mesh.rays import barycentric

from .seams import SAME, Corners, charts, explained, joined, own_sides

INWARDS = 1e-3  # of the way to the face's centre: a corner on a seam then lies on its own side of it
FAR = 50.0  # barycentric: how far the map under a centre is extrapolated to corners some tens of faces away
TOUCHING = 1e-4  # of the diagonal: faces closer together than this touch; a thin sheet is thicker
ROUNDING = 1e-9  # barycentric: a point this close to a corner is the corner
STEPS, DAMPING = 8, 0.8  # of Jacobi's method: each leaves at most 0.6 of the difference


def carry(reference: Mesh, mesh: Mesh) -> Mesh:
    """`mesh` with the colours and the texture of `reference`, the Mesh from which it was simplified.

    Colours (n, 3) are interpolated at the closest point of the reference's surface; a vertex at the position of one of
    the reference's takes its colour unchanged. Texture coordinates (m, 3, 2) are those of the chart under the face's
    centre, at the closest point of each vertex within the chart: faces share them, but across a seam of the original.
    Vertices that moved take those of least squared error over the faces around. Beyond a seam a corner takes the end of
    its chart, or the coordinates there where the picture repeats. The images stay unchanged, but a
    `picture_of_corners` is drawn anew. Colours that `mesh` has already stay, as those of a simplification whose error
    counts them. Where the reference has neither, the mesh itself is returned.

    Source: attributes at the closest point as in Cohen, Olano and Manocha 1998 (appearance-preserving simplification,
    section 3); the thesis has no attributes. Raises ValueError where the reference has no faces.
    """
    if len(reference.faces) == 0:
        raise ValueError("the reference has no faces to take attributes from")
    if mesh is reference or len(mesh.faces) == 0 or (reference.colors is None and reference.texture is None):
        return mesh
    colors = mesh.colors
    if colors is None and reference.colors is not None:
        colors = carry_colors(reference, mesh.vertices)
    texture = None if reference.texture is None else carry_texture(reference, mesh)
    return Mesh(mesh.vertices, mesh.faces, colors, texture, reference.up)


def carry_colors(reference: Mesh, points: np.ndarray) -> np.ndarray:
    """(k, 3) u1: the reference's vertex colours at the closest points of its surface to points (k, 3)."""
    _, face, weights = closest(reference, points)
    assert reference.colors is not None
    colors = np.einsum("ij,ijk->ik", weights, reference.colors[reference.faces[face]].astype(np.float64))
    vertex = same_place(reference.vertices[reference.used], points)
    colors[vertex >= 0] = reference.colors[reference.used[vertex[vertex >= 0]]]
    return np.rint(colors).astype(np.uint8)


def faces_under(index: SurfaceIndex, mesh: Mesh) -> tuple[np.ndarray, np.ndarray]:
    """(centres (m, 3) of the faces of a simplified mesh, faces (m,) of the original that are closest to them).

    Of two faces that touch, as where two parts meet, the face that looks the same way counts.
    """
    centres = mesh.vertices[mesh.faces].mean(axis=1)
    distances, found = index.nearest(centres)
    normals, original = mesh.face_normals, index.mesh.face_normals
    against = np.flatnonzero(np.einsum("ij,ij->i", normals, original[found]) < 0)
    side = np.abs(normals[against]).argmax(axis=1)
    side = 2 * side + (normals[against, side] < 0)
    limit = TOUCHING * index.mesh.diagonal
    for number, places in _by_value(side).items():  # the faces that look along an axis, or against it
        source, rows = np.flatnonzero(original[:, number // 2] * (-1) ** number > 0), against[places]
        if len(source):
            apart, ids = SurfaceIndex(Mesh(index.mesh.vertices, index.mesh.faces[source])).nearest(centres[rows])
            looks = np.einsum("ij,ij->i", normals[rows], original[source[ids]]) > 0
            near = looks & (apart <= distances[rows] + limit)
            found[rows[near]] = source[ids[near]]
    return centres, found


def carry_texture(reference: Mesh, mesh: Mesh) -> Texture:
    """The Texture of the faces of `mesh`, taken from the reference's.

    Colours of vertices that stand beside pictures (`picture_of_corners`) are interpolated, in a new picture. Where two
    colours meet, a chart ends, so that each face takes the colours of its own side.
    """
    original = reference.texture
    assert original is not None
    at_corners, plain = shown_at_corners(original), replace(original, materials=())  # pixels without factors
    if at_corners.any():  # numbers of colours, in place of places in their picture, tell where charts end
        uv = original.uv.copy()
        uv[at_corners, :, 0] = corner_colours(plain, np.flatnonzero(at_corners)) @ [1, 256, 256**2]
        uv[at_corners, :, 1] = 0
        reference = replace(reference, texture=replace(original, uv=uv))
    chart, seams = charts(reference)
    search = ChartSearch(reference, chart)
    centres, under = faces_under(search.index, mesh)
    weights = search.index.weights(centres, under)
    # All corners of a vertex within a chart share one closest point, so that their coordinates are equal bit for bit.
    size = int(chart.max()) + 1
    pairs, number = np.unique(mesh.faces * size + chart[under][:, None], return_inverse=True)
    vertex_ids, wanted = np.divmod(pairs, size)
    number, vertices = number.reshape(-1, 3), mesh.vertices[vertex_ids]
    nearest = search.closest(vertices, wanted)
    uv = nearest.uv[number]
    in_seamed = np.isin(chart[under], seams.chart)
    if in_seamed.any():
        places = centres[in_seamed], under[in_seamed], weights[in_seamed]
        uv[in_seamed] = _on_own_sides(search, seams, vertices, nearest, number[in_seamed], *places)
    fixed = (nearest.points == vertices).all(axis=1) | _at_ends(seams, nearest)
    steps = uv - nearest.uv[number]
    off_line = np.abs(steps - np.rint(steps)).max(axis=2) > SAME  # on another side, where the picture does not repeat
    uv = _fitted(mesh.face_areas, uv, _uv_at(reference, under, weights), number, fixed[number] | off_line)
    image, images = original.image[under], list(original.images)
    for shown in np.unique(image[at_corners[under]]):
        faces = np.flatnonzero(image == shown)
        corners = number[faces].ravel()
        colors = np.einsum("ij,ijk->ik", nearest.weights[corners], corner_colours(plain, nearest.faces[corners]))
        uv[faces], images[shown] = picture_of_corners(np.rint(colors).reshape(-1, 3, 3))
    return replace(original, uv=uv, image=image, images=tuple(images))


@dataclass(frozen=True)
class Closest:
    """Points (k, 3) of a mesh, at barycentric weights (k, 3) of its faces (k,), and the coordinates uv (k, 2) there."""

    points: np.ndarray
    faces: np.ndarray
    weights: np.ndarray
    uv: np.ndarray


class ChartSearch:
    """The closest points of a textured mesh within its charts (m,)."""

    def __init__(self, mesh: Mesh, chart: np.ndarray) -> None:
        self.mesh, self.chart, self.index = mesh, chart, SurfaceIndex(mesh)
        self.faces_of = _by_value(chart)

    def nearest(self, points: np.ndarray, wanted: np.ndarray) -> np.ndarray:
        """(k,) faces closest to points (k, 3), of the charts `wanted` (k,)."""
        nearest = self.index.nearest(points)[1]
        foreign = np.flatnonzero(self.chart[nearest] != wanted)  # few: only their charts are searched apart
        for number, places in _by_value(wanted[foreign]).items():
            source, rows = self.faces_of[number], foreign[places]
            nearest[rows] = source[0]
            if len(source) > 1:
                vertex_ids, ids = np.unique(self.mesh.faces[source], return_inverse=True)
                part = SurfaceIndex(Mesh(self.mesh.vertices[vertex_ids], ids.reshape(-1, 3)))
                nearest[rows] = source[part.nearest(points[rows])[1]]
        return nearest

    def closest(self, points: np.ndarray, wanted: np.ndarray) -> Closest:
        """The Closest to points (k, 3) in the charts `wanted` (k,)."""
        return self.within(points, self.nearest(points, wanted))

    def within(self, points: np.ndarray, faces: np.ndarray) -> Closest:
        """The Closest to points (k, 3) in faces (k,); corners have their own coordinates, unrounded."""
        weights = self.index.weights(points, faces)
        weights[weights < ROUNDING] = 0
        weights[weights > 1 - ROUNDING] = 1
        places = np.einsum("ij,ijk->ik", weights, self.mesh.vertices[self.mesh.faces[faces]])
        return Closest(places, faces, weights, _uv_at(self.mesh, faces, weights))


def _on_own_sides(search, seams, vertices, closest, number, centres, under, weights):
    """(k, 3, 2) texture coordinates of the corners of faces, on the sides of the seams where their centres lie.

    vertices (n, 3) and the Closest to them; number (k, 3): which of them the corners are. centres (k, 3) of the faces,
    and the reference's faces (k,) under them, at barycentric weights (k, 3).
    """
    number, faces = number.ravel(), np.repeat(under, 3)
    base, corners, wanted = closest.uv[number], vertices[number], search.chart[faces]
    ahead = _extrapolated(search.mesh, faces, np.repeat(weights, 3, axis=0), corners)
    uv, points = base.copy(), closest.points[number]
    # A point on a seam is on both sides: a place a little inwards decides.
    ids = np.flatnonzero(_at_ends(seams, closest)[number])
    inside = corners[ids] + INWARDS * (centres[ids // 3] - corners[ids])
    side = search.within(corners[ids], search.nearest(inside, wanted[ids]))
    uv[ids], points[ids] = side.uv, side.points
    uv, points = own_sides(seams, Corners(number, wanted, points, uv, ahead))
    other = np.flatnonzero(~explained(seams, wanted, uv - base, points - closest.points[number]))
    base[other] = joined(seams, Corners(number[other], wanted[other], points[other], uv[other], ahead[other]))
    return base.reshape(-1, 3, 2)


def _at_ends(seams, closest):
    """(k,) boolean: points between corners that lie where a chart ends."""
    return (seams.at_end[closest.faces] | (closest.weights == 0)).all(axis=1)


def _fitted(areas, uv, of_centres, number, fixed):
    """(m, 3, 2): uv moved so that the centres of the faces, too, come as near as possible to their own of_centres.

    Over a coarse face the picture is stretched evenly, and between exact corners it would lag behind. The result has
    the least squared difference, integrated over faces of areas (m,) from corners and centres, by steps of Jacobi's
    method on the mass matrix. number (m, 3): which corners move as one; those that are fixed (m, 3) do not move.
    """
    off = of_centres - uv.mean(axis=1)
    radius = np.linalg.norm(uv - uv.mean(axis=1, keepdims=True), axis=2).max(axis=1)
    off[np.linalg.norm(off, axis=1) > radius] = 0  # no place on the face: it folds over, or surfaces intersect here
    starts = np.arange(0, number.size + 1, 3)
    gather = sparse.csr_matrix(((~fixed).ravel().astype(np.float64), number.ravel(), starts))
    spread = (gather.T @ sparse.diags(areas)).tocsr()
    lumped = np.maximum(spread.sum(axis=1).A1[:, None], np.finfo(float).tiny)
    target = 3 * (spread @ off)
    step = np.zeros_like(target)
    for _ in range(STEPS):
        step += DAMPING * (target - spread @ (gather @ step) - lumped * step) / (2 * lumped)
    return uv + np.where(fixed[..., None], 0, step[number])


def _uv_at(mesh, faces, weights):
    return np.einsum("ij,ijk->ik", weights, mesh.texture.uv[faces])


def _by_value(numbers):
    """{number: the places (k,) where it stands, in order} of numbers (n,), in one pass."""
    order = np.argsort(numbers, kind="stable")
    values, starts = np.unique(numbers[order], return_index=True)
    return dict(zip(values.tolist(), np.split(order, starts)[1:], strict=True))


def _extrapolated(mesh, faces, weights, points):
    """(k, 2) texture coordinates at barycentric weights (k, 3) of faces (k,), extrapolated affinely to points (k, 3).

    By at most FAR barycentric units, since slivers would extrapolate them anywhere.
    """
    with np.errstate(all="ignore"):
        step = np.nan_to_num(barycentric(mesh, faces, points) - weights)
    step *= np.minimum(FAR / np.maximum(np.abs(step).max(axis=1, keepdims=True), FAR), 1)
    return _uv_at(mesh, faces, weights + step)

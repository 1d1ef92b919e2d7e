"""Colours and texture coordinates of a surface handed on to a coarser one of the same shape.

Each comes from the closest point of the original surface. Texture coordinates are handed on a chart at a time: a chart
is a patch of faces whose coordinates run on across the edges between them, a seam is where they do not. A face of the
coarse mesh takes the chart under its centre, so that no face ever shows the stretch of picture between two charts.
"""

import numpy as np
from scipy import sparse
from scipy.sparse.csgraph import connected_components

from stages.kit import Mesh
from stages.kit.rays import barycentric
from stages.kit.texture import Texture

from .nearest import Surface

SAME = 1e-6  # texture coordinates closer than this run on across an edge; a picture has some 1e3 pixels a side
INWARDS = 1e-3  # of the way to the face's centre: a corner on a seam then lies on its own side of it
BEYOND = 1.0  # barycentric: how far past the closest face its coordinates are carried on
FAR = 50.0  # the same from the face under the centre to the corners, some tens of the original's faces away


def carry(reference, mesh):
    """`mesh` with the colours and the texture of `reference`, the Mesh that it was simplified from.

    Colours (n, 3) are interpolated at the closest point of the reference's surface; a vertex at the place of one of the
    reference's takes that one's colour as it is. Texture coordinates (m, 3, 2) are those of the chart under the face's
    centre, at the closest point of each corner within the chart, carried on affinely where the corner lies past its
    seam. The images are handed on as they are. Without either the mesh comes back itself.

    Source: attributes at the closest point as in Cohen, Olano and Manocha 1998 (appearance-preserving simplification,
    section 3); the thesis has no attributes. Raises ValueError where the reference has no faces.
    """
    if len(reference.faces) == 0:
        raise ValueError("the reference has no faces to take attributes from")
    if mesh is reference or len(mesh.faces) == 0 or (reference.colors is None and reference.texture is None):
        return mesh
    colors = None if reference.colors is None else carry_colors(reference, mesh.vertices)
    texture = None if reference.texture is None else carry_texture(reference, mesh)
    return Mesh(mesh.vertices, mesh.faces, colors, texture)


def carry_colors(reference, points):
    """(k, 3) u1: the reference's vertex colours at the closest points of its surface to points (k, 3)."""
    face, weights = closest(reference, points)
    colors = np.einsum("ij,ijk->ik", weights, reference.colors[reference.faces[face]].astype(np.float64))
    used = np.unique(reference.faces)
    ids = np.unique(np.concatenate([reference.vertices[used], points]), axis=0, return_inverse=True)[1].ravel()
    owner = np.full(ids.max() + 1, -1)
    owner[ids[: len(used)]] = used
    own = owner[ids[len(used) :]]
    colors[own >= 0] = reference.colors[own[own >= 0]]
    return np.rint(colors).astype(np.uint8)


def closest(mesh, points):
    """(faces (k,), corner weights (k, 3), 0 to 1): the closest places of a mesh to points (k, 3)."""
    points = np.ascontiguousarray(points, dtype=np.float64)
    made = Surface(mesh)
    face = made.nearest(points)[1].astype(np.int64)
    return face, made.weights(points, face)


def carry_texture(reference, mesh):
    """The Texture of the faces of `mesh`, taken from the reference's."""
    chart, jump = charts(reference)
    corners = mesh.vertices[mesh.faces]
    centres = corners.mean(axis=1)
    under, at_centre = closest(reference, centres)
    inside = corners + INWARDS * (centres[:, None] - corners)
    uv = np.empty(mesh.faces.shape + (2,))
    for number in np.unique(chart[under]):
        here, own = np.flatnonzero(chart[under] == number), np.flatnonzero(chart == number)
        found, weights = closest(Mesh(reference.vertices, reference.faces[own]), inside[here].reshape(-1, 3))
        at = corners[here].reshape(-1, 3)
        uv[here] = _extended(reference, own[found], weights, at, BEYOND).reshape(-1, 3, 2)
    # A corner across a seam between two ends of one chart (the back of a cylinder) has landed at the other end.
    sides = np.repeat(under, 3), np.repeat(at_centre, 3, axis=0), corners.reshape(-1, 3)
    ahead = _extended(reference, *sides, FAR).reshape(uv.shape)
    astray = np.linalg.norm(uv - ahead, axis=2) > jump[chart[under]][:, None] / 2
    uv[astray] = ahead[astray]
    return Texture(uv, reference.texture.image[under], reference.texture.images)


def charts(mesh):
    """(chart (m,) of each face, jump (charts,)): the half-way sign that a corner crossed a seam within its chart.

    jump is the median length, in texture coordinates, of the leap over the seams that have the chart on either side;
    infinite where it has none.
    """
    uv, image = mesh.texture.uv, mesh.texture.image
    one, other, leap = _shared_edges(mesh)
    runs_on = (leap <= SAME) & (image[one] == image[other])
    graph = sparse.coo_matrix((np.ones(runs_on.sum()), (one[runs_on], other[runs_on])), shape=(len(uv), len(uv)))
    count, chart = connected_components(graph, directed=False)
    jump = np.full(count, np.inf)
    seam = ~runs_on & (chart[one] == chart[other])
    for number in np.unique(chart[one[seam]]):
        jump[number] = np.median(leap[seam & (chart[one] == number)])
    return chart, jump


def _shared_edges(mesh):
    """Pairs of faces at an edge of two: (first (e,), second (e,), leap (e,)), the larger difference at its two ends."""
    tails, heads = mesh.faces.ravel(), np.roll(mesh.faces, -1, axis=1).ravel()
    at_tail, at_head = mesh.texture.uv.reshape(-1, 2), np.roll(mesh.texture.uv, -1, axis=1).reshape(-1, 2)
    turned = (tails > heads)[:, None]
    low, high = np.where(turned, at_head, at_tail), np.where(turned, at_tail, at_head)
    key = np.minimum(tails, heads) * len(mesh.vertices) + np.maximum(tails, heads)
    order = np.argsort(key, kind="stable")
    starts = np.flatnonzero(np.r_[True, np.diff(key[order]) > 0])
    pairs = starts[np.diff(np.r_[starts, len(order)]) == 2]
    one, other = order[pairs], order[pairs + 1]
    leap = np.maximum(*(np.linalg.norm(ends[one] - ends[other], axis=1) for ends in (low, high)))
    return one // 3, other // 3, leap


def _extended(mesh, faces, weights, points, beyond):
    """(k, 2) the texture coordinates at barycentric weights (k, 3) of faces (k,), carried on affinely to points (k, 3).

    At most `beyond` barycentric units further, since needles would throw them anywhere.
    """
    with np.errstate(all="ignore"):
        step = np.nan_to_num(barycentric(mesh, faces, points) - weights)
    step *= np.minimum(beyond / np.maximum(np.abs(step).max(axis=1, keepdims=True), beyond), 1)
    return np.einsum("ij,ijk->ik", weights + step, mesh.texture.uv[faces])

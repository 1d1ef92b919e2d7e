"""The material and light that both renderers share: smooth neutral grey under one head light at infinity (T3.1.1).

Pure Lambert: brightness is the cosine between the normal and the view axis, so that the limb of a smooth object fades
into the black background and draws no attention (T3.1.1). A face seen from behind is lit as if turned round, since
objects scanned or drawn as thin sheets are seen from both sides.
"""

import numpy as np
from scipy import sparse
from scipy.sparse.csgraph import connected_components

from stages.kit.mesh import unit

GREY = 204  # brightness of the material facing the light: grey, and 8 bits are used well
CREASE = 40.0  # degrees between two faces: a round of nine sides (40) is smooth, the edges of boxes and rims are not


def corner_groups(mesh):
    """Which corners of faces share a normal: (groups (m, 3) i8, normals (g, 3) f8 of length one).

    Corners at one vertex share a normal when smooth edges join their faces: an edge is smooth when exactly two faces
    of agreeing winding meet there at no more than CREASE degrees. The normal is the area-weighted mean: weights by
    the corners' angles let the small faces of a rounded rim drag streaks over the long faces beside it.
    """
    m = len(mesh.faces)
    first, second = _smooth_pairs(mesh)
    # Half-edge h runs from corner h to the next corner of its face; its twin runs the other way.
    links = np.r_[first, _next_corner(first)], np.r_[_next_corner(second), second]
    graph = sparse.coo_matrix((np.ones(len(links[0]), dtype=bool), links), shape=(3 * m, 3 * m))
    count, groups = connected_components(graph, directed=False)
    crosses = np.repeat(mesh.face_crosses, 3, axis=0)
    sums = [np.bincount(groups, weights=column, minlength=count) for column in crosses.T]
    return groups.reshape(m, 3).astype(np.int64), unit(np.stack(sums, axis=1))


def _next_corner(corners):
    return np.where(corners % 3 == 2, corners - 2, corners + 1)


def _smooth_pairs(mesh):
    """Twin half-edges over smooth edges: two arrays of corner numbers 3 * face + corner."""
    tail = mesh.faces.ravel()
    head = np.roll(mesh.faces, -1, axis=1).ravel()
    key = np.minimum(tail, head) * len(mesh.vertices) + np.maximum(tail, head)
    order = np.argsort(key, kind="stable")
    starts = np.flatnonzero(np.r_[True, np.diff(key[order]) != 0]) if len(order) else np.zeros(0, dtype=np.int64)
    pairs = starts[np.diff(np.r_[starts, len(order)]) == 2]
    first, second = order[pairs], order[pairs + 1]
    normals = mesh.face_normals
    cosine = np.einsum("ij,ij->i", normals[first // 3], normals[second // 3])
    # The cosine of a fold of exactly CREASE may round either way; it counts as smooth.
    smooth = (cosine >= np.cos(np.radians(CREASE)) - 1e-9) & (tail[first] == head[second])
    return first[smooth], second[smooth]


def shade(mesh, normals, facing, faces, weights):
    """rgb (k, 3) u1 of k surface points under the head light.

    normals (m, 3, 3), one a face corner; facing (m, 3), the direction towards the light for each face, turned for
    faces seen from behind; faces (k,) and weights (k, 3) say where the points are.
    """
    normal = np.einsum("ij,ijk->ik", weights, normals[faces])
    length = np.sqrt(np.einsum("ij,ij->i", normal, normal))
    cosine = np.einsum("ij,ij->i", normal, facing[faces]) / np.maximum(length, np.finfo(float).tiny)
    if mesh.colors is None:
        return np.rint(GREY * cosine.clip(0, 1)).astype(np.uint8)[:, None].repeat(3, axis=1)
    color = np.einsum("ij,ijk->ik", weights, mesh.colors[mesh.faces[faces]].astype(np.float64))
    return np.rint(color * cosine.clip(0, 1)[:, None]).astype(np.uint8)

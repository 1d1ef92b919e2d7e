"""The material and light of both renderers: by default smooth neutral grey under one head light at infinity (T3.1.1).

Lambertian shading: brightness is the cosine between the normal and the view axis, so that the silhouette of a smooth
object fades into the black background and draws no attention (T3.1.1). A face seen from behind is lit as if its normal
were reversed, since objects that are scanned or modelled as thin sheets are seen from both sides.
"""

import numpy as np

from haptic_glance.base.jit import cached_njit, helper
from haptic_glance.mesh.mesh import Mesh, edge_pairs, next_half_edge, unit

kernel = cached_njit()


def graph_components(tails: np.ndarray, heads: np.ndarray, count: int) -> tuple[np.ndarray, int]:
    """(labels (count,) i4, number of components) of a graph with edges tails (e,) to heads (e,)."""
    label = np.empty(count, dtype=np.int32)
    return label, _join(tails, heads, np.arange(count), label)


@kernel
def _join(tails, heads, parent, label):
    """Fills the labels and returns the number of components. parent: 0, 1, 2, ..."""
    for edge in range(len(tails)):
        a, b = _root(parent, tails[edge]), _root(parent, heads[edge])
        if a < b:
            parent[b] = a
        else:
            parent[a] = b
    count = 0
    for v in range(len(label)):
        root = _root(parent, v)
        if root == v:
            label[v] = count
            count += 1
        else:
            label[v] = label[root]
    return count


@helper
def _root(parent, v):
    while parent[v] != v:
        parent[v] = parent[parent[v]]
        v = parent[v]
    return v


GREY = 204  # of 255, the brightness of the material facing the light; uses most of the 8 bits
CREASE = 40.0  # degrees between two faces: a prism of nine sides (40) is smooth, the edges of a box are not


def corner_groups(mesh: Mesh) -> tuple[np.ndarray, np.ndarray]:
    """Groups of face corners that share a normal: (groups (m, 3) i8, unit normals (g, 3) f8).

    Corners at one vertex share a normal when smooth edges connect their faces. An edge is smooth when exactly two faces
    of consistent winding meet there at no more than CREASE degrees. The normal is the area-weighted mean: with weights
    by corner angle, the small faces of a rounded edge cause streaks on the long faces next to it.
    """
    m = len(mesh.faces)
    first, second = _smooth_pairs(mesh)
    # Half-edge h runs from corner h to the next corner of its face; the opposite half-edge runs back.
    links = np.r_[first, next_half_edge(first)], np.r_[next_half_edge(second), second]
    groups, count = graph_components(*links, 3 * m)
    crosses = np.repeat(mesh.face_crosses, 3, axis=0)
    sums = [np.bincount(groups, weights=column, minlength=count) for column in crosses.T]
    return groups.reshape(m, 3).astype(np.int64), unit(np.stack(sums, axis=1))


def _smooth_pairs(mesh):
    """Opposite half-edges of smooth edges: two arrays of corner numbers 3 * face + corner."""
    tail, head = mesh.faces.ravel(), np.roll(mesh.faces, -1, axis=1).ravel()
    first, second = edge_pairs(mesh.faces, len(mesh.vertices))
    normals = mesh.face_normals
    cosine = np.einsum("ij,ij->i", normals[first // 3], normals[second // 3])
    # The cosine of an angle of exactly CREASE may round either way; it counts as smooth.
    smooth = (cosine >= np.cos(np.radians(CREASE)) - 1e-9) & (tail[first] == head[second])
    return first[smooth], second[smooth]


def shade(mesh: Mesh, normals: np.ndarray, facing: np.ndarray, faces: np.ndarray, weights: np.ndarray) -> np.ndarray:
    """rgb (k, 3) u1 of k surface points under the head light.

    normals (m, 3, 3), one per face corner; facing (m, 3), the direction towards the light for each face, reversed for
    faces seen from behind; faces (k,) and weights (k, 3): the faces and barycentric coordinates of the points.
    """
    normal = np.einsum("ij,ijk->ik", weights, normals[faces])
    length = np.sqrt(np.einsum("ij,ij->i", normal, normal))
    cosine = np.einsum("ij,ij->i", normal, facing[faces]) / np.maximum(length, np.finfo(float).tiny)
    if mesh.colors is None:
        return np.rint(GREY * cosine.clip(0, 1)).astype(np.uint8)[:, None].repeat(3, axis=1)
    color = np.einsum("ij,ijk->ik", weights, mesh.colors[mesh.faces[faces]].astype(np.float64))
    return np.rint(color * cosine.clip(0, 1)[:, None]).astype(np.uint8)

"""Makes the winding of faces consistent, and turns closed surfaces outwards."""

from dataclasses import replace

import numpy as np
from scipy import sparse
from scipy.sparse.csgraph import connected_components

from stages.kit import Mesh


def orient(mesh: Mesh) -> tuple[Mesh, list[str]]:
    """The mesh with neighbours wound alike and closed parts facing outwards, and notes: (Mesh, list of str).

    Only the vertex order within faces changes. The virtual sensor distinguishes inside from outside by face normals,
    so an inverted mesh would seem empty to it. A part is a set of faces connected by edges that exactly two faces
    share. In each part the minority of faces is flipped; a part that cannot be oriented (a Moebius strip) stays. A
    closed part of negative volume is flipped with all parts inside its bounding box. One that lies inside the box of
    another closed part stays, since it may be the wall of a cavity.
    """
    first, second, alike, closed_edges = _neighbours(mesh)
    flips = _minority_faces(len(mesh.faces), first, second, alike)
    turned = flips.sum()
    mesh = _flipped(mesh, flips)
    inverted = _inverted(mesh, first, second, closed_edges)
    notes = [f"{turned} faces turned to agree with their neighbours"] if turned else []
    notes += [f"{inverted.sum()} faces turned outwards"] if inverted.any() else []
    return _flipped(mesh, inverted), notes


def _neighbours(mesh):
    """Pairs of faces that share an edge of exactly two faces: (first (e,), second (e,), wound alike (e,), closed).

    closed (m,) boolean: all three edges of the face are of that kind.
    """
    tails, heads = mesh.faces.ravel(), np.roll(mesh.faces, -1, axis=1).ravel()
    forward = tails < heads
    edge = np.minimum(tails, heads) * len(mesh.vertices) + np.maximum(tails, heads)
    order = np.argsort(edge, kind="stable")
    starts = np.flatnonzero(np.r_[True, np.diff(edge[order]) > 0])
    pairs = starts[np.diff(np.r_[starts, len(order)]) == 2]
    one, other = order[pairs], order[pairs + 1]
    closed = np.zeros(len(tails), dtype=bool)
    closed[one] = closed[other] = True
    return one // 3, other // 3, forward[one] != forward[other], closed.reshape(-1, 3).all(axis=1)


def _minority_faces(count, first, second, alike):
    """(m,) boolean: the faces to flip, from the double cover of the face graph.

    Each face has two nodes there, unflipped and flipped. Neighbours wound alike connect equal nodes, others unequal.
    """
    if alike.all():
        return np.zeros(count, dtype=bool)
    crossed = np.where(alike, 0, count)
    rows = np.r_[first, first + count]
    columns = np.r_[second + crossed, (second + count + crossed) % (2 * count)]
    graph = sparse.coo_matrix((np.ones(len(rows)), (rows, columns)), shape=(2 * count, 2 * count))
    label = connected_components(graph, directed=False)[1]
    kept = np.bincount(label[:count], minlength=label.max() + 1)  # unflipped faces in each component
    as_is, turned = label[:count], label[count:]
    return (kept[as_is] < kept[turned]) | ((kept[as_is] == kept[turned]) & (as_is > turned))


def _inverted(mesh, first, second, closed_edges):
    """(m,) boolean: the faces of closed parts that face inwards."""
    count = len(mesh.faces)
    graph = sparse.coo_matrix((np.ones(len(first)), (first, second)), shape=(count, count))
    parts, part = connected_components(graph, directed=False)
    closed = np.bincount(part, weights=closed_edges, minlength=parts) == np.bincount(part, minlength=parts)
    corners = mesh.vertices[mesh.faces] - mesh.vertices.mean(axis=0)
    volume = np.bincount(part, weights=np.einsum("ij,ij->i", corners[:, 0], np.cross(corners[:, 1], corners[:, 2])))
    inside_out = np.flatnonzero(closed & (volume < 0))
    if not len(inside_out):  # nearly always: boxes take a third of the time
        return np.zeros(count, dtype=bool)
    low, high = np.full((parts, 3), np.inf), np.full((parts, 3), -np.inf)
    np.minimum.at(low, part, corners.min(axis=1))
    np.maximum.at(high, part, corners.max(axis=1))
    turn = np.zeros(parts, dtype=bool)
    for shell in inside_out:
        within = closed & (low > low[shell]).all(axis=1) & (high < high[shell]).all(axis=1)
        around = closed & (low < low[shell]).all(axis=1) & (high > high[shell]).all(axis=1)
        if not around.any():
            turn |= within
            turn[shell] = True
    return turn[part]


def _flipped(mesh, flips):
    if not flips.any():
        return mesh
    faces = mesh.faces.copy()
    faces[flips] = faces[flips][:, ::-1]
    return replace(mesh, faces=faces, texture=mesh.texture and mesh.texture.turned(flips))

"""Borders between materials, preserved while a mesh is simplified: cut open before, closed again after.

A geometric error does not depend on where one material ends and the next begins. On a flat side, which needs few faces,
the border would end up on any edge. Cut open it is a boundary, which simplification preserves.
"""

import numpy as np

from stages.kit import Mesh


def cut_borders(mesh: Mesh) -> tuple[Mesh, np.ndarray]:
    """(Mesh, ids (n',)): vertices on a border become one per material; ids: the old id of each vertex."""
    if mesh.texture is None:
        return mesh, np.arange(len(mesh.vertices))
    n = len(mesh.vertices)
    pairs = np.repeat(mesh.texture.image, 3) * n + mesh.faces.ravel()
    found, first, inverse = np.unique(pairs, return_index=True, return_inverse=True)
    source, owner = found % n, found // n
    home = np.full(n, -1)
    home[source[::-1]] = owner[::-1]  # a vertex keeps its id in the first of its materials
    extra = owner != home[source]
    number = np.where(extra, n + np.cumsum(extra) - 1, source)
    ids = np.r_[np.arange(n), source[extra]]
    colors = None if mesh.colors is None else mesh.colors[ids]
    return Mesh(mesh.vertices[ids], number[inverse].reshape(-1, 3), colors, mesh.texture, mesh.up), ids


def close_borders(mesh: Mesh, cut: Mesh, ids: np.ndarray) -> Mesh:
    """The simplified `mesh` with the vertices that `cut_borders` doubled merged again; unused ones are removed."""
    doubled = np.bincount(ids)[ids] > 1
    rows, place = np.unique(np.concatenate([cut.vertices[doubled], mesh.vertices]), axis=0, return_inverse=True)
    place = place.ravel()
    at_border = np.zeros(len(rows), dtype=bool)
    at_border[place[: doubled.sum()]] = True
    own = place[doubled.sum() :]
    name = np.where(at_border[own], own, len(rows) + np.arange(len(own)))
    _, first, inverse = np.unique(name[mesh.faces], return_index=True, return_inverse=True)
    order = np.argsort(first)
    rank = np.empty_like(order)
    rank[order] = np.arange(len(order))
    kept = mesh.faces.ravel()[first[order]]
    colors = None if mesh.colors is None else mesh.colors[kept]
    return Mesh(mesh.vertices[kept], rank[inverse.ravel()].reshape(-1, 3), colors, mesh.texture, mesh.up)

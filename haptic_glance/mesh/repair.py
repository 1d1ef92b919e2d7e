"""Repairs, orients and normalises a mesh.

Repairs move no vertex; what cannot be repaired is refused. Orientation makes the winding consistent and turns closed
surfaces outwards. The frame of all other modules: +z up, centred, a bounding sphere of radius 0.5.
"""

from dataclasses import replace

import numpy as np
from scipy import sparse
from scipy.sparse.csgraph import connected_components

from .axes import Axis, axis_named, to_z_up
from .headers import MeshError
from .mesh import Mesh, bounding_box, edge_pairs
from .upright import settled

MIN_AREA = 1e-12  # share of the squared diagonal; below it, rays in single precision find no surface
BACK_TO_BACK = 0.5  # share of the faces from which on a surface is taken for one that was doubled
MIN_VISIBLE_AREA = 1e-4  # share of the squared extent: about five pixels of the stored maps, which have 225 rows


def clean(mesh: Mesh) -> tuple[Mesh, list[str]]:
    """Removes useless faces and turns the others outwards; vertices keep their ids.

    Parameters
    ----------
    mesh : Mesh or any input of `as_mesh`
        The mesh.

    Returns
    -------
    mesh : Mesh
        The repaired mesh.
    notes : list of str
        The repairs in words.

    Raises
    ------
    MeshError
        When no face or no area is left.

    Notes
    -----
    Faces that repeat a vertex and duplicate faces are removed. Where most faces lie back to back, as SketchUp and games
    write surfaces to be seen from both sides, one of each two is removed: together they would have no normal. Faces
    without area that have three distinct vertices stay: they connect their neighbours, and removing them would open a
    closed mesh.

    Examples
    --------
    >>> from haptic_glance import Mesh, clean
    >>> mesh, notes = clean(Mesh([[0, 0, 0], [1, 0, 0], [0, 1, 0]], [[0, 1, 2], [0, 1, 2]]))
    >>> len(mesh.faces)
    1
    """
    ids, notes = np.arange(len(mesh.faces)), []
    a, b, c = mesh.faces.T
    ids, notes = _keep(ids, (a != b) & (b != c) & (c != a), notes, "degenerate")
    if _repeats(np.sort(mesh.faces[ids], axis=1)):
        ids, notes = _without_repeats(mesh.faces, ids, notes)
    if len(ids) == 0:
        raise MeshError("no face has three different vertices")
    faces = mesh.faces[ids]
    cleaned = replace(mesh, faces=faces, texture=mesh.texture and mesh.texture.of(ids))
    if area_share(cleaned) <= MIN_VISIBLE_AREA:
        raise MeshError("the surface is too small for its extent: are there stray parts far from the object?")
    cleaned, orient_notes = orient(cleaned)
    return cleaned, notes + orient_notes


def area_share(mesh: Mesh) -> float:
    """The area over the squared diagonal of the box; MeshError for a mesh without area, or whose area overflows."""
    spread = np.ptp(mesh.vertices[mesh.used], axis=0)
    with np.errstate(over="ignore", invalid="ignore"):
        area, square = mesh.face_areas.sum(), float(spread @ spread)
    if not np.isfinite([area, square]).all():
        raise MeshError("the coordinates are so large that areas overflow: scale them, for example to metres")
    if area <= MIN_AREA * max(square, np.finfo(float).tiny):
        raise MeshError(f"the surface has no area, its extent is {spread.max():.3g}: scale it, or export its faces")
    return area / square


def _repeats(rows):
    """Whether a row occurs twice: sorts in half of the time of np.unique."""
    ordered = rows[np.lexsort(rows.T)]
    return (ordered[1:] == ordered[:-1]).all(axis=1).any()


def _without_repeats(faces, ids, notes):
    """(ids, notes) without duplicate faces, and without one of each two back to back where most faces are doubled."""
    # Compared up to a cyclic permutation: two faces back to back are a thin sheet, and both stay.
    rotated = np.take_along_axis(faces[ids], (faces[ids].argmin(axis=1)[:, None] + np.arange(3)) % 3, axis=1)
    ids, notes = _keep(ids, _is_first(rotated)[0], notes, "duplicate")
    front, count = _is_first(np.sort(faces[ids], axis=1))
    if count[count > 1].sum() > BACK_TO_BACK * len(ids):
        ids, notes = _keep(ids, front, notes, "back-to-back")
    return ids, notes


def _is_first(rows):
    """((n,) boolean: whether a row is the first of its kind, the number of rows of each kind)."""
    _, first, count = np.unique(rows, axis=0, return_index=True, return_counts=True)
    is_first = np.zeros(len(rows), dtype=bool)
    is_first[first] = True
    return is_first, count


def _keep(ids, good, notes, kind):
    removed = int((~good).sum())
    return ids[good], notes + ([f"{removed} {kind} faces removed"] if removed else [])


EVEN = 1 / 3  # share of flipped faces above which the majority says nothing of the side


def orient(mesh: Mesh) -> tuple[Mesh, list[str]]:
    """The mesh with neighbours wound alike and closed parts facing outwards, and notes: (Mesh, list of str).

    Only the vertex order within faces changes. The virtual sensor distinguishes inside from outside by face normals,
    so an inverted mesh would seem empty to it. A part is a set of faces connected by edges that exactly two faces
    share. In each part the minority of faces is flipped; a part that cannot be oriented (a Moebius strip) stays. Where
    the minority is no clear one and the part is open, its faces look away from its middle, as most of a scan's do. A
    closed part of negative volume is flipped with all parts inside its bounding box. One that lies inside the box of
    another closed part stays, since it may be the wall of a cavity.
    """
    first, second, is_alike, closed_edges = _neighbours(mesh)
    flips = _minority_faces(len(mesh.faces), first, second, is_alike)
    flip_count = flips.sum()
    mesh = _flipped(mesh, flips)
    inverted = _inverted(mesh, first, second, closed_edges, flips)
    notes = [f"{flip_count} faces turned to agree with their neighbours"] if flip_count else []
    notes += [f"{inverted.sum()} faces turned outwards"] if inverted.any() else []
    return _flipped(mesh, inverted), notes


def _neighbours(mesh):
    """Pairs of faces that share an edge of exactly two faces: (first (e,), second (e,), wound alike (e,), closed).

    closed (m,) boolean: all three edges of the face are of that kind.
    """
    tails, heads = mesh.faces.ravel(), np.roll(mesh.faces, -1, axis=1).ravel()
    forward = tails < heads
    first, second = edge_pairs(mesh.faces, len(mesh.vertices))
    closed = np.zeros(len(tails), dtype=bool)
    closed[first] = closed[second] = True
    return first // 3, second // 3, forward[first] != forward[second], closed.reshape(-1, 3).all(axis=1)


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
    unflipped = np.bincount(label[:count], minlength=label.max() + 1)  # unflipped faces in each component
    as_is, turned = label[:count], label[count:]
    return (unflipped[as_is] < unflipped[turned]) | ((unflipped[as_is] == unflipped[turned]) & (as_is > turned))


def _inverted(mesh, first, second, closed_edges, flips):
    """(m,) boolean: the faces of parts that face inwards, if these are closed or nearly as many were flipped as not."""
    count = len(mesh.faces)
    graph = sparse.coo_matrix((np.ones(len(first)), (first, second)), shape=(count, count))
    parts, part = connected_components(graph, directed=False)
    sizes = np.bincount(part, minlength=parts)
    closed = np.bincount(part, weights=closed_edges, minlength=parts) == sizes
    turn = _undecided(mesh, part, ~closed & (np.bincount(part, weights=flips, minlength=parts) > EVEN * sizes))
    volume = np.bincount(part, weights=np.einsum("ij,ij->i", mesh.vertices[mesh.faces[:, 0]], mesh.face_crosses))
    inside_out = np.flatnonzero(closed & (volume < 0))
    if not len(inside_out):  # nearly always: boxes take a third of the time
        return turn[part]
    corners, low, high = mesh.vertices[mesh.faces], np.full((parts, 3), np.inf), np.full((parts, 3), -np.inf)
    np.minimum.at(low, part, corners.min(axis=1))
    np.maximum.at(high, part, corners.max(axis=1))
    for shell in inside_out:
        within = closed & (low > low[shell]).all(axis=1) & (high < high[shell]).all(axis=1)
        around = closed & (low < low[shell]).all(axis=1) & (high > high[shell]).all(axis=1)
        if not around.any():
            turn |= within
            turn[shell] = True
    return turn[part]


def _undecided(mesh, part, candidates):
    """(parts,) boolean: the candidates whose faces look towards the part's middle."""
    if not candidates.any():
        return np.zeros(len(candidates), dtype=bool)
    middles, areas = mesh.vertices[mesh.faces].mean(axis=1), mesh.face_areas
    total = np.maximum(np.bincount(part, weights=areas, minlength=len(candidates)), 1e-300)
    centres = [np.bincount(part, weights=areas * column, minlength=len(candidates)) / total for column in middles.T]
    outwards = np.einsum("ij,ij->i", middles - np.stack(centres, axis=1)[part], mesh.face_crosses)
    return candidates & (np.bincount(part, weights=outwards, minlength=len(candidates)) < 0)


def _flipped(mesh, flips):
    if not flips.any():
        return mesh
    faces = mesh.faces.copy()
    faces[flips] = faces[flips][:, ::-1]
    return replace(mesh, faces=faces, texture=mesh.texture and mesh.texture.turned(flips))


RADIUS = 0.5  # the sphere then spans 859 of the 900 image rows of the thesis's camera


def normalise(mesh: Mesh) -> Mesh:
    """Moves the centre of the bounding box to 0 and scales the bounding sphere about it to radius 0.5 (T3.2.9).

    Parameters
    ----------
    mesh : Mesh or any input of `as_mesh`
        The mesh.

    Returns
    -------
    Mesh
        The scaled mesh. Only vertices of faces count, so that a stray vertex cannot shrink the object.

    Raises
    ------
    ValueError
        When the mesh has no faces or no extent.

    Examples
    --------
    >>> import trimesh
    >>> from haptic_glance import normalise
    >>> cube = normalise(trimesh.creation.box())
    >>> float(abs(cube.vertices).max().round(3))
    0.289
    """
    centre, radius = centre_and_radius(mesh)
    return replace(mesh, vertices=(mesh.vertices - centre) * (RADIUS / radius))


def centre_and_radius(mesh: Mesh) -> tuple[np.ndarray, float]:
    """(centre (3,) of the bounding box, radius of the bounding sphere about it), in the units of the mesh."""
    if len(mesh.faces) == 0:
        raise ValueError("the mesh has no faces, so that it cannot be normalised")
    low, high = bounding_box(mesh)
    centre = (low + high) / 2
    radius = np.linalg.norm(mesh.vertices[mesh.used] - centre, axis=1).max()
    if radius == 0:
        extent = (high - low).max()
        reason = f"its extent is {extent:.3g}: scale it" if extent else "all vertices coincide"
        raise ValueError(f"the mesh has no extent that could be measured: {reason}")
    return centre, radius


def significant_digits(mesh: Mesh, least: int) -> int:
    """Significant digits of coordinates that resolve the same part of an object wherever the object lies.

    least: the digits for an object at the origin.
    """
    centre, radius = centre_and_radius(mesh)
    return min(least + int(np.ceil(np.log10(max(np.abs(centre).max() / radius, 1)))), 17)


def rotate_to_z_up(mesh: Mesh, up: Axis | None = None) -> Mesh:
    """Rotates a mesh so that its up axis becomes +z.

    Parameters
    ----------
    mesh : Mesh or any input of `as_mesh`
        The mesh.
    up : str or (3,) array_like, optional
        The axis that points up: `x`, `-y`, a vector, or `auto` for the axis that the shape suggests. None: the mesh's
        own.

    Returns
    -------
    Mesh
        The rotated mesh, z up.

    Raises
    ------
    ValueError
        For an axis that is none.

    Examples
    --------
    >>> from haptic_glance import Mesh, rotate_to_z_up
    >>> rotate_to_z_up(Mesh([[0, 0, 0], [1, 0, 0], [0, 2, 0]], [[0, 1, 2]], up="y")).vertices[2].tolist()
    [0.0, 0.0, 2.0]
    """
    mesh = settled(mesh if up is None else replace(mesh, up=axis_named(up)))
    return replace(mesh, vertices=mesh.vertices @ to_z_up(mesh.up).T, up="z")

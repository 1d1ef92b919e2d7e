"""Fewer faces, with the neighbourhoods of chosen vertices left as they are (T3.1.3, T3.2.8)."""

import numpy as np
from scipy.spatial import cKDTree

from stages.kit import Mesh

from .feasibility import InfeasibleTarget, frozen_faces, smallest_with
from .qem import collapse
from .topology import faults, split_pinches

BACKENDS = {"pymeshlab": collapse}

# (weight of the pull to round faces, weight of good shape in the order of collapses), tried in this order until the
# result has no fault that the mesh had not. Over 223 cells of household objects the weight 1e-5 adds the fewest folds,
# no degenerate face, and keeps the mean error of plain QEM; with no pull 11 cells get degenerate faces, at pymeshlab's
# 1e-3 the error is a third larger. The others are for thin parts, where it is luck which of them folds nothing.
ATTEMPTS = ((1e-5, 0.3), (1e-5, 0.5), (1e-6, 0.5), (1e-4, 0.5), (1e-3, 0.5), (1e-2, 0.1))


class SimplifyError(ValueError):
    """Every attempt left faces folded, degenerate or non-manifold that were not so before."""


def simplify(mesh, faces, keep=None, rings=3, backend="pymeshlab"):
    """A Mesh of at most `faces` faces (one fewer where the count must stay even), or the mesh itself if it has no more.

    keep: vertex ids whose neighbourhood of `rings` edges must survive: all faces wholly within it are frozen and
    come through bit for bit, as does the open boundary (T3.1.3 and T3.2.8; the ids change, the positions do not).
    None or empty: plain QEM. Pieces and handles are held; pieces that touch in a vertex or in a non-manifold edge are
    worked on apart. Colours come from the nearest vertex of `mesh`.

    Source: Garland and Heckbert 1997 (T [222]). The thesis also takes edges beside the frozen region out of the list,
    which is the same: a vertex of a frozen face never moves.

    Raises InfeasibleTarget (with `smallest`) when the frozen faces leave too few for the rest, SimplifyError when the
    result would be faulty, ValueError for bad arguments.
    """
    check_backend(backend)
    if faces < 1 or len(mesh.faces) == 0:
        raise ValueError(f"cannot simplify {len(mesh.faces)} faces to {faces}: both must be 1 or more")
    frozen = frozen_faces(mesh, keep, rings)
    if faces >= len(mesh.faces):
        return mesh
    smallest = smallest_with(mesh, frozen)
    if faces < smallest:
        raise InfeasibleTarget(faces, smallest, int(frozen.sum()))
    return _first_sound(mesh, int(faces), frozen, BACKENDS[backend])


def check_backend(backend):
    """Raises ValueError unless there is a backend of this name."""
    if backend not in BACKENDS:
        raise ValueError(f"unknown backend {backend!r}: choose one of {', '.join(BACKENDS)}")


def _first_sound(mesh, faces, frozen, work):
    before = faults(mesh)
    apart = _without_pinches(mesh)
    for weights in ATTEMPTS:
        found = work(apart, faces, frozen, *weights)
        if len(found.faces) > faces:
            raise InfeasibleTarget(faces, len(found.faces), int(frozen.sum()))
        added = faults(found).added(before)
        if not added:
            return _coloured(found, mesh)
    raise SimplifyError(f"{faces} faces leave {added}: ask for more faces")


def _without_pinches(mesh):
    """The mesh with pinched vertices doubled.

    pymeshlab holds every pinch as if it were a handle: the teapot, with 435 of them, collapses below 30 % of its faces.
    """
    faces = split_pinches(mesh.faces)
    source = np.zeros(int(faces.max()) + 1, dtype=np.int64)
    source[faces] = mesh.faces
    return Mesh(mesh.vertices[source], faces)


def _coloured(found, mesh):
    if mesh.colors is None:
        return found
    used = np.unique(mesh.faces)
    nearest = cKDTree(mesh.vertices[used]).query(found.vertices)[1]
    return Mesh(found.vertices, found.faces, mesh.colors[used[nearest]])

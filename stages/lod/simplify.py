"""Fewer faces, with the neighbourhoods of chosen vertices left as they are (T3.1.3, T3.2.8)."""

from functools import partial

import numpy as np

from .attributes import carry
from .fast import collapse as collapse_fast
from .feasibility import InfeasibleTarget, SimplifyError, check_keep, check_rings, frozen_faces, smallest_with
from .qem import collapse as collapse_by_pymeshlab
from .shrink import ever_smaller

# A backend is collapse(mesh, faces, frozen, weights=None) -> Mesh of at most `faces` faces without colours; see qem.py.
BACKENDS = {"fast": collapse_fast, "pymeshlab": collapse_by_pymeshlab}
BACKEND = "fast"
LARGEST = 1e60  # diagonal, and one over it the smallest: fourth powers of lengths are compared

# Over 25 household objects, at 25 and at 10 % of their faces, beside plain QEM: the error over the most salient tenth
# of the surface falls by 35 and 26 %, the Metro mean rises by 0 and 6 %, the maximum by 0 and 4 %. At 10 the gain is
# 23 and 19 %; at 99, the most that pymeshlab takes, 42 and 33 %, but the mean rises by 4 and 10 %, the maximum by 13 %.
STRENGTH = 30.0
MORE = 1.1  # times the count that could not be had: the next that is tried for `InfeasibleTarget.smallest`


def simplify(mesh, faces, keep=None, rings=3, backend=BACKEND, shrink=False, weights=None):
    """A Mesh of at most `faces` faces (one fewer where the count must stay even), or the mesh itself if it has no more.

    keep: vertex ids, most salient first, whose neighbourhood of `rings` edges must survive: all faces wholly within it
    are frozen and come through bit for bit, as does the open boundary (T3.1.3 and T3.2.8; the ids change, the positions
    do not). None or empty: plain QEM. rings: one number, or (k,) one a kept vertex, as `neighbourhoods` gives them (0:
    the faces that touch it; -1: not kept). shrink: where the target is too low for them, keep smaller neighbourhoods,
    the least salient first (`shrunk_rings`). weights: (n,) f8 in 0..1, say a saliency: the error counts more where it
    is high (`quadric_weights`), the soft way of keeping. Pieces and handles are held; pieces that touch in a vertex or
    in a non-manifold edge are worked on apart. Colours and texture come from the closest point of `mesh` (`carry`).

    Source: Garland and Heckbert 1997 (T [222]). The thesis also takes edges beside the frozen region out of the list,
    which is the same: a vertex of a frozen face never moves.

    Raises InfeasibleTarget when the frozen faces leave too few for the rest, with `smallest`, a count that was had
    (with nothing kept, where they may shrink); SimplifyError when the result would be faulty; ValueError for bad
    arguments and for a mesh too large or too small to be reckoned with.
    """
    check_backend(backend)
    if faces < 1 or len(mesh.faces) == 0:
        raise ValueError(f"cannot simplify {len(mesh.faces)} faces to {faces}: both must be 1 or more")
    if not 1 / LARGEST < (mesh.diagonal or 1.0) < LARGEST:
        raise ValueError(f"a mesh of diagonal {mesh.diagonal:.3g} is out of range: scale it, see stages.meshes")
    rings = check_rings(check_keep(mesh, keep), rings)
    multipliers = None if weights is None else quadric_weights(_check_weights(mesh, weights))
    if faces >= len(mesh.faces):
        return mesh
    for tried in ever_smaller(mesh, faces, keep, rings) if shrink else [rings]:
        frozen = frozen_faces(mesh, keep, tried)
        work = partial(BACKENDS[backend], mesh, frozen=frozen, weights=multipliers)
        try:
            return carry(mesh, _feasible(work, mesh, int(faces), frozen))
        except (InfeasibleTarget, SimplifyError) as error:
            refusal = error
    if isinstance(refusal, InfeasibleTarget):
        raise InfeasibleTarget(faces, _least_had(work, refusal.smallest, len(mesh.faces)), refusal.frozen)
    raise refusal


def _feasible(work, mesh, faces, frozen):
    """What the backend makes; InfeasibleTarget before it starts where the frozen faces leave too few."""
    smallest = smallest_with(mesh, frozen)
    if faces < smallest:
        raise InfeasibleTarget(faces, smallest, int(frozen.sum()))
    return work(faces)


def _least_had(work, smallest, count):
    """The least face count from `smallest` on that the backend was seen to make, up to the mesh's own `count`."""
    while smallest < count:
        try:
            return len(work(smallest).faces)
        except InfeasibleTarget as error:
            smallest = max(error.smallest, smallest + 1)
        except SimplifyError:
            smallest = int(MORE * smallest) + 2
    return count


def quadric_weights(saliency):
    """(n,) what the quadric of each vertex is multiplied by, from its saliency (n,) in 0..1: 1 + STRENGTH * saliency.

    None where it is the same everywhere, which is plain QEM. All backends multiply the quadric of the planes around a
    vertex by it before the first collapse; sums of quadrics carry it on. A quadric is a squared distance: at a saliency
    of 1 the same error counts sqrt(1 + STRENGTH) = 5.6 times as much.
    """
    return None if np.ptp(saliency) == 0 else 1 + STRENGTH * saliency


def check_backend(backend):
    """Raises ValueError unless there is a backend of this name."""
    if backend not in BACKENDS:
        raise ValueError(f"unknown backend {backend!r}: choose one of {', '.join(BACKENDS)}")


def _check_weights(mesh, weights):
    weights = np.asarray(weights, dtype=np.float64)
    if weights.shape != (len(mesh.vertices),):
        raise ValueError(f"weights must be one a vertex, ({len(mesh.vertices)},), got {weights.shape}")
    if not (weights >= 0).all() or not (weights <= 1).all():
        raise ValueError("weights must lie in 0..1 and hold no NaN")
    return weights

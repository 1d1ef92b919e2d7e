"""Simplification that preserves the neighbourhoods of chosen vertices (T3.1.3, T3.2.8)."""

from collections.abc import Callable, Mapping
from dataclasses import replace
from functools import lru_cache, partial

import numpy as np

from haptic_glance.mesh.mesh import Mesh

from .attribute_quadrics import check_attributes
from .attributes import carry
from .blocks import collapse as collapse_fast
from .fast import collapse as collapse_whole
from .feasibility import (  # fmt: skip
    InfeasibleTarget,
    Keep,
    Rings,
    SimplifyError,
    check_keep,
    check_rings,
    frozen_faces,
    smallest_feasible,
)
from .neighbourhood import shrinking_rings
from .qem import collapse as collapse_by_pymeshlab
from .topology import half_edges

# A backend is collapse(mesh, faces, frozen, weights=None) -> Mesh of at most `faces` faces without colours; see qem.py.
BACKENDS: dict[str, Callable[..., Mesh]] = {
    "fast": collapse_fast, "qslim": partial(collapse_whole, fit_below=0.0), "pymeshlab": collapse_by_pymeshlab,
}  # fmt: skip
BACKEND = "fast"
MAX_DIAGONAL = 1e60  # and one over it the smallest: fourth powers of lengths are compared

# Over 25 household objects, at 25 and at 10 % of their faces, relative to plain QEM: the error over the most salient
# tenth of the surface falls by 35 and 26 %, the Metro mean rises by 0 and 6 %, the maximum by 0 and 4 %. At 10 the gain
# is 23 and 19 %; at 99, the most that pymeshlab takes, 42 and 33 %, but the mean rises by 4 and 10 %, the maximum by 13
# %.
STRENGTH = 30.0
GROWTH = 1.1  # from one count without a sound mesh to the next one tried, for `InfeasibleTarget.smallest`


def simplify(
    mesh: Mesh, faces: int, keep: Keep = None, rings: Rings = 3, backend: str = BACKEND, shrink: bool = False,
    weights: np.ndarray | None = None, attributes: Mapping[str, float] | None = None,
    free_borders: bool | np.ndarray = False, below: bool = False,
) -> Mesh:  # fmt: skip
    """A Mesh of at most `faces` faces (one fewer where the count must stay even), or the mesh itself if it has no more.

    keep: vertex ids, most salient first, whose neighbourhood of `rings` edges is preserved: all faces wholly within it
    are frozen and stay unchanged bit for bit, as does the boundary (T3.1.3 and T3.2.8; the ids change, the positions do
    not). None or empty: plain QEM. rings: one number, or (k,) per kept vertex, as from `neighbourhoods` (0: the faces
    that touch it; -1: not kept). shrink: where the target is too low for them, keep smaller neighbourhoods, the least
    salient first (`shrunk_rings`). weights: (n,) f8 in 0..1, for example a saliency: the error has a higher weight
    where it is high (`quadric_weights`). attributes: weights of `colors`, `normals` and `uv` (texture coordinates) in
    the error, for example {"colors": 1.0, "normals": 0.03}. At a weight of 1 a difference of black and white, of the
    picture's width or of a unit normal counts as a displacement by the longest side of the mesh (`attribute_quadrics`).
    By default the shape alone decides. free_borders: the edges of the boundary collapse, too, and its vertices move; or
    (n,) boolean: those that may. The boundary keeps its loops. below: also try counts below `smallest_feasible`, near
    which the surface loses its shape. Connected components and genus are preserved; components that touch in a vertex
    or a non-manifold edge are simplified separately. Texture comes from the closest point of `mesh` (`carry`), and so
    do colours, but for those in the error, which are the ones of least error.

    Source: Garland and Heckbert 1997 (T [222]). The thesis also takes edges beside the frozen region out of the list,
    which is the same: a vertex of a frozen face never moves.

    Raises InfeasibleTarget when the frozen faces leave too few for the rest, with `smallest`, a count that is feasible
    (with nothing kept, where neighbourhoods may shrink); SimplifyError when the result would be faulty; ValueError for
    invalid arguments and for a mesh whose size is out of range.
    """
    if backend not in BACKENDS:
        raise ValueError(f"unknown backend {backend!r}: choose one of {', '.join(BACKENDS)}")
    if faces < 1 or len(mesh.faces) == 0:
        raise ValueError(f"cannot simplify {len(mesh.faces)} faces to {faces}: both must be 1 or more")
    if not 1 / MAX_DIAGONAL < (mesh.diagonal or 1.0) < MAX_DIAGONAL:
        raise ValueError(
            f"a mesh of diagonal {mesh.diagonal:.3g} is out of range: scale it, see haptic_glance.mesh.normalise"
        )
    rings = check_rings(check_keep(mesh, keep), rings)
    multipliers = None if weights is None else quadric_weights(check_weights(mesh, weights))
    counted = check_attributes(mesh, attributes)
    if counted and backend == "pymeshlab":
        raise ValueError("the backend pymeshlab has no attributes in its error: choose fast or qslim")
    collapse = partial(BACKENDS[backend], attributes=counted) if counted else BACKENDS[backend]
    free = _check_borders(mesh, free_borders, backend, bool(counted))
    if free is not None:
        collapse = partial(collapse, free=free)
    if faces >= len(mesh.faces):
        return mesh
    failures = []
    for attempt in shrinking_rings(mesh, faces, keep, rings, free is not None) if shrink else [rings]:
        frozen = frozen_faces(mesh, keep, attempt)
        smallest = smallest_feasible(mesh, keep, attempt, free is not None)
        try:
            if faces < smallest and not below:  # before the backend starts
                raise InfeasibleTarget(faces, smallest, int(frozen.sum()))
            return carry(mesh, replace(collapse(mesh, int(faces), frozen, multipliers), up=mesh.up))
        except (InfeasibleTarget, SimplifyError) as error:
            failures.append((error, frozen))
    error, frozen = failures[-1]
    if isinstance(error, InfeasibleTarget):
        factors, may = (None if values is None else values.tobytes() for values in (multipliers, free))
        sound = _smallest_sound(mesh, backend, frozen.tobytes(), factors, error.smallest, may)
        raise InfeasibleTarget(faces, sound, error.frozen)
    raise error


@lru_cache(maxsize=256)  # every target that is refused asks for it, and searches that start apart meet
def _smallest_sound(mesh, backend, frozen, weights, smallest, free=None):
    """The lowest face count, from `smallest` up to the mesh's own, at which the backend gives a sound mesh.

    frozen, weights and free: as of a backend, as bytes.
    """
    if smallest >= len(mesh.faces):
        return len(mesh.faces)
    factors = None if weights is None else np.frombuffer(weights)
    borders = {} if free is None else {"free": np.frombuffer(free, dtype=bool)}
    try:
        face_count = len(BACKENDS[backend](mesh, smallest, np.frombuffer(frozen, dtype=bool), factors, **borders).faces)
        return face_count if free is None else smallest  # with moving borders another target takes other collapses
    except InfeasibleTarget as error:
        higher = max(error.smallest, smallest + 1)
    except SimplifyError:
        higher = int(GROWTH * smallest) + 2
    return _smallest_sound(mesh, backend, frozen, weights, higher, free)


def quadric_weights(saliency: np.ndarray) -> np.ndarray | None:
    """(n,) factor of each vertex's quadric, from its saliency (n,) in 0..1: 1 + STRENGTH * saliency.

    None where it is the same everywhere, which is plain QEM. All backends multiply the quadric of the planes around a
    vertex by it before the first collapse; sums of quadrics propagate it. A quadric is a squared distance: at a
    saliency of 1 the same distance has sqrt(1 + STRENGTH) = 5.6 times the weight.
    """
    return None if np.ptp(saliency) == 0 else 1 + STRENGTH * saliency


def _check_borders(mesh, free, backend, counted):
    """(n,) boolean of the vertices of borders that may move, or None; ValueError where they cannot."""
    free = np.asarray(free)
    if free.shape not in ((), (len(mesh.vertices),)) or free.dtype.kind not in "biu":
        shape = f"({len(mesh.vertices)},), got {free.shape} {free.dtype}"
        raise ValueError(f"free_borders must be True, False, or one per vertex, {shape}")
    if not free.any() or (half_edges(mesh.faces)[1] >= 0).all():
        return None
    if backend == "pymeshlab" or counted:
        raise ValueError("borders stay where the backend is pymeshlab or attributes are counted: leave one out")
    return np.broadcast_to(free.astype(bool), len(mesh.vertices))


def check_weights(mesh: Mesh, weights: np.ndarray) -> np.ndarray:
    """The weights (n,) f8; ValueError unless they are one per vertex and in 0..1."""
    weights = np.asarray(weights, dtype=np.float64)
    if weights.shape != (len(mesh.vertices),):
        raise ValueError(f"weights must be one per vertex, ({len(mesh.vertices)},), got {weights.shape}")
    if not (weights >= 0).all() or not (weights <= 1).all():
        raise ValueError("weights must lie in 0..1, without NaN")
    return weights

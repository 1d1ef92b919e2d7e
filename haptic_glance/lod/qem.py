"""Quadric edge collapse through pymeshlab, the reference backend."""

import functools

import numpy as np

from haptic_glance.base.extras import from_extra
from haptic_glance.mesh.mesh import Mesh

from .errors import metro
from .feasibility import InfeasibleTarget, SimplifyError
from .topology import NONE, faults, split_nonmanifold_vertices

# Every parameter, every time: pymeshlab gives one that is left out the value of the call before, not its default.
SETTINGS = {
    "targetperc": 0.0,
    "preserveboundary": True,  # vertices of the open boundary stay where they are
    "boundaryweight": 1.0,
    "preservenormal": True,  # no collapse turns a face by more than 45 degrees
    "preservetopology": True,  # the link condition: components and genus stay
    "optimalplacement": True,  # the new vertex minimises the quadric; at an edge's end the mean error is twice as large
    "planarquadric": True,  # a weak pull to well-shaped faces, where the quadric of a plane leaves the position open
    "autoclean": False,
}

# (weight of the pull to well-shaped faces, weight of shape in the order of collapses), tried in this order until the
# result has no new fault. Over 223 cells of household objects the weight 1e-5 adds the fewest folds and no degenerate
# face, and keeps the mean error of plain QEM; with no pull 11 cells get degenerate faces. The others are for thin parts
# and for frozen regions close together, where it is chance which of them folds nothing: the first attempt fails in 9 of
# 156 cells at the smallest feasible count. The strong pulls at the end can flatten the whole surface there.
ATTEMPTS = ((1e-5, 0.3), (1e-4, 0.5), (1e-5, 0.8), (1e-6, 0.5), (1e-4, 0.8), (1e-5, 0.1), (1e-3, 0.5), (1e-2, 0.1))
MAX_RATIO = 1.5  # of an attempt's mean error to the first one's: weak pulls have up to 1.3, strong ones up to 10
SAMPLES = 2000  # for that: the mean within 3 %

QUALITY_FACTOR = 100.0  # pymeshlab maps its vertex quality q, stretched to 0..1, to the weight 1 + 99 q^2


def collapse(mesh: Mesh, faces: int, frozen: np.ndarray, weights: np.ndarray | None = None) -> Mesh:
    """A sound Mesh of at most `faces` faces, by quadric edge collapse (Garland and Heckbert 1997, T [222]).

    frozen (m,) boolean: faces that are preserved bit for bit. weights (n,) f8 from 1 to 100: factor of each vertex's
    quadric; None for plain QEM. Returns no colours.
    Raises InfeasibleTarget when no collapse is left above the target, SimplifyError when every attempt is faulty.
    """
    split, source = _split_vertices(mesh)
    quality = None if weights is None else np.sqrt((weights[source] - 1) / (QUALITY_FACTOR - 1))
    before = functools.cache(lambda: faults(mesh))  # seldom needed
    first, reason = None, ""
    for attempt in ATTEMPTS:
        reduced = decimated(split, faces, frozen, quality, *attempt)
        if len(reduced.faces) > faces:
            raise InfeasibleTarget(faces, len(reduced.faces), int(frozen.sum()))
        after = faults(reduced)
        added = after.added(before()) if after != NONE else ""
        if first is None:
            first, reason = reduced, added
        if not added and (reduced is first or _error(mesh, reduced) <= MAX_RATIO * _error(mesh, first)):
            return reduced
    raise SimplifyError(f"{faces} faces leave {reason}, or a surface far from the original: ask for more faces")


def _error(mesh, reduced):
    return metro(mesh, reduced, SAMPLES)["mean"]


def _split_vertices(mesh):
    """(the mesh with non-manifold vertices split, (n',) the vertex of `mesh` that each of its vertices is).

    pymeshlab preserves a non-manifold vertex as if it were genus: the teapot has 435 of them, and is ruined below 30 %
    of its faces.
    """
    faces = split_nonmanifold_vertices(mesh.faces)
    source = np.zeros(int(faces.max()) + 1, dtype=np.int64)
    source[faces] = mesh.faces
    return Mesh(mesh.vertices[source], faces), source


def decimated(
    mesh: Mesh, faces: int, frozen: np.ndarray, quality: np.ndarray | None, planar_weight: float, shape_weight: float
) -> Mesh:
    """One run of the filter; it leaves more faces than asked for where no further collapse is allowed.

    planar_weight: the weight of `planarquadric`. shape_weight: how far collapses that leave slivers are put off
    (`qualitythr`, 0 to 1). Vertices pass through in double precision.
    """
    with from_extra():  # takes a second to load, and the fast backend does not need it
        import pymeshlab

    scale = -np.frexp(mesh.diagonal)[1]  # pymeshlab has absolute tolerances; powers of two change no bit of a mantissa
    vertices, anchors = np.ldexp(mesh.vertices, scale), 0
    scalars = {"f_scalar_array": frozen.astype(np.float64)}
    if quality is not None:
        # pymeshlab rescales the quality to 0..1: two vertices in no face, with 0 and 1, keep it unchanged.
        vertices, anchors = np.concatenate([vertices, vertices[:1], vertices[:1]]), 2
        scalars["v_scalar_array"] = np.r_[quality, 0.0, 1.0]
    work = pymeshlab.MeshSet(verbose=False)  # pyright: ignore[reportAttributeAccessIssue] (compiled, without a stub)
    work.add_mesh(pymeshlab.Mesh(vertices, mesh.faces, **scalars))  # pyright: ignore[reportAttributeAccessIssue]
    if frozen.any():
        work.apply_filter("compute_selection_by_condition_per_face", condselect="fq < 0.5")
    work.apply_filter(
        "meshing_decimation_quadric_edge_collapse",
        targetfacenum=int(faces - frozen.sum()),  # with `selected`, only the selected faces count
        selected=bool(frozen.any()),
        qualityweight=quality is not None,
        planarweight=planar_weight,
        qualitythr=shape_weight,
        **SETTINGS,
    )
    filtered = work.current_mesh()
    return Mesh(
        np.ldexp(filtered.vertex_matrix()[: filtered.vertex_number() - anchors], -scale), filtered.face_matrix()
    )

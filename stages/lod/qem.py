"""Quadric edge collapse through pymeshlab, the reference backend."""

import functools

import numpy as np

from stages.kit import Mesh

from .feasibility import InfeasibleTarget, SimplifyError
from .metro import metro
from .topology import NONE, faults, split_pinches

# Every parameter, every time: pymeshlab gives one that is left out the value of the call before, not its default.
SETTINGS = {
    "targetperc": 0.0,
    "preserveboundary": True,  # vertices of the open boundary stay where they are
    "boundaryweight": 1.0,
    "preservenormal": True,  # no collapse turns a face by more than 45 degrees
    "preservetopology": True,  # the link condition: pieces and handles stay
    "optimalplacement": True,  # the new vertex minimises the quadric; on an edge's end the mean error is twice as large
    "planarquadric": True,  # a weak pull to round faces, where the quadric of a plane leaves the place open
    "autoclean": False,
}

# (weight of the pull to round faces, weight of good shape in the order of collapses), tried in this order until the
# result has no fault that the mesh had not. Over 223 cells of household objects the weight 1e-5 adds the fewest folds,
# no degenerate face, and keeps the mean error of plain QEM; with no pull 11 cells get degenerate faces. The others are
# for thin parts and for islands close together, where it is luck which of them folds nothing: the first attempt fails
# in 9 of 156 cells at the floor of what is feasible. The strong pulls at the end can flatten the whole surface there.
ATTEMPTS = ((1e-5, 0.3), (1e-4, 0.5), (1e-5, 0.8), (1e-6, 0.5), (1e-4, 0.8), (1e-5, 0.1), (1e-3, 0.5), (1e-2, 0.1))
RUINED = 1.5  # an attempt's mean error over the first one's: up to 1.3 with the weak pulls, 1.1 to 10 with the strong
SAMPLES = 2000  # for that: the mean within 3 %

QUALITY_FACTOR = 100.0  # pymeshlab maps its vertex quality q, stretched to 0..1, to the weight 1 + 99 q^2


def collapse(mesh, faces, frozen, weights=None):
    """A sound Mesh of at most `faces` faces, by quadric edge collapse (Garland and Heckbert 1997, T [222]).

    frozen (m,) boolean: faces that come through bit for bit. weights (n,) f8 from 1 to 100: what each vertex's quadric
    is multiplied by; None for plain QEM. Returns no colours.
    Raises InfeasibleTarget when no collapse is left above the target, SimplifyError when every attempt is faulty.
    """
    apart, source = _without_pinches(mesh)
    quality = None if weights is None else np.sqrt((weights[source] - 1) / (QUALITY_FACTOR - 1))
    before = functools.cache(lambda: faults(mesh))  # seldom asked for
    first = said = None
    for attempt in ATTEMPTS:
        found = decimated(apart, faces, frozen, quality, *attempt)
        if len(found.faces) > faces:
            raise InfeasibleTarget(faces, len(found.faces), int(frozen.sum()))
        after = faults(found)
        added = after.added(before()) if after != NONE else ""
        if first is None:
            first, said = found, added
        if not added and (found is first or _error(mesh, found) <= RUINED * _error(mesh, first)):
            return found
    raise SimplifyError(f"{faces} faces leave {said}, or a surface far from the old one: ask for more faces")


def _error(mesh, found):
    return metro(mesh, found, SAMPLES)["mean"]


def _without_pinches(mesh):
    """(the mesh with pinched vertices doubled, (n',) the vertex of `mesh` that each of its vertices is).

    pymeshlab holds every pinch as if it were a handle: the teapot, with 435 of them, collapses below 30 % of its faces.
    """
    faces = split_pinches(mesh.faces)
    source = np.zeros(int(faces.max()) + 1, dtype=np.int64)
    source[faces] = mesh.faces
    return Mesh(mesh.vertices[source], faces), source


def decimated(mesh, faces, frozen, quality, planar_weight, shape_weight):
    """One run of the filter; it may leave more faces than asked where no collapse is allowed any more.

    planar_weight: the weight of `planarquadric`. shape_weight: how far collapses that leave needles are put off
    (`qualitythr`, 0 to 1). Vertices pass through in double precision.
    """
    import pymeshlab  # takes a second to load, and the fast backend does without

    scale = -np.frexp(mesh.diagonal)[1]  # pymeshlab has absolute tolerances; powers of two change no bit of a mantissa
    vertices, anchors = np.ldexp(mesh.vertices, scale), 0
    scalars = {"f_scalar_array": frozen.astype(np.float64)}
    if quality is not None:
        # pymeshlab stretches the quality to 0..1 by itself: two vertices in no face, at its ends, leave it as it is.
        vertices, anchors = np.concatenate([vertices, vertices[:1], vertices[:1]]), 2
        scalars["v_scalar_array"] = np.r_[quality, 0.0, 1.0]
    work = pymeshlab.MeshSet(verbose=False)
    work.add_mesh(pymeshlab.Mesh(vertices, mesh.faces, **scalars))
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
    found = work.current_mesh()
    return Mesh(np.ldexp(found.vertex_matrix()[: found.vertex_number() - anchors], -scale), found.face_matrix())

"""Quadric edge collapse through pymeshlab."""

import numpy as np
import pymeshlab

from stages.kit import Mesh

# Every parameter, every time: pymeshlab gives one that is left out the value of the call before, not its default.
SETTINGS = {
    "targetperc": 0.0,
    "preserveboundary": True,  # vertices of the open boundary stay where they are
    "boundaryweight": 1.0,
    "preservenormal": True,  # no collapse turns a face by more than 45 degrees
    "preservetopology": True,  # the link condition: pieces and handles stay
    "optimalplacement": True,  # the new vertex minimises the quadric; on an edge's end the mean error is twice as large
    "planarquadric": True,  # a weak pull to round faces, where the quadric of a plane leaves the place open
    "qualityweight": False,
    "autoclean": False,
}


def collapse(mesh, faces, frozen, planar_weight, shape_weight):
    """Quadric edge collapse (Garland and Heckbert 1997, T [222]) down to `faces` faces, the frozen ones untouched.

    frozen (m,) boolean. planar_weight: the weight of `planarquadric`. shape_weight: how far collapses that leave
    needles are put off (`qualitythr`, 0 to 1). Vertices pass through in double precision.
    Returns a Mesh without colours; it may have more faces than asked where no collapse is allowed any more.
    """
    scale = -np.frexp(mesh.diagonal)[1]  # pymeshlab has absolute tolerances; powers of two change no bit of a mantissa
    work = pymeshlab.MeshSet(verbose=False)
    work.add_mesh(pymeshlab.Mesh(np.ldexp(mesh.vertices, scale), mesh.faces, f_scalar_array=frozen.astype(np.float64)))
    if frozen.any():
        work.apply_filter("compute_selection_by_condition_per_face", condselect="fq < 0.5")
    work.apply_filter(
        "meshing_decimation_quadric_edge_collapse",
        targetfacenum=int(faces - frozen.sum()),  # with `selected`, only the selected faces count
        selected=bool(frozen.any()),
        planarweight=planar_weight,
        qualitythr=shape_weight,
        **SETTINGS,
    )
    found = work.current_mesh()
    return Mesh(np.ldexp(found.vertex_matrix(), -scale), found.face_matrix())

"""Other triangles on the same surface, of equal size everywhere."""

import numpy as np
import pymeshlab
from scipy.spatial import cKDTree

from stages.kit import Mesh

from .perturbed import Perturbed, in_range

# Every parameter, every time: pymeshlab gives one that is left out the value of the call before, not its default.
SETTINGS = {
    "iterations": 5,
    "adaptive": False,
    "selectedonly": False,
    "featuredeg": 30.0,  # degrees; sharper edges stay
    "checksurfdist": True,
    "maxsurfdist": pymeshlab.PercentageValue(1.0),  # of the diagonal
    "splitflag": True,
    "collapseflag": True,
    "swapflag": True,
    "smoothflag": True,
    "reprojectflag": True,
}


def remeshing(mesh, severity, _generator):
    """Isotropic triangles with edges of `severity` of the diagonal: splits, collapses, flips, smoothing (pymeshlab).

    Colours come from the nearest vertex. ValueError where the surface collapses at this length.
    """
    length = 100 * in_range(severity, 1e-3, 1, "the edge length over the diagonal")
    work = pymeshlab.MeshSet(verbose=False)
    work.add_mesh(pymeshlab.Mesh(mesh.vertices, mesh.faces))
    try:
        work.apply_filter(
            "meshing_isotropic_explicit_remeshing", targetlen=pymeshlab.PercentageValue(length), **SETTINGS
        )
    except pymeshlab.PyMeshLabException as error:
        raise ValueError(f"this mesh cannot be remeshed: {' '.join(str(error).split())}") from None
    vertices, faces = work.current_mesh().vertex_matrix(), work.current_mesh().face_matrix()
    if len(faces) == 0 or not np.isfinite(vertices).all():
        raise ValueError(f"no surface is left at edges of {severity:g} of the diagonal: take shorter ones")
    colors = None if mesh.colors is None else mesh.colors[cKDTree(mesh.vertices).query(vertices)[1]]
    return Perturbed(Mesh(vertices, faces, colors), vertices)

# pymeshlab comes without types:
# pyright: reportAttributeAccessIssue=false
"""The same surface with other triangles, all of about the same size."""

import numpy as np
import pymeshlab
from scipy.spatial import KDTree

from haptic_glance.mesh.mesh import Mesh

from .perturbed import Perturbed, in_range

# All parameters are given: pymeshlab sets one that is left out to its value in the call before, not to its default.
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


def remeshing(mesh: Mesh, severity: float, _generator: np.random.Generator) -> Perturbed:
    """Isotropic triangles with edges of `severity` of the diagonal: splits, collapses, flips, smoothing (pymeshlab).

    Colours are those of the nearest vertex. Raises ValueError where the surface collapses at this edge length.
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
    colors = None if mesh.colors is None else mesh.colors[KDTree(mesh.vertices).query(vertices)[1]]
    return Perturbed(Mesh(vertices, faces, colors), vertices)

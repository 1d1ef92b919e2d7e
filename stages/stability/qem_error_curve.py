# pymeshlab comes without types:
# pyright: reportAttributeAccessIssue=false
"""The error of plain quadric edge collapse (QEM) by face count, with which simplified meshes are compared."""

import numpy as np
import pymeshlab

from haptic_glance.lod.export import face_count
from haptic_glance.mesh.mesh import Mesh

from .checks import surface_error

FEWEST_FACES = 16  # below this number the error of plain QEM is a matter of chance
LEAST_ERROR = 1e-4  # of the diagonal: smaller errors, as on flat faces, are set to this


class QemErrorCurve:
    """The mean error of plain QEM on a sound mesh at any face count, interpolated between a few measured ones."""

    def __init__(self, sound: Mesh) -> None:
        counts = {face_count(target, len(sound.faces)) for target in ("16", "64", "256", "1024", "50%")}
        self.counts = sorted(count for count in counts if FEWEST_FACES <= count < len(sound.faces))
        self.errors = [max(surface_error(sound, plain_qem(sound, count)), LEAST_ERROR) for count in self.counts]

    def error(self, faces: int) -> float:
        """The mean error over the diagonal: linear between the counts in log-log space, infinite below FEWEST_FACES."""
        if faces < FEWEST_FACES or not self.counts:
            return np.inf
        return float(np.exp(np.interp(np.log(faces), np.log(self.counts), np.log(self.errors))))


def plain_qem(mesh: Mesh, faces: int) -> Mesh:
    """The mesh at `faces` faces by pymeshlab's quadric edge collapse, without any of its constraints."""
    work = pymeshlab.MeshSet(verbose=False)
    work.add_mesh(pymeshlab.Mesh(mesh.vertices / mesh.diagonal, mesh.faces))
    work.apply_filter(
        "meshing_decimation_quadric_edge_collapse", targetfacenum=faces, targetperc=0.0, qualitythr=0.3,
        preserveboundary=False, boundaryweight=1.0, preservenormal=False, preservetopology=False,
        optimalplacement=True, planarquadric=True, planarweight=1e-5, qualityweight=False, autoclean=False,
        selected=False,
    )  # fmt: skip
    found = work.current_mesh()
    return Mesh(found.vertex_matrix() * mesh.diagonal, found.face_matrix())

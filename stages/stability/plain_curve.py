"""How far off plain quadric edge collapse is at a face count: what a simplified mesh is held against."""

import numpy as np
import pymeshlab

from stages.kit import Mesh
from stages.lod.targets import face_count

from .checks import surface_error

COARSEST = 16  # faces: below it plain QEM is a matter of luck
LEAST = 1e-4  # of the diagonal: errors below it, as on flat faces, count as this


class PlainCurve:
    """The mean error of plain QEM of a sound mesh at any face count, measured at a few."""

    def __init__(self, sound):
        counts = {face_count(target, len(sound.faces)) for target in ("16", "64", "256", "1024", "50%")}
        self.counts = sorted(count for count in counts if COARSEST <= count < len(sound.faces))
        self.errors = [max(surface_error(sound, plain_qem(sound, count)), LEAST) for count in self.counts]

    def error(self, faces):
        """Straight in both logarithms between the counts; infinite below COARSEST faces."""
        if faces < COARSEST or not self.counts:
            return np.inf
        return float(np.exp(np.interp(np.log(faces), np.log(self.counts), np.log(self.errors))))


def plain_qem(mesh, faces):
    """The mesh at `faces` faces by pymeshlab, nothing preserved: what quadrics alone make of it."""
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

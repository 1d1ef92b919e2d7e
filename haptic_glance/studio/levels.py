"""Levels of detail of one mesh, with their errors."""

from dataclasses import dataclass
from functools import cached_property
from threading import RLock

import numpy as np
from scipy.spatial import KDTree

from haptic_glance.lod import InfeasibleTarget, metro, neighbourhoods, vertex_errors
from haptic_glance.lod.kernels.jit import FOLDER
from haptic_glance.lod.simplify import BACKEND
from haptic_glance.lod.task import SimplificationTask, repaired
from haptic_glance.look.points import saliency
from haptic_glance.mesh import rotate_to_z_up
from haptic_glance.mesh.mesh import Mesh

from .files import as_bytes
from .jobs import Report
from .specimen import Look, Specimen

SAMPLES = 4000  # of the Metro error: its mean within 2 % of that of 40,000
SOFT, HARD = "soft: weighted by saliency", "hard: neighbourhoods kept"
KEPT = 24  # levels that are kept for a slider that goes back


@dataclass(frozen=True)
class Level:
    """mesh: simplified, in the frame of the task; shown: the same z up. mean, most: Metro, in % of the diagonal.

    error (k,): at each vertex, how far the original is from it around there, in % of the diagonal; saliency (k,).
    """

    mesh: Mesh
    shown: Mesh
    mean: float
    most: float
    error: np.ndarray
    saliency: np.ndarray


class Levels:
    """The levels of a Specimen, by what a Look at it found; each is computed once."""

    def __init__(self, specimen: Specimen, look: Look) -> None:
        self.specimen, self.looked, self.lock = specimen, look, RLock()
        self._levels: dict[tuple[int, str], Level] = {}

    @cached_property
    def tasks(self) -> dict[str, SimplificationTask]:
        """{SOFT, HARD: the SimplificationTask}."""
        mesh, _ = repaired(self.specimen.source)
        keeps_vertices = len(mesh.vertices) == len(self.specimen.source.vertices)
        values = self.looked.saliency if keeps_vertices else saliency(mesh, self.looked.method)
        places = np.array([row[2:5] for row in self.looked.points]).reshape(-1, 3)
        points = np.unique(KDTree(mesh.vertices).query(places)[1]).astype(np.int64)
        no_points = np.zeros(0, dtype=np.int64)
        rings = neighbourhoods(mesh, points, "adaptive")
        return {
            SOFT: SimplificationTask(mesh, values, no_points, no_points, values, BACKEND, False),
            HARD: SimplificationTask(mesh, values, points, rings, None, BACKEND, True),
        }

    @property
    def faces(self) -> int:
        """How many faces the mesh has, repaired."""
        return len(self.tasks[SOFT].mesh.faces)

    def at(self, faces: int, kind: str, report: Report) -> Level:
        """The Level of at most `faces` faces. ValueError that says what is feasible."""
        with self.lock:
            if (faces, kind) not in self._levels:
                self._levels = dict(list(self._levels.items())[1 - KEPT :])
                self._levels[faces, kind] = self._made(faces, kind, report)
            return self._levels[faces, kind]

    def _made(self, faces, kind, report):
        first = not any(FOLDER.rglob("*.nbc"))
        report(0.1, "compiling, the first time on this machine: about ten seconds" if first else "simplifying")
        task = self.tasks[kind]
        try:
            mesh = task.simplified(faces) if faces < len(task.mesh.faces) else task.mesh
        except InfeasibleTarget as error:
            raise ValueError(f"{error.faces:,} faces are too few here: ask for {error.smallest:,} or more") from None
        report(0.6, "measuring the error")
        errors = metro(task.mesh, mesh, SAMPLES)
        report(0.8, "measuring the error at each vertex")
        percents = 100 * vertex_errors(mesh, task.mesh) / task.mesh.diagonal
        around = np.zeros(len(mesh.vertices))
        np.maximum.at(around, KDTree(mesh.vertices).query(task.mesh.vertices)[1], percents)
        nearest = task.saliency[KDTree(task.mesh.vertices).query(mesh.vertices)[1]]
        return Level(mesh, rotate_to_z_up(mesh), 100 * errors["mean"], 100 * errors["max"], around, nearest)

    def content(self, level: Level, kind: str, suffix: str) -> bytes:
        """The file of a level in the file's coordinates, upright as its format has it."""
        return as_bytes(self.tasks[kind].restored(level.mesh), suffix)

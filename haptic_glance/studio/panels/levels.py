"""Fewer faces: a slider, the error that they cost, where it lies, and files of the result.

`Levels` simplifies and measures without a page; `LevelsPanel` shows it.
"""

import time
from dataclasses import dataclass
from functools import cached_property
from threading import RLock

import numpy as np
import viser
from scipy.spatial import KDTree

from haptic_glance.base.jit import kernel_folder
from haptic_glance.lod import InfeasibleTarget, metro, neighbourhoods, vertex_errors
from haptic_glance.lod.mesh_pictures import viridis, vivid
from haptic_glance.lod.simplify import BACKEND
from haptic_glance.lod.task import SimplificationTask, repaired
from haptic_glance.look.points import saliency
from haptic_glance.mesh import rotate_to_z_up
from haptic_glance.mesh.mesh import Mesh

from ..jobs import Report
from ..panel import Panel
from ..scene import MESH
from ..specimen import Look, Specimen, as_bytes

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
        first = not any(kernel_folder().rglob("*.nbc"))
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


SHARE = 10  # % of the faces at first
SETTLE = 0.25  # seconds that the slider rests before work begins
SALIENCY, ERROR, PLAIN = "saliency", "error", "faces"


class LevelsPanel(Panel):
    """Shows the mesh on the table with fewer faces."""

    title = "Levels"

    def build(self, gui: viser.GuiApi) -> None:
        self.levels: Levels | None = None
        self.level: Level | None = None
        self.share = gui.add_slider("Faces, %", 1, 100, 1, SHARE)
        self.kind = gui.add_dropdown("Spared", [SOFT, HARD])
        self.colour = gui.add_dropdown("Colour", [ERROR, SALIENCY, PLAIN])
        self.text = gui.add_markdown("")
        self.saves = gui.add_button_group("Save", ["GLB", "OBJ", "CSV of the places"])
        for control in (self.share, self.kind):
            self.window.on(control.on_update, self.on_show)
        self.window.on(self.colour.on_update, self.draw)
        self.window.on(self.saves.on_click, self.save)

    def on_mesh(self) -> None:
        self.levels = self.level = None
        self.text.content = ""

    def on_show(self) -> None:
        """Simplifies to what the slider says, once it rests."""
        session, share, kind = self.window.session, self.share.value, self.kind.value
        look = session.look()
        if self.levels is None or self.levels.looked is not look:
            self.levels = Levels(session.on_table, look)
        levels = self.levels

        def work(report: Report) -> Level:
            time.sleep(SETTLE)
            report(0.05, "")  # ends here where the slider has moved on
            return levels.at(max(round(levels.faces * share / 100), 4), kind, report)

        self.window.work("Simplifying", work, self.put, slot=self.title)

    def on_hide(self) -> None:
        """The mesh itself is shown again by the next panel."""
        self.level = None

    def put(self, level: Level) -> None:
        """Shows a level and its error."""
        assert self.levels is not None
        self.level = level
        whole = self.levels.faces
        self.text.content = (
            f"**{len(level.mesh.faces):,} faces** of {whole:,}\n\n"
            f"Metro error: mean **{level.mean:.3f} %**, largest **{level.most:.2f} %** of the diagonal"
        )
        self.draw()

    def draw(self) -> None:
        """Draws the level in the chosen colours."""
        if self.level is None or self.window.panel is not self:
            return
        self.window.scene.mesh(MESH, self.level.shown, self.colours(self.level), flat=True)

    def colours(self, level: Level) -> np.ndarray | None:
        """(k, 3) u1 colours of the vertices of a level; None for grey."""
        if self.colour.value == ERROR:
            return viridis(level.error / (level.error.max() or 1.0))
        if self.colour.value == SALIENCY:
            return viridis(vivid(level.saliency))
        return None

    def save(self) -> None:
        """Hands out what is shown as a file."""
        level, levels, kind, choice = self.level, self.levels, self.kind.value, self.saves.value
        if level is None or levels is None:
            raise ValueError("there is no level yet: wait until it is shown")
        suffix = f".{choice.lower()}"
        if choice.startswith("CSV"):
            self.window.save_points(levels.looked)
        else:
            self.window.save(f"{len(level.mesh.faces)}{suffix}", lambda: levels.content(level, kind, suffix))

"""Fewer faces: a slider, the error that they cost, where it lies, and files of the result."""

import time

import numpy as np
import viser

from haptic_glance.cli.saliency import as_csv
from haptic_glance.lod.pictures import viridis, vivid

from ..jobs import Report
from ..levels import HARD, SOFT, Level, Levels
from ..panel import Panel
from ..scene import GREY, MESH

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

    def colours(self, level: Level) -> np.ndarray:
        """(k, 3) u1 colours of the vertices of a level."""
        if self.colour.value == ERROR:
            return viridis(level.error / (level.error.max() or 1.0))
        if self.colour.value == SALIENCY:
            return viridis(vivid(level.saliency))
        return np.full((len(level.mesh.vertices), 3), GREY, dtype=np.uint8)

    def save(self) -> None:
        """Hands out what is shown as a file."""
        session, level, levels, kind = self.window.session, self.level, self.levels, self.kind.value
        if level is None or levels is None:
            raise ValueError("there is no level yet: wait until it is shown")
        name, send = session.on_table.name, self.window.download
        if self.saves.value.startswith("CSV"):
            return send(f"{name}_points.csv", (as_csv(levels.looked.points, session.on_table.source) + "\n").encode())
        suffix = f".{self.saves.value.lower()}"
        file = f"{name}_{len(level.mesh.faces)}{suffix}"
        self.window.work(
            f"Writing {file}", lambda _: levels.content(level, kind, suffix), lambda content: send(file, content)
        )

"""Marks of a person: a click marks a vertex, and every change is saved at once.

Marks are safe from another window of the same name. `Marking` needs no page; `MarkPanel` shows it.
"""

from datetime import UTC, datetime
from pathlib import Path

import viser

from haptic_glance.lod.task import number
from haptic_glance.look.marks import MarksChanged, check_annotator, check_on_mesh, read_rows, utc, write_marks
from haptic_glance.mesh.mesh import Mesh

from ..panel import Panel
from ..scene import BLUE, escaped
from ..specimen import Hit

Mark = tuple[str, int]  # time (UTC), vertex


class Marking:
    """marks: those of the annotator, as they are shown. seen: as they are in the file FOLDER/NAME.csv.

    mesh: normalised and z up. Raises ValueError for an invalid name, or a file that is damaged or of another mesh.
    """

    def __init__(self, mesh: Mesh, name: str, folder: Path, annotator: str) -> None:
        self.mesh, self.path, self.annotator = mesh, folder / f"{name}.csv", check_annotator(annotator)
        self.seen = self._stored()
        self.marks = list(self.seen)
        self._before: list[list[Mark]] = []

    @property
    def saved(self) -> bool:
        """Whether the file has all of it."""
        return self.marks == self.seen

    def add(self, vertex: int) -> None:
        """Marks a vertex, unless it is marked."""
        if vertex not in [marked for _, marked in self.marks]:
            self._become([*self.marks, (utc(datetime.now(UTC)), vertex)])

    def remove(self, number: int) -> None:
        """Takes away the mark of a number, counted from 1."""
        if not 1 <= number <= len(self.marks):
            raise ValueError(f"there is no point {number}: they are 1 to {len(self.marks)}")
        self._become([mark for k, mark in enumerate(self.marks, 1) if k != number])

    def undo(self) -> None:
        """Takes back what was added or removed last."""
        if not self._before:
            raise ValueError("there is nothing to undo")
        self.marks = self._before.pop()

    def save(self) -> bool:
        """Writes what has changed; True where another window had saved under this name: then the points of both stay.

        Raises ValueError or OSError where nothing can be written; the marks stay, and the next save tries again.
        """
        was_merged = False
        while not self.saved:
            try:
                write_marks(self.path, self.annotator, [self._row(mark) for mark in self.marks], self.seen)
                self.seen = list(self.marks)
            except MarksChanged:
                self._merge(self._stored())
                was_merged = True
        return was_merged

    def _merge(self, stored):
        """Merges the stored marks with those that this window added and removed."""
        removed = set(self.seen) - set(self.marks)
        new = [mark for mark in self.marks if mark not in self.seen]
        vertices = {vertex for _, vertex in stored}
        self.marks = [mark for mark in stored if mark not in removed] + [
            mark for mark in new if mark[1] not in vertices
        ]
        self.seen, self._before = stored, []

    def _become(self, marks):
        self._before.append(self.marks)
        self.marks = marks

    def _row(self, mark):
        time, vertex = mark
        return {"time": time, "vertex": vertex, **dict(zip("xyz", self.mesh.vertices[vertex], strict=True))}

    def _stored(self):
        if not self.path.exists():
            return []
        marks = read_rows(self.path)
        check_on_mesh([mark.vertex for mark in marks], [mark[3:] for mark in marks], self.mesh, self.path)
        return [(mark.time, mark.vertex) for mark in marks if mark.annotator == self.annotator]


MARKS = "/marks"


class MarkPanel(Panel):
    """Marks points of the mesh on the table, which is shown without its saliency, so as not to suggest any."""

    title = "Mark"

    def build(self, gui: viser.GuiApi) -> None:
        self.marking: Marking | None = None
        settings = self.window.settings
        gui.add_markdown("Click the points of this object that matter to you, from all sides.")
        self.name = gui.add_text("Your name", settings.annotator, hint="as it will stand in the file")
        self.state = gui.add_markdown("")
        self.undo_button = gui.add_button("Undo", disabled=True, color="gray")
        self.number = gui.add_dropdown("Point", ["-"])
        self.remove_button = gui.add_button("Remove this point", disabled=True, color="gray")
        self.list = gui.add_markdown("")
        self.window.on(self.name.on_update, self.on_show)
        self.window.on(self.undo_button.on_click, self.undo)
        self.window.on(self.remove_button.on_click, self.remove)

    def on_mesh(self) -> None:
        """Another mesh has marks of its own."""
        self.marking = None

    def on_show(self) -> None:
        """Shows the mesh and the points that were saved under this name."""
        specimen, name = self.window.session.on_table, self.name.value.strip()
        self.window.show()
        self.marking = None
        if name:
            self.marking = Marking(specimen.mesh, specimen.name, self.window.settings.marks, name)
        self.draw()

    def on_hide(self) -> None:
        self.window.scene.clear(MARKS)

    def on_click(self, hit: Hit) -> None:
        if self.marking is None:
            raise ValueError("who marks? Write your name first")
        self.marking.add(hit.vertex)
        self.save()

    def undo(self) -> None:
        """Takes back the last change."""
        if self.marking is not None:
            self.marking.undo()
            self.save()

    def remove(self) -> None:
        """Removes the chosen point."""
        if self.marking is not None and self.number.value.isdecimal():
            self.marking.remove(int(self.number.value))
            self.save()

    def save(self) -> None:
        """Saves and shows what there is; where it cannot be saved, the points stay and the page says why."""
        assert self.marking is not None
        try:
            if self.marking.save():
                name = self.marking.annotator
                self.window.say("Both are kept", f"{name} has saved points from another window meanwhile.", "yellow")
        finally:
            self.draw()

    def draw(self) -> None:
        """Shows the points, and whether they are saved."""
        marking = self.marking
        marks = marking.marks if marking else []
        numbers = [str(k) for k in range(1, len(marks) + 1)]
        mesh, vertex_ids = self.window.session.on_table.mesh, [vertex for _, vertex in marks]
        self.window.scene.markers(MARKS, mesh.vertices[vertex_ids], mesh.vertex_normals[vertex_ids], numbers, BLUE)
        self.undo_button.disabled = self.remove_button.disabled = not marks
        self.number.options = tuple(numbers) or ("-",)
        self.number.value = self.number.options[-1]
        self.list.content = "\n".join(f"{k}. vertex {v}, {time[11:19]} UTC" for k, (time, v) in enumerate(marks, 1))
        self.state.content = "Nobody marks yet: write your name." if marking is None else state(marking)


def state(marking: Marking) -> str:
    """How many points there are, and whether they are saved, in Markdown."""
    count = number(len(marking.marks), "point")
    return f"**{count}**, all saved in {escaped(str(marking.path))}" if marking.saved else f"**{count}, not saved**"

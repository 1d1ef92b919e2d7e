"""The points that one person marks on a mesh, saved at once, and safe from another window of the same name."""

from datetime import UTC, datetime
from pathlib import Path

from haptic_glance.look.marks import MarksChanged, check_annotator, check_on_mesh, read_rows, utc, write_marks
from haptic_glance.mesh.mesh import Mesh

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

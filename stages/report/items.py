"""The items of the report: tables, and figures or charts. Their words stand in TOPIC/prose.md."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
from matplotlib.figure import Figure as Drawing

from haptic_glance.base.files import write_table, write_text

from .cells import filled
from .drawing import save
from .tables import Ranking, as_text, markdown_table


@dataclass(eq=False, kw_only=True)
class Item:
    """The fields that tables and figures share.

    sets: the data sets that it was read from; record: see `records`; paths: its files; html: its section of the page.
    """

    name: str = ""
    topic: str = ""
    title: str = ""
    sets: list[str] = field(default_factory=list)
    record: dict[str, Any] = field(default_factory=dict)
    paths: list[Path] = field(default_factory=list)
    html: str = ""


@dataclass(eq=False)
class Table(Item):
    """frame: tidy numbers, for the CSV; shown: the table for readers, the same or pivoted; words: for its prose.

    best: the ranking of its rows, None if no rows compete. answer: the columns of `shown` that answer its question, all
    if empty; the other columns follow them. summary: the finding in one sentence.
    """

    frame: pd.DataFrame
    shown: pd.DataFrame | None = None
    words: dict[str, Any] = field(default_factory=dict)
    best: Ranking | None = None
    answer: Sequence[str] = ()
    summary: str = ""
    notes: list[str] = field(default_factory=list)

    @property
    def text(self) -> pd.DataFrame:
        """The shown frame, as strings."""
        return as_text(self.frame if self.shown is None else self.shown)

    @property
    def first(self) -> pd.DataFrame:
        """The columns of `text` that answer the table's question."""
        return self.text[[*self.answer] or [*self.text]]

    @property
    def best_rows(self) -> np.ndarray:
        """(rows,) boolean: the best row, and those that are shown as equal to it."""
        return self.best.best(self.text) if self.best else np.zeros(len(self.text), dtype=bool)

    def write(self, folder: Path) -> None:
        """Writes NAME.csv and NAME.md, and fills the summary's figures in; without them it is left out."""
        self.shown = self.text
        self.paths = [folder / f"{self.name}.csv", folder / f"{self.name}.md"]
        write_table(self.paths[0], self.frame)
        try:
            self.summary, _ = filled(self.summary, folder.parent)
        except LookupError:
            self.summary = ""
        write_text(self.paths[1], "\n\n".join(self._parts()))

    def _parts(self) -> Iterator[str]:
        """Title, summary, table and, folded, the notes, in Markdown."""
        yield f"# {self.title}"
        if self.summary:
            yield self.summary
        yield markdown_table(self.first, self.best_rows)
        remaining = len(self.text.columns) - len(self.first.columns)
        notes = [f"{remaining} more columns, on the site; their numbers are in {self.name}.csv."] if remaining else []
        notes = [*notes, *self.notes]
        if notes:
            note_list = "\n".join(f"- {note}" for note in notes)
            yield f"<details><summary>How to read it</summary>\n\n{note_list}\n\n</details>"


@dataclass(eq=False)
class Figure(Item):
    """drawing: as matplotlib has it; words: for its prose; frame: the numbers of a chart, for a CSV beside the PNG.

    alt: text for blind readers; element: the picture or chart alone, as a page shows it.
    """

    drawing: Drawing
    words: dict[str, Any] = field(default_factory=dict)
    frame: pd.DataFrame | None = None
    dpi: int = 130
    alt: str = ""
    caption: str = ""
    element: str = ""

    def write(self, folder: Path) -> None:
        """Writes NAME.png and, with a frame, NAME.csv; the drawing is closed."""
        self.paths = [save(self.drawing, folder / f"{self.name}.png", self.dpi)]
        if self.frame is not None:
            self.paths.append(folder / f"{self.name}.csv")
            write_table(self.paths[1], self.frame)


@dataclass
class Built:
    """Items of one kind that were built, and one line for each that lacks its measurement."""

    items: list = field(default_factory=list)
    not_run: dict[str, str] = field(default_factory=dict)

"""What the report is made of: tables, and figures or charts. Their words stand in TOPIC/prose.md."""

from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import pandas as pd
from matplotlib.figure import Figure as Drawing

from stages.kit.files import write_table, write_text

from .markdown import as_text, markdown_table
from .style import save


@dataclass(eq=False, kw_only=True)
class Item:
    """What tables and figures have in common.

    sets: the data sets that it was read from; paths: its files; html: its section of the page.
    """

    name: str = ""
    topic: str = ""
    title: str = ""
    sets: list[str] = field(default_factory=list)
    paths: list[Path] = field(default_factory=list)
    html: str = ""


@dataclass(eq=False)
class Table(Item):
    """frame: tidy numbers, for the CSV; shown: what a person reads, the same or pivoted; words: for its prose."""

    frame: pd.DataFrame
    shown: pd.DataFrame | None = None
    words: dict[str, Any] = field(default_factory=dict)
    notes: list[str] = field(default_factory=list)

    @property
    def text(self) -> pd.DataFrame:
        """What a person reads, as strings."""
        return as_text(self.frame if self.shown is None else self.shown)

    def write(self, folder: Path) -> None:
        """Writes NAME.csv and NAME.md."""
        self.shown = self.text
        self.paths = [folder / f"{self.name}.csv", folder / f"{self.name}.md"]
        write_table(self.paths[0], self.frame)
        notes = "\n".join(f"- {note}" for note in self.notes)
        write_text(self.paths[1], f"# {self.title}\n\n{markdown_table(self.shown)}\n\n{notes}")


@dataclass(eq=False)
class Figure(Item):
    """drawing: as matplotlib has it; words: for its prose; frame: the numbers of a chart, for a CSV beside the PNG.

    alt: what a blind reader needs; element: the picture or chart alone, as a page shows it.
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

"""What the report is made of: tables and figures."""

from dataclasses import dataclass, field
from pathlib import Path

import pandas as pd

from stages.kit.files import write_table, write_text

from .markdown import as_text, markdown_table


@dataclass
class Table:
    """frame: tidy numbers, for the CSV; shown: what a person reads, the same or pivoted; notes: sentences below it."""

    title: str
    frame: pd.DataFrame
    notes: list[str]
    shown: pd.DataFrame | None = None
    name: str = ""

    def write(self, folder: Path) -> list[Path]:
        """Writes NAME.csv and NAME.md; returns the paths."""
        self.shown = as_text(self.frame if self.shown is None else self.shown)
        write_table(folder / f"{self.name}.csv", self.frame)
        notes = "\n".join(f"- {note}" for note in self.notes)
        write_text(folder / f"{self.name}.md", f"# {self.title}\n\n{markdown_table(self.shown)}\n\n{notes}")
        return [folder / f"{self.name}.csv", folder / f"{self.name}.md"]


@dataclass
class Figure:
    """A written picture: title, alt (what a blind reader needs), caption, and the files (the PNG first)."""

    title: str
    alt: str
    caption: str
    paths: list[Path]
    name: str = ""


@dataclass
class Built:
    """Items of one kind that were built, and one line for each that lacks its measurement."""

    items: list = field(default_factory=list)
    not_run: dict[str, str] = field(default_factory=dict)

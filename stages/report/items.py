"""What the report is made of: tables, figures, and how the files that build them are found."""

import importlib
import pkgutil
from dataclasses import dataclass, field
from pathlib import Path

import pandas as pd

from stages.kit.files import write_table, write_text

from .markdown import as_text, markdown_table
from .results import NotRun
from .style import look


@dataclass
class Table:
    """frame: tidy numbers, for the CSV; shown: what a person reads, the same or pivoted; notes: sentences below it."""

    title: str
    frame: pd.DataFrame
    notes: list[str]
    shown: pd.DataFrame | None = None
    name: str = ""

    def write(self, folder):
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


def modules(package):
    """The modules of a package in the order of their names, those with a leading underscore left out."""
    names = sorted(info.name for info in pkgutil.iter_modules(package.__path__) if not info.name.startswith("_"))
    return {name: importlib.import_module(f"{package.__name__}.{name}") for name in names}


def build_all(package, results):
    """Calls build(results) of each module of a package; one that lacks its measurement is noted as not run."""
    built = Built()
    for name, module in modules(package).items():
        try:
            with look():
                item = module.build(results)
        except NotRun as missing:
            built.not_run[name] = str(missing)
            continue
        item.name = name
        built.items.append(item)
    return built

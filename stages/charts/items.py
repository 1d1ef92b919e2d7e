"""The items of the report: tables, and figures or charts, with their words.

STAGE/report.md has a section for each item, `# KIND/NAME: title`, where KIND is a folder of reports/. A table's section
is its summary, one sentence whose figures come from the table (`{this row: column}`, see `cells`), then a list of
notes. The section of a figure or chart is `Alt: text for a blind reader`, then the caption. The code fills in `{word}`.
An empty note is left out, and a note of several lines becomes several notes. A `Kept` figure of a data set outside the
default run stays in the repository, with its words in NAME.json.
"""

import re
from collections.abc import Callable, Iterator, Sequence
from contextlib import suppress
from dataclasses import dataclass, field
from functools import cache
from importlib import resources
from pathlib import Path
from types import ModuleType
from typing import Any, NamedTuple

import pandas as pd
from matplotlib.figure import Figure as Drawing

from haptic_glance.base.files import read_json, write_json, write_table, write_text
from stages.charts.results import NotRun, Results, require_file

from .cells import filled
from .drawing import save
from .tables import Ranking, as_text, markdown_table

MOST_COLUMNS = 8  # of a table on a page


@dataclass(eq=False, kw_only=True)
class Item:
    """The fields that tables and figures share.

    kind: its folder of reports/; page: that it is shown on; sets: the data sets that it was read from; paths: its
    files; html: its section of the page.
    """

    name: str = ""
    kind: str = ""
    page: str = ""
    title: str = ""
    sets: list[str] = field(default_factory=list)
    paths: list[Path] = field(default_factory=list)
    html: str = ""


@dataclass(eq=False)
class Table(Item):
    """frame: tidy numbers, for the CSV; shown: the table for readers, the same or pivoted; words: for its prose.

    best: the ranking of its cells, None if none compete. split: a column of `shown`, such as the data set; each of its
    values has a view of its own. answer: the columns that answer the table's question, all if empty; further views have
    the others, each behind the columns `keys`, by default the first. summary: the finding in one sentence.
    """

    frame: pd.DataFrame
    shown: pd.DataFrame | None = None
    words: dict[str, Any] = field(default_factory=dict)
    best: Ranking | None = None
    answer: Sequence[str] = ()
    split: str = ""
    keys: Sequence[str] = ()
    summary: str = ""
    notes: list[str] = field(default_factory=list)

    @property
    def text(self) -> pd.DataFrame:
        """The shown frame, as strings."""
        return as_text(self.frame if self.shown is None else self.shown)

    @property
    def views(self) -> list["View"]:
        """The table as it is shown: the first view answers its question, the others are folded."""
        text = self.text
        columns = [name for name in text if name != self.split]
        answer = [name for name in self.answer if name in columns] or columns
        keys = list(self.keys) or answer[:1]
        others = [name for name in columns if name not in answer]
        step = MOST_COLUMNS - len(keys)
        parts = [answer, *([*keys, *others[start : start + step]] for start in range(0, len(others), step))]
        views = []
        for value in dict.fromkeys(text[self.split]) if self.split else [""]:
            rows = text[text[self.split] == value] if self.split else text
            bold = self.best.best(rows) if self.best else pd.DataFrame(False, rows.index, rows.columns)
            for part in parts:
                title = ", ".join(filter(None, (value, "" if part is answer else "further columns")))
                shown = [name for name in part if not self.split or (rows[name] != "–").any()]
                if part is answer or len(shown) > len(keys):
                    views.append(View(title, rows[shown], bold[shown]))
        return views

    @property
    def legend(self) -> str:
        """What bold means; empty where nothing is bold."""
        shows_bold = self.best and any(view.bold.to_numpy().any() for view in self.views)
        return self.best.legend(map(str, self.text)) if self.best and shows_bold else ""

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
        first, *others = self.views
        yield from filter(None, (f"## {first.title}" if first.title else "", markdown_table(first.text, first.bold)))
        if self.legend:
            yield self.legend
        for view in others:
            yield _folded(view.title, markdown_table(view.text, view.bold))
        if self.notes:
            yield _folded("How to read it", "\n".join(f"- {note}" for note in self.notes))


class View(NamedTuple):
    """A part of a table: its title, its cells as strings, and of each whether it stands in bold."""

    title: str
    text: pd.DataFrame
    bold: pd.DataFrame


def _folded(summary: str, text: str) -> str:
    return f"<details><summary>{summary}</summary>\n\n{text}\n\n</details>"


@dataclass(eq=False)
class Figure(Item):
    """drawing: as matplotlib has it; words: for its prose; frame: the numbers of a chart, for a CSV beside the PNG.

    alt: text for blind readers.
    """

    drawing: Drawing
    words: dict[str, Any] = field(default_factory=dict)
    frame: pd.DataFrame | None = None
    dpi: int = 130
    alt: str = ""
    caption: str = ""

    def write(self, folder: Path) -> None:
        """Writes NAME.png and, with a frame, NAME.csv; the drawing is closed."""
        self.paths = [save(self.drawing, folder / f"{self.name}.png", self.dpi)]
        if self.frame is not None:
            self.paths.append(folder / f"{self.name}.csv")
            write_table(self.paths[1], self.frame)


def add_words(item: Table | Figure, part: ModuleType, kind: str, name: str) -> None:
    """Fills in name, title, summary (not yet its figures), notes of a table; name, title, alt, caption of a figure.

    Raises KeyError where report.md lacks the section or the item lacks a word.
    """
    title, text = _sections(part.__package__ or "")[f"{kind}/{name}"]
    item.name, item.title = name, title.format_map(item.words)
    if isinstance(item, Table):
        summary, *note_texts = re.split(r"^- ", text, flags=re.MULTILINE)
        item.summary = _joined(summary).replace("{this ", f"{{{kind}/{name} ")
        notes = (_joined(note).format_map(item.words) for note in note_texts)
        item.notes = [line for note in notes for line in note.splitlines() if line]
    else:
        alt, _, caption = text.removeprefix("Alt: ").partition("\n\n")
        item.alt, item.caption = (_joined(part).format_map(item.words) for part in (alt, caption))


def shared_notes(package: str | None, name: str) -> str:
    """Notes that several tables of a topic share, a line each, to be a word of theirs: the section `# shared/NAME`."""
    _, text = _sections(package or "")[f"shared/{name}"]
    return "\n".join(_joined(note) for note in re.split(r"^- ", text, flags=re.MULTILINE)[1:])


@cache
def _sections(package: str) -> dict[str, tuple[str, str]]:
    """{KIND/NAME: (title, text below it)} of a stage's report.md."""
    text = resources.files(package).joinpath("report.md").read_text(encoding="utf-8")
    parts = re.split(r"^# (\S+): (.+)$", text, flags=re.MULTILINE)
    return {name: (title, text.strip()) for name, title, text in zip(*(parts[k::3] for k in (1, 2, 3)), strict=True)}


def _joined(lines: str) -> str:
    return " ".join(lines.split())


class Kept(Figure):
    """A figure with its words in NAME.json beside it, so that both remain without the data. An empty drawing: the data
    are gone."""

    def write(self, folder: Path) -> None:
        """Writes NAME.png and NAME.json, where there is something new."""
        words = folder / f"{self.name}.json"
        if self.drawing.axes:
            super().write(folder)
            write_json(words, self.words)
        self.paths = [words.with_suffix(".png"), words]


def last_drawn(results: Results, name: str, stage: str) -> Kept:
    """The figure as it was drawn last time; NotRun where it never was."""
    folder = results.out if (results.out / f"figures/{name}.json").exists() else results.reports
    words = folder / f"figures/{name}.json"
    reason = f"no figures/{name}.png: run the stage {stage} on its data set"
    require_file(words.with_suffix(".png"), reason, stage, runnable=False)
    return Kept(Drawing(), read_json(require_file(words, reason, stage, runnable=False)))


def as_printed(build: Callable[[Results], Figure], dataset: str, results: Results, stage: str = "lod") -> Figure:
    """The figure on the set of a protocol as printed, where that set is the first; else as it was drawn there.

    Where it never was, or of one's own meshes, it is of the first set. `build` has the figure's name.
    """
    if results.sets[:1] == [dataset]:
        figure = build(results)
        return Kept(figure.drawing, figure.words, dpi=figure.dpi)
    if not results.own_meshes:
        with suppress(NotRun):
            former = last_drawn(results, build.__name__, stage)
            results.read.add(dataset)
            return former
    return build(results)

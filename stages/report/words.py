"""Words of the report: the prose of each topic, and figures kept with their words.

TOPIC/prose.md has a section for each item, `# KIND/NAME: title`, where KIND is a folder of reports/. A table's section
is its summary, one sentence whose figures come from the table (`{this row: column}`, see `cells`), then a list of
notes. The section of a figure or chart is `Alt: text for a blind reader`, then the caption. The code fills in `{word}`.
An empty note is left out, and a note of several lines becomes several notes. TOPIC/findings.md holds the findings of a
topic, with figures from any table or claim; a paragraph with a missing figure is left out. A `Kept` figure of a data
set outside the default run stays in the repository, with its words in NAME.json.
"""

import re
from collections.abc import Callable
from contextlib import suppress
from functools import cache
from importlib import resources
from pathlib import Path
from types import ModuleType

from matplotlib.figure import Figure as Drawing

from haptic_glance.base.files import read_json, write_json

from .cells import filled
from .items import Figure, Table
from .results import NotRun, Results, there


def add_words(item: Table | Figure, topic: ModuleType, kind: str, name: str) -> None:
    """Fills in name, title, summary (not yet its figures), notes of a table; name, title, alt, caption of a figure.

    Raises KeyError where prose.md lacks the section or the item lacks a word.
    """
    title, text = _sections(topic.__name__)[f"{kind}/{name}"]
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


def findings(topic: ModuleType, reports: Path) -> list[str]:
    """The paragraphs of TOPIC/findings.md, in Markdown, with their figures; without those that lack a figure."""
    text = resources.files(topic.__name__).joinpath("findings.md").read_text(encoding="utf-8")
    paragraphs = []
    for paragraph in text.strip().split("\n\n"):
        with suppress(LookupError):
            paragraphs.append(filled(_joined(paragraph), reports)[0])
    return paragraphs


@cache
def _sections(package: str) -> dict[str, tuple[str, str]]:
    """{KIND/NAME: (title, text below it)} of a topic's prose.md."""
    text = resources.files(package).joinpath("prose.md").read_text(encoding="utf-8")
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
    there(words.with_suffix(".png"), reason, stage, runnable=False)
    return Kept(Drawing(), read_json(there(words, reason, stage, runnable=False)))


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

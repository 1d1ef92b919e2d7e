"""The words of the report: titles, notes and captions, kept as Markdown beside the code of each topic.

TOPIC/prose.md has a section for each item, `# KIND/NAME: title`, where KIND is a folder of reports/. A table's section
is its summary, one sentence whose figures come from the table (`{this row: column}`, see `cells`), then a list of
notes; that of a figure or chart is `Alt: what a blind reader needs`, then the caption. `{word}` is filled in by the
code. A note that comes out empty is left out, and one of several lines becomes as many notes. What a topic found stands
in TOPIC/findings.md, with figures from any table or claim; a paragraph that lacks one is left out.
"""

import re
from contextlib import suppress
from functools import cache
from importlib import resources
from pathlib import Path
from types import ModuleType

from .cells import filled
from .items import Figure, Table


def add_words(item: Table | Figure, topic: ModuleType, kind: str, name: str) -> None:
    """Fills in name, title, summary (not yet its figures), notes of a table; name, title, alt, caption of a figure.

    Raises KeyError where prose.md lacks the section or the item lacks a word.
    """
    title, text = _sections(topic.__name__)[f"{kind}/{name}"]
    item.name, item.title = name, title.format_map(item.words)
    if isinstance(item, Table):
        summary, *listed = re.split(r"^- ", text, flags=re.MULTILINE)
        item.summary = _joined(summary).replace("{this ", f"{{{kind}/{name} ")
        notes = (_joined(note).format_map(item.words) for note in listed)
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
    found = []
    for paragraph in text.strip().split("\n\n"):
        with suppress(LookupError):
            found.append(filled(_joined(paragraph), reports)[0])
    return found


@cache
def _sections(package: str) -> dict[str, tuple[str, str]]:
    """{KIND/NAME: (title, text below it)} of a topic's prose.md."""
    text = resources.files(package).joinpath("prose.md").read_text(encoding="utf-8")
    parts = re.split(r"^# (\S+): (.+)$", text, flags=re.MULTILINE)
    return {name: (title, text.strip()) for name, title, text in zip(*(parts[k::3] for k in (1, 2, 3)), strict=True)}


def _joined(lines: str) -> str:
    return " ".join(lines.split())

"""The claims of the report as a file of tables and as a page: sentence, verdict, measured, printed, and its limits."""

from collections.abc import Sequence
from html import escape
from importlib import resources
from pathlib import Path
from string import Template
from typing import Any

import pandas as pd

from stages.charts.html import folded, prose
from stages.charts.tables import as_text, markdown_table

from .claims import Claim
from .verdict import WORDS

CLASSES = dict(zip(WORDS, ("yes", "no", "open", "open", "open"), strict=True))  # verdict -> class in the style sheet
CHAPTERS = {  # start of a claim's section -> what it is about
    "T3": "Chapter 3: looking, and simplified meshes", "T4": "Chapter 4: touching",
    "T5": "Chapter 5: from sight to touch", "T6": "Section 6.3: proposals", "ours": "This project's own",
}  # fmt: skip
SIZES = ("as printed", "smaller", "larger", "opposite")


def counts(claims: pd.DataFrame) -> dict[str, int]:
    """{word: how many claims there are of it} in a frame of `verdict.judge`."""
    return {word: list(claims["verdict"]).count(word) for word in WORDS}


def of_thesis(claims: pd.DataFrame) -> pd.DataFrame:
    """The rows of the sentences of the thesis."""
    return claims[claims["section"] != "ours"]


def counted(claims: pd.DataFrame) -> str:
    """How many verdicts of each word there are, and how many printed effects came out as printed."""
    thesis = of_thesis(claims)
    sentences = []
    for name, frame in {"thesis": thesis, "project": claims.drop(thesis.index)}.items():
        words = ", ".join(f"{count} {word}" for word, count in counts(frame).items() if count) or "none"
        sentences.append(f"Sentences of the {name} ({len(frame)}): {words}.")
    sizes = {name: int((thesis["size"] == name).sum()) for name in SIZES}
    printed = ", ".join(f"{count} {name}" for name, count in sizes.items() if count)
    return " ".join([*sentences, f"Effects with a printed number ({sum(sizes.values())}): {printed or 'none'}."])


def claims_text(claims: pd.DataFrame) -> str:
    """The file claims.md: a table a chapter."""
    parts = ["# Claims, tested", note(), counted(claims)]
    for start, title in CHAPTERS.items():
        chapter = claims[claims["section"].str.startswith(start)]
        if len(chapter):
            shown = pd.DataFrame({
                "sentence": [f"{row.claim} ({row.section})" if start != "ours" else row.claim
                             for row in chapter.itertuples()],
                "verdict": chapter["verdict"], "measured": [effect(row) for row in chapter.itertuples()],
                "printed": chapter["printed"], "size": chapter["size"], "readings": chapter["readings"],
                "caveat": chapter["caveat"], "key": chapter["key"],
            })  # fmt: skip
            parts.append(f"## {title}\n\n{markdown_table(as_text(shown))}")
    return "\n\n".join(parts)


def note() -> str:
    """The words before the claims."""
    return (resources.files(__package__ or "") / "page/claims_note.md").read_text("utf-8").strip()


def effect(row: Any) -> str:
    """`+3.1 [1.0, 5.2] points`, or a dash; no brackets where the interval is unknown."""
    if row.effect != row.effect:
        return "–"
    has_ends = row.low == row.low
    ends = [row.low, row.high] if has_ends else [row.effect]
    places = 0 if max(map(abs, ends)) >= 100 else 1 if max(map(abs, ends)) >= 1 else 2
    while places < 6 and any(end and round(end, places) == 0 for end in ends):  # or a decided one would seem to cover 0
        places += 1
    mean, *shown = (f"{value:z.{places}f}" for value in (row.effect, *ends))
    interval = f" [{', '.join(shown)}]" if has_ends else ""
    return f"{'+' if row.effect > 0 else ''}{mean}{interval} {row.unit}"


def claims_main(known: Sequence[Claim], claims: pd.DataFrame, reports: Path) -> str:
    """The text of the page of claims below its head; reports: with the measurements that it links."""
    by_key = {claim.key: claim for claim in known}
    parts = []
    for start, title in CHAPTERS.items():
        chapter = claims[claims["section"].str.startswith(start)]
        items = "".join(_item(row, by_key[str(row.key)], start, reports) for row in chapter.itertuples())
        if items:
            tally = ", ".join(f"{count} {word}" for word, count in counts(chapter).items() if count)
            parts.append(folded(f"{title}: {tally}", f'<ul class="claims">{items}</ul>'))
    words = {
        "counted": escape(counted(claims)),
        "note": "".join(f"<p>{prose(text)}</p>" for text in note().split("\n\n")),
        "verdicts": "".join(f"<option>{word}</option>" for word in WORDS),
        "sizes": "".join(f"<option>{size}</option>" for size in SIZES),
        "chapters": "".join(parts),
    }
    return Template((resources.files(__package__ or "") / "page/claims.html").read_text("utf-8")).substitute(words)


def _item(row: Any, claim: Claim, chapter: str, reports: Path) -> str:
    """A claim that opens to its readings, caveats, data and command."""
    files = [f"measurements/{dataset}/{stage}.csv.gz" for stage, dataset in claim.files()]
    files = [file for file in files if (reports / file).exists()]
    facts = {
        "Other readings": prose(row.readings),
        "Caveat": prose(row.caveat),
        "Data": " ".join(f'<a href="../{file}" download>{file}</a>' for file in files) or "not measured",
        "Pairs": escape(f"{row.pairs} {row.over}" if row.over else ""),
        "Judged again": f"<code>python -m stages.claim {row.key}</code>",
    }
    terms = "".join(f"<dt>{name}</dt><dd>{text}</dd>" for name, text in facts.items() if text)
    printed = f" · printed {escape(row.printed)}: {row.size}" if row.size else ""
    summary = f'<span class="word {CLASSES[row.verdict]}">{row.verdict}</span> {escape(row.claim)} '
    summary += f"<small>{escape(row.section)} · {escape(effect(row))}{printed}</small>"
    marks = f'data-chapter="{chapter}" data-verdict="{row.verdict}" data-size="{row.size}"'
    return f'<li id="{row.key}" {marks}>{folded(summary, f"<dl>{terms}</dl>")}</li>\n'

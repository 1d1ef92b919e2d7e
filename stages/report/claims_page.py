"""The claims of the report as a table and as a page.

The page begins with the verdicts by chapter; each number is a link to its sentences. Below, each sentence has its
verdict, effect, data sets and command.
"""

from collections.abc import Sequence
from html import escape
from importlib import resources
from string import Template
from typing import Any

import pandas as pd

from haptic_glance.gallery.viewer import as_script
from stages.charts.commands import command
from stages.charts.datasets import dataset_text
from stages.charts.html import box, folded, prose
from stages.charts.numbers import with_interval
from stages.charts.results import Results

from .claims import Claim
from .verdict import counted, over_text, sentences, sets_text

# Verdict -> class in the style sheet.
CLASSES = {
    "supported": "yes", "contradicted": "no",
    **dict.fromkeys(("no difference", "mixed", "depends on the reading", "not testable", "open"), "open"),
}  # fmt: skip
CHAPTERS = {  # start of a claim's section -> what it is about
    "T3": "chapter 3: looking, meshes", "T4": "chapter 4: touching", "T5": "chapter 5: from sight to touch",
    "T6": "chapter 6: proposals for future work", "ours": "this project's own",
}  # fmt: skip
KINDS = {"sentence": "sentences, each once", "elsewhere": "a sentence tested elsewhere"}


def claims_shown(claims: pd.DataFrame) -> pd.DataFrame:
    """The frame of claims as a person reads it; the last column is what `python -m stages.claim` takes."""
    text_table = claims[["section", "verdict", "claim"]].copy()
    text_table["effect"] = [effect(row) for row in claims.itertuples()]
    text_table["holds"] = claims["holds"]
    text_table["tested on"] = claims["tested_on"]
    text_table["on each set"] = [sets_text(row) for row in claims.itertuples()]
    text_table["readings"] = claims["readings"]
    text_table["invalid"] = claims["validity"]
    text_table["tests elsewhere"] = claims["of"]
    text_table["pairs"] = [over_text(row) if row.pairs else "–" for row in claims.itertuples()]
    text_table["key"] = claims["key"]
    return text_table


def effect(row: Any) -> str:
    """`+3.1 [1.0, 5.2] points`, or a dash; no brackets where the interval is unknown."""
    if row.effect != row.effect:
        return "–"
    return f"{'+' if row.effect > 0 else ''}{with_interval(row.effect, row.low, row.high)} {row.unit}"


def claims_main(known: Sequence[Claim], claims: pd.DataFrame, differences: pd.DataFrame, results: Results) -> str:
    """The text of the page below its head. claims, differences: the results of `judged`."""
    by_key = {claim.key: claim for claim in known}
    items, values = [], {name: {} for name in ("chapter", "verdict", "set")} | {"kind": KINDS}
    for row in claims.itertuples():
        claim = by_key[str(row.key)]
        sets = claim.sets_read()
        chapter = chapter_of(str(row.section))
        values["chapter"][chapter] = CHAPTERS.get(chapter, chapter)
        values["verdict"][str(row.verdict).replace(" ", "-")] = str(row.verdict)
        values["set"] |= {name: dataset_text(name) for name in sets}
        rerun = command(results.workspace.root / "conf", claim.stage, sets)
        files = [name for name in sets if name in results.datasets(claim.stage)]
        items.append(_claim_html(row, claim, sets, files, chapter, rerun))
    pairs = {
        key: frame[["pair", "difference"]].to_numpy().tolist() for key, frame in differences.groupby("key", sort=False)
    }
    words = {
        "holds": what_holds(sentences(claims)),
        "counted": escape(counted(claims)),
        **{f"{name}s": _options(choices) for name, choices in values.items()},
        "claims": "".join(items),
        "pairs": as_script(pairs),
    }
    return Template(resources.files(__package__ or "").joinpath("page/claims.html").read_text("utf-8")).substitute(
        words
    )


def chapter_of(section: str) -> str:
    """The key of CHAPTERS that a section belongs to, else the section."""
    return next((start for start in CHAPTERS if section.startswith(start)), section)


def what_holds(once: pd.DataFrame) -> str:
    """A table of sentences by chapter and verdict, each number a link to its sentences. once: as `sentences`."""
    chapters = pd.Series([chapter_of(str(section)) for section in once["section"]], dtype=object)
    words = [word for word in CLASSES if (once["verdict"] == word).any()]
    masks = {"sentences": once["verdict"].notna(), **{word: once["verdict"] == word for word in words}}

    def cell(chapter: str, word: str) -> str:
        count = ((chapters == chapter) & masks[word]).sum()
        verdict = "" if word == "sentences" else f"&amp;verdict={word.replace(' ', '-')}"
        link = f'<a href="#kind=sentence&amp;chapter={chapter}{verdict}">{count}</a>' if count else "0"
        return f'<td class="number">{link}</td>'

    head = "".join(f'<th scope="col" class="number">{word}</th>' for word in masks)
    rows = "".join(
        f'<tr><th scope="row">{escape(CHAPTERS.get(chapter, chapter))}</th>'
        f"{''.join(cell(chapter, word) for word in masks)}</tr>"
        for chapter in dict.fromkeys([*CHAPTERS, *chapters])
        if (chapters == chapter).any()
    )
    title = "What holds of the thesis"
    body = f'<table><thead><tr><th scope="col">chapter</th>{head}</tr></thead><tbody>{rows}</tbody></table>'
    return f"<h2>{title}</h2>{box('scroll', title, body)}"


def _claim_html(
    row: Any, claim: Claim, sets: Sequence[str], files: Sequence[str], chapter: str, command: str
) -> str:  # fmt: skip
    """A claim that opens to what it was tested on, its data and its command; a script adds its pairs."""
    links = " ".join(
        f'<a href="../measurements/{name}/{claim.stage}.csv.gz" download>{name}/{claim.stage}.csv.gz</a>'
        for name in files
    )
    facts = {
        "Tested on": prose(row.tested_on),
        "On each set": prose(sets_text(row)),
        "Tests elsewhere": prose(f"`{row.of}`" if row.of else ""),
        "Readings": prose(row.readings),
        "Invalid": prose(row.validity),
        "Data": links if row.pairs else "not measured",
        "Holds among the claims of its chapter": row.holds,
        "Judged again from its rows": f"<code>python -m stages.claim {row.key}</code>",
        "Measured again": command and f"<code>{escape(command)}</code>",
    }
    terms = "".join(f"<dt>{name}</dt><dd>{text}</dd>" for name, text in facts.items() if text)
    pair_text = escape(over_text(row)) if row.pairs else "none"
    details = f'<dl>{terms}<dt>Pairs</dt><dd class="pairs" data-unit="{escape(row.unit)}">{pair_text}</dd></dl>'
    badge = f'<span class="word {CLASSES[row.verdict]}">{row.verdict}</span>'
    key = f" · <code>{row.key}</code>" if row.of else ""  # other claims have the same sentence
    summary = f"{badge} {escape(row.claim)} <small>{escape(row.section)} · {escape(effect(row))}{key}</small>"
    marks = f'data-chapter="{chapter}" data-verdict="{row.verdict.replace(" ", "-")}" data-set="{" ".join(sets)}"'
    marks += f' data-kind="{"elsewhere" if row.of else "sentence"}"'
    return f'<li id="{row.key}" {marks}>{folded(summary, details)}</li>\n'


def _options(choices: dict[str, str]) -> str:
    return "".join(f'<option value="{escape(value)}">{escape(text)}</option>' for value, text in choices.items())

"""The claims as people read them: a frame for Markdown, and a page that filters and opens each to what it rests on."""

from collections.abc import Sequence
from html import escape
from string import Template
from typing import Any

import pandas as pd

from .claims import Claim
from .markdown import with_interval
from .page import WORDS, folded, part, prose, script_json
from .results import Results
from .verdict import counted
from .words import dataset_text

CHAPTERS = {  # start of a claim's section -> what it is about
    "T3": "chapter 3: looking, meshes", "T4": "chapter 4: touching", "T5": "chapter 5: from sight to touch",
    "T6": "chapter 6: conclusions", "ours": "this project's own",
}  # fmt: skip
EXPERIMENTS = {("furniture", "transfer"): "experiment=transfer"}  # stages that a set runs only in an experiment


def claims_shown(claims: pd.DataFrame) -> pd.DataFrame:
    """The frame of claims as a person reads it: section, verdict, claim, effect, tested on, over."""
    shown = claims[["section", "verdict", "claim"]].copy()
    shown["effect"] = [effect(row) for row in claims.itertuples()]
    shown["holds"] = claims["holds"]
    shown["tested on"] = claims["tested_on"]
    shown["pairs"] = [f"{row.pairs} {row.over}" if row.pairs else "–" for row in claims.itertuples()]
    return shown


def effect(row: Any) -> str:
    """`+3.1 [1.0, 5.2] points`, or a dash; no brackets where the interval is unknown."""
    if row.effect != row.effect:
        return "–"
    return f"{'+' if row.effect > 0 else ''}{with_interval(row.effect, row.low, row.high)} {row.unit}"


def sets_of(claim: Claim, results: Results) -> list[str]:
    """The data sets that a claim is tested on: its own, or the first that has rows, and those that a side names."""
    own = claim.dataset or next(iter(results.datasets(claim.stage)), "")
    named = [side["dataset"] for side in (claim.first, claim.second) if isinstance(side, dict) and "dataset" in side]
    return list(dict.fromkeys(named or [own])) if own or named else []


def command(stage: str, sets: Sequence[str]) -> str:
    """What measures a claim anew."""
    chosen = next((EXPERIMENTS[name, stage] for name in sets if (name, stage) in EXPERIMENTS), None)
    switched = chosen or f"'sets=[{','.join(sets)}]'"
    return f"python -m stages.compose {switched} && dvc repro {' '.join(f'{stage}@{name}' for name in sets)} report"


def claims_main(known: Sequence[Claim], claims: pd.DataFrame, differences: pd.DataFrame, results: Results) -> str:
    """The text of the page below its head. claims, differences: what `judged` found of the claims."""
    by_key = {claim.key: claim for claim in known}
    items, values = [], {name: {} for name in ("chapter", "verdict", "set")}
    for row in claims.itertuples():
        claim = by_key[str(row.key)]
        sets = sets_of(claim, results)
        chapter = next((start for start in CHAPTERS if str(row.section).startswith(start)), str(row.section))
        values["chapter"][chapter] = CHAPTERS.get(chapter, chapter)
        values["verdict"][str(row.verdict).replace(" ", "-")] = str(row.verdict)
        values["set"] |= {name: dataset_text(name) for name in sets}
        items.append(_claim_html(row, claim, sets, chapter))
    pairs = {
        key: frame[["pair", "difference"]].to_numpy().tolist() for key, frame in differences.groupby("key", sort=False)
    }
    words = {
        "counted": escape(counted(claims)),
        **{f"{name}s": _options(found) for name, found in values.items()},
        "claims": "".join(items),
        "pairs": script_json(pairs),
    }
    return Template(part("claims.html")).substitute(words)


def _claim_html(row: Any, claim: Claim, sets: Sequence[str], chapter: str) -> str:
    """A claim that opens to what it was tested on, its data and its command; a script adds its pairs."""
    files = " ".join(
        f'<a href="../measurements/{name}/{claim.stage}.csv.gz" download>{name}/{claim.stage}.csv.gz</a>'
        for name in sets
    )
    again = f"<dt>Judged again from its rows</dt><dd><code>haptic-glance claim {row.key}</code></dd>"
    again += f"<dt>Measured again</dt><dd><code>{escape(command(claim.stage, sets))}</code></dd>" if sets else ""
    data = f"<dt>Data</dt><dd>{files if row.pairs else 'not measured'}</dd>"
    data += f"<dt>Holds among the claims of its chapter</dt><dd>{row.holds}</dd>" if row.holds else ""
    over = f"{row.pairs} {row.over}" if row.pairs else "none"
    more = (
        f"<dl><dt>Tested on</dt><dd>{prose(row.tested_on)}</dd>{data}{again}"
        f'<dt>Pairs</dt><dd class="pairs" data-unit="{escape(row.unit)}">{escape(over)}</dd></dl>'
    )
    badge = f'<span class="word {WORDS[row.verdict]}">{row.verdict}</span>'
    summary = f"{badge} {escape(row.claim)} <small>{escape(row.section)} · {escape(effect(row))}</small>"
    marks = f'data-chapter="{chapter}" data-verdict="{row.verdict.replace(" ", "-")}" data-set="{" ".join(sets)}"'
    return f'<li id="{row.key}" {marks}>{folded(summary, more)}</li>\n'


def _options(found: dict[str, str]) -> str:
    return "".join(f'<option value="{escape(value)}">{escape(text)}</option>' for value, text in found.items())

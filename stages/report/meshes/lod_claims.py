"""The claims on simplified meshes, judged on every data set beside each other."""

from dataclasses import replace

import pandas as pd

from stages.report.claims import Claim
from stages.report.items import Table
from stages.report.markdown import signed
from stages.report.results import Results
from stages.report.verdict import judge
from stages.report.words import dataset_text

from . import claims_channels, claims_weights
from .rows import data_sets

CLAIMS = [*claims_channels.CLAIMS, *claims_weights.CLAIMS]
WORDS = {"supported": "yes", "contradicted": "no", "open": "open"}
NOTES = [
    "Each cell: the word (yes: the 95 % interval over the objects lies wholly on the claimed side; no: on the other; "
    "open: it covers zero), the mean, the interval and the number of objects. What is compared: claims.md.",
    "Nothing shrunk: only face counts at which none of the compared methods had to shrink its neighbourhoods; that is "
    "the thesis's own algorithm.",
    "The meshes of psb have up to 55,644 faces, those with gaze about 40,000, as the thesis's benchmark has: there "
    "3,000 and 1,500 faces are deeper cuts than on the household objects.",
]


def build(results: Results) -> Table:
    """One row per claim, one column per data set, and the first set again where nothing shrank."""
    sets = data_sets(results)
    parts = {dataset_text(name): _judged(results, name, {}) for name in sets}
    parts[f"{dataset_text(sets[0])}, nothing shrunk"] = _judged(results, sets[0], {"shrunk": False})
    shown = pd.DataFrame({"section": [one.section for one in CLAIMS], "claim": [one.sentence for one in CLAIMS]})
    for head, part in parts.items():
        shown[head] = [_cell(row) for row in part.itertuples()]
    shown["unit"] = [one.unit for one in CLAIMS]
    frame = pd.concat([part.assign(data=head) for head, part in parts.items()])
    frame = frame.rename(columns={"pairs": "objects"})
    frame = frame[["key", "data", "verdict", "effect", "low", "high", "objects"]].sort_values("key", kind="stable")
    return Table("Claims on simplified meshes, by data set", frame, NOTES, shown)


def _judged(results: Results, dataset: str, where: dict) -> pd.DataFrame:
    own: list[Claim] = [replace(claim, dataset=dataset, where={**claim.where, **where}) for claim in CLAIMS]
    return judge(own, results)


def _cell(row) -> str:
    """`yes: +0.83 [0.61, 1.05] (50)`: the effect with sign to three digits."""
    if not row.pairs:
        return "not run"
    mean = row.effect
    places = max(0, 2 - int(f"{mean:e}".split("e")[1])) if mean and mean == mean else 2
    return f"{WORDS[row.verdict]}: {signed(mean, row.low, row.high, min(places, 7))} ({row.pairs})"

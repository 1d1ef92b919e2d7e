"""The claims on simplified meshes, judged on every data set beside each other."""

from dataclasses import replace
from typing import Any

import pandas as pd

from stages.report.items import Table
from stages.report.markdown import signed
from stages.report.results import Results
from stages.report.verdict import judge
from stages.report.words import dataset_text

from .claims import CLAIMS
from .rows import data_sets

WORDS = {"supported": "yes", "contradicted": "no", "open": "open"}


def build(results: Results) -> Table:
    """One row per claim, one column per data set, and the first set again where nothing shrank."""
    sets = data_sets(results)
    wanted = {dataset_text(name): (name, {}) for name in sets}
    wanted[f"{dataset_text(sets[0])}, nothing shrunk"] = sets[0], {"shrunk": False}
    parts = {
        head: judge([replace(claim, dataset=name, where={**claim.where, **where}) for claim in CLAIMS], results)
        for head, (name, where) in wanted.items()
    }
    shown = pd.DataFrame({
        "section": [claim.section for claim in CLAIMS], "claim": [claim.sentence for claim in CLAIMS],
        **{head: [_cell(row) for row in part.itertuples()] for head, part in parts.items()},
        "unit": [claim.unit for claim in CLAIMS],
    })  # fmt: skip
    frame = pd.concat([part.assign(data=head) for head, part in parts.items()])
    frame = frame.rename(columns={"pairs": "objects"})
    frame = frame[["key", "data", "verdict", "effect", "low", "high", "objects"]].sort_values("key", kind="stable")
    return Table(frame, shown)


def _cell(row: Any) -> str:
    """`yes: +0.83 [0.61, 1.05] (50)`: the effect with sign to three digits."""
    if not row.pairs:
        return "not run"
    mean = row.effect
    places = max(0, 2 - int(f"{mean:e}".split("e")[1])) if mean and mean == mean else 2
    return f"{WORDS[row.verdict]}: {signed(mean, row.low, row.high, min(places, 7))} ({row.pairs})"

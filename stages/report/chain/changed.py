"""What the choice at each stage costs: from the smallest choice, each other option alone."""

from typing import Any

import pandas as pd

from stages.report.items import Table
from stages.report.markdown import signed
from stages.report.results import Results
from stages.report.style import label

from .rows import CHANGED, CHOICES, CONFIRMED, SPLITS, brief, effect, front_rows, named, words

STAGES = {
    "method": "who chooses the places", "viewpoints": "viewpoints", "image_rows": "rows of an image",
    "points": "places", "cells": "sensels a side", "level": "faces of the model", "touches": "touches of an answer",
    "classifier": "classifier",
}  # fmt: skip


def table(results: Results) -> Table:
    """One row for each option: what changes, the effect on both accuracies with its interval, and the seconds."""
    rows = front_rows(results)
    base = rows[(rows["rung"] == CONFIRMED) & (rows["number"] == named(rows, "smallest"))]
    first, lines = base.iloc[0], []
    for _, own in rows[rows["rung"] == CHANGED].groupby("number"):
        stage = next(name for name in CHOICES if not _same(own.iloc[0][name], first[name]))
        line: dict[str, Any] = {"stage": stage, "option": own.iloc[0][stage], "from": first[stage]}
        for split, name in SPLITS.items():
            line |= zip((name, f"{name}_low", f"{name}_high"), effect(base, own, split), strict=True)
        line["times"] = own["seconds"].mean() / base["seconds"].mean()
        lines.append(line | {"seconds": own["seconds"].mean(), "faces": own["faces"].mean()})
    frame = pd.DataFrame(lines).sort_values("stage", key=lambda own: own.map(CHOICES.index), kind="stable")
    return Table(frame, _shown(frame), {"words": words(first), "seconds": brief(1000 * base["seconds"].mean())})


def _same(one, other):
    return one == other or (pd.isna(one) and pd.isna(other))


def _shown(frame: pd.DataFrame) -> pd.DataFrame:
    effects = {
        words: [signed(row[name], row[f"{name}_low"], row[f"{name}_high"], 0) for _, row in frame.iterrows()]
        for name, words in (("regions", "unseen regions, points"), ("objects", "unseen objects, points"))
    }
    said = [f"{_option(row['option'])} instead of {_option(row['from'])}" for _, row in frame.iterrows()]
    times = [f"{brief(value)} times" for value in frame["times"]]
    return pd.DataFrame({"stage": frame["stage"].map(STAGES), "option": said, **effects, "seconds": times})


def _option(value):
    return label(value) if isinstance(value, str) else f"{value:.0f}"

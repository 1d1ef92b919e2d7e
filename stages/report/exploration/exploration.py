"""How many touches it takes to be sure: stopping at a confidence beside a fixed number of touches."""

from typing import Any

import numpy as np
import pandas as pd

from stages.kit.split import shared_by
from stages.report.grid import records, within
from stages.report.items import Table
from stages.report.markdown import number, with_interval
from stages.report.results import Results
from stages.report.style import label

from .rows import HEADLINE, HELD_OUT, LIKELIHOODS, STAGE, WAYS, needed

KEYS = ["group", "split", "likelihood", "method", "way"]


def build(results: Results) -> Table:
    """Touches until sure, and how often that is right, by the way to choose the next place."""
    rows = results.measured(STAGE, metric=["accuracy", "accuracy_decided"])
    frame = pd.DataFrame([_line(key, group) for key, group in rows.groupby(KEYS, sort=False)])
    most = ", ".join(f"{value}" for value in sorted(set(frame["most"])))
    words = {"headline": f"{100 * HEADLINE:.0f} %", "most": most, "not_run": results.left_out(STAGE)}
    return Table(frame, _wide(frame, results), words)


def _line(key: Any, rows: pd.DataFrame) -> dict[str, Any]:
    """The tidy row of one way of exploring."""
    line: dict[str, Any] = dict(zip(KEYS, key, strict=True))
    most = int(rows.loc[rows["stop"] == "fixed", "level"].max())
    right = rows["metric"] == "accuracy"
    stopped = rows[right & (rows["stop"] == "confidence") & np.isclose(rows["level"], HEADLINE)]
    for name, column in (("accuracy", "value"), ("touches", "touches"), ("stated", "belief"), ("decided", "decided")):
        ends = (1.0, most) if name == "touches" else (0.0, 1.0)
        found = within(stopped[column], shared_by(line["split"]), *ends)
        line |= zip((name, f"{name}_low", f"{name}_high"), found, strict=True)
    return line | {"fixed": needed(rows, line["accuracy"]), "most": most, "repetitions": len(stopped)}


def _wide(frame: pd.DataFrame, results: Results) -> pd.DataFrame:
    lines = []
    for _, group in frame.groupby(KEYS[:-1], sort=False):
        ways = {row.way: row for row in records(group)}
        plain = ways["random"]
        lines.append({
            "objects": results.group_text(plain.group), "held out": HELD_OUT[plain.split],
            "belief": LIKELIHOODS[plain.likelihood], "touched": label(plain.method),
            **{words: _cell(ways[way]) if way in ways else "–" for way, words in WAYS.items()},
            "a fixed number, in random order": "never" if np.isnan(plain.fixed) else number(plain.fixed, 2),
            "stated": f"{100 * plain.stated:.0f} %", "decided": f"{100 * plain.decided:.0f} %",
        })  # fmt: skip
    return pd.DataFrame(lines)


def _cell(row: Any) -> str:
    touches = with_interval(row.touches, row.touches_low, row.touches_high, places=1)
    return f"{touches}: {with_interval(row.accuracy, row.accuracy_low, row.accuracy_high, 100, 0)} %"

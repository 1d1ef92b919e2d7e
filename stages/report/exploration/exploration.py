"""How many touches it takes to be sure: stopping at a confidence beside a fixed number of touches."""

from collections.abc import Sequence

import numpy as np
import pandas as pd

from stages.kit.split import shared_by
from stages.report.grid import within
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


def _line(key: Sequence[str], rows: pd.DataFrame) -> dict:
    """The tidy row of one way of exploring."""
    line, most = dict(zip(KEYS, key, strict=True)), int(rows.loc[rows["stop"] == "fixed", "level"].max())
    right = rows["metric"] == "accuracy"
    stopped = rows[right & (rows["stop"] == "confidence") & np.isclose(rows["level"], HEADLINE)]
    for name, column in (("accuracy", "value"), ("touches", "touches"), ("stated", "belief"), ("decided", "decided")):
        ends = (1.0, most) if name == "touches" else (0.0, 1.0)
        found = within(stopped[column], shared_by(line["split"]), *ends)
        line |= zip((name, f"{name}_low", f"{name}_high"), found, strict=True)
    return line | {"fixed": needed(rows, line["accuracy"]), "most": most, "repetitions": len(stopped)}


def _wide(frame: pd.DataFrame, results: Results) -> pd.DataFrame:
    lines = []
    for (objects, split, likelihood, method), group in frame.groupby(KEYS[:-1], sort=False):
        ways = group.set_index("way").to_dict("index")
        line = {"objects": results.group_text(objects), "held out": HELD_OUT[split], "belief": LIKELIHOODS[likelihood]}
        cells = {words: _cell(ways[way]) if way in ways else "–" for way, words in WAYS.items()}
        plain = ways["random"]
        cells["a fixed number, in random order"] = "never" if np.isnan(plain["fixed"]) else number(plain["fixed"], 2)
        cells |= {name: f"{100 * plain[name]:.0f} %" for name in ("stated", "decided")}
        lines.append(line | {"touched": label(method)} | cells)
    return pd.DataFrame(lines)


def _cell(row: dict[str, float]) -> str:
    touches = with_interval(row["touches"], row["touches_low"], row["touches_high"], places=1)
    return f"{touches}: {with_interval(row['accuracy'], row['accuracy_low'], row['accuracy_high'], 100, 0)} %"

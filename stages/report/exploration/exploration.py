"""How many touches it takes to be sure: stopping at a confidence beside a fixed number of touches."""

import numpy as np
import pandas as pd

from stages.kit.split import shared_by
from stages.kit.stats import interval
from stages.report.items import Table
from stages.report.markdown import number, with_interval
from stages.report.results import Results
from stages.report.style import label

from .rows import HEADLINE, HELD_OUT, LIKELIHOODS, STAGE, WAYS, at_confidence, needed

KEYS = ["group", "split", "likelihood", "method", "way"]


def build(results: Results) -> Table:
    """Touches until sure, and how often that is right, by the way to choose the next place."""
    rows = results.measured(STAGE, metric=["accuracy", "accuracy_decided"])
    frame = pd.DataFrame([_line(key, group) for key, group in rows.groupby(KEYS, sort=False)])
    most = ", ".join(f"{value}" for value in sorted(set(frame["most"])))
    not_run = "\n".join(f"Not run: {note}." for note in results.notes(STAGE))
    return Table(
        frame, _wide(frame, results), {"headline": f"{100 * HEADLINE:.0f} %", "most": most, "not_run": not_run}
    )


def _line(key, rows):
    """The tidy row of one way of exploring."""
    stopped, values = at_confidence(rows, HEADLINE), {}
    most = int(rows.loc[rows["stop"] == "fixed", "level"].max())
    for name, column in (("accuracy", "value"), ("touches", "touches"), ("stated", "belief"), ("decided", "decided")):
        mean, low, high = interval(stopped[column], shared_by(rows["split"].iloc[0]))
        least, top = (1.0, most) if name == "touches" else (0.0, 1.0)
        values |= {name: mean, f"{name}_low": np.maximum(low, least), f"{name}_high": np.minimum(high, top)}
    fixed = needed(rows, values["accuracy"])
    return dict(zip(KEYS, key, strict=True)) | values | {"fixed": fixed, "most": most, "repetitions": len(stopped)}


def _wide(frame, results):
    lines = []
    for (objects, *key), group in frame.groupby(KEYS[:-1], sort=False):
        split, likelihood, method = key
        by_way = group.set_index("way").to_dict("index")
        line = {"objects": results.group_text(objects), "held out": HELD_OUT[split], "belief": LIKELIHOODS[likelihood]}
        line |= {"touched": label(method)} | {words: _cell(by_way.get(way)) for way, words in WAYS.items()}
        plain = by_way["random"]
        line["a fixed number, in random order"] = "never" if np.isnan(plain["fixed"]) else number(plain["fixed"], 2)
        lines.append(line | {name: f"{100 * plain[name]:.0f} %" for name in ("stated", "decided")})
    return pd.DataFrame(lines)


def _cell(row):
    if row is None:
        return "–"
    touches = with_interval(row["touches"], row["touches_low"], row["touches_high"], places=1)
    return f"{touches}: {with_interval(row['accuracy'], row['accuracy_low'], row['accuracy_high'], 100, 0)} %"

"""How many touches it takes to be sure: stopping at a confidence beside a fixed number of touches."""

from typing import Any

import numpy as np
import pandas as pd

from haptic_glance.know.split import Split, shared_by
from stages.report.grid import grouped, percent, records, within
from stages.report.items import Table
from stages.report.markdown import number, with_interval
from stages.report.results import Results
from stages.report.style import label

STAGE, GROUP = "exploration", "six"
WAYS = {"gain": "where the belief gains most", "saliency": "most salient first", "random": "in random order"}
LIKELIHOODS = {
    "imprint": "by imprints",
    "imprint_place": "by imprints and places",
    "imprint_product": "by imprints, as if independent",
}
HELD_OUT = {Split.RANDOM: "at random", Split.REGIONS: "unseen regions"}
HEADLINE = 0.95  # belief at which the table and the claims stop
COLUMNS = {"accuracy": "value", "touches": "touches", "stated": "belief", "decided": "decided"}
HIDDEN = ("stated, %", "decided, %")  # columns that do not answer the question
KEYS = ["group", "split", "likelihood", "method", "way"]


def build(results: Results) -> Table:
    """Touches until sure, and how often that is right, by the way to choose the next place."""
    rows, lines = results.measured(STAGE, metric=["accuracy", "accuracy_decided"]), []
    for key, group in grouped(rows, KEYS):
        line: dict[str, Any] = dict(zip(KEYS, key, strict=True))
        most = int(group.loc[group["stop"] == "fixed", "level"].max())
        sure = (group["stop"] == "confidence") & np.isclose(group["level"], HEADLINE)
        stopped = group[sure & (group["metric"] == "accuracy")]
        for name, column in COLUMNS.items():
            ends = (1.0, most) if name == "touches" else (0.0, 1.0)
            found = within(stopped[column], shared_by(line["split"]), *ends)
            line |= zip((name, f"{name}_low", f"{name}_high"), found, strict=True)
        lines.append(line | {"fixed": needed(group, line["accuracy"]), "most": most, "repetitions": len(stopped)})
    frame = pd.DataFrame(lines)
    most = ", ".join(map(str, sorted(set(frame["most"]))))
    words = {"headline": f"{100 * HEADLINE:.0f} %", "most": most, "not_run": results.left_out(STAGE)}
    shown = _wide(frame, results)
    # no ranking: fewer touches stand against more right answers, as the chart shows
    return Table(frame, shown, words, answer=[name for name in map(str, shown) if name not in HIDDEN])


def _wide(frame: pd.DataFrame, results: Results) -> pd.DataFrame:
    """A row a setting and way, the ways of a setting in the order of WAYS."""
    order = dict(zip(WAYS, range(len(WAYS)), strict=True))
    settings = frame.groupby(KEYS[:-1], sort=False).ngroup()
    ordered = frame.assign(setting=settings, order=frame["way"].map(order)).sort_values(["setting", "order"])
    return pd.DataFrame([
        {
            "objects": results.group_text(row.group), "held out": HELD_OUT[row.split],
            "belief": LIKELIHOODS[row.likelihood], "touched": label(row.method), "next place": WAYS[row.way],
            "touches": with_interval(row.touches, row.touches_low, row.touches_high, places=1),
            "right, %": with_interval(row.accuracy, row.accuracy_low, row.accuracy_high, 100, 0),
            "fixed number": "never" if np.isnan(row.fixed) else number(row.fixed, 2),
            "stated, %": percent(row.stated), "decided, %": percent(row.decided),
        }
        for row in records(ordered)
    ])  # fmt: skip


def curves(rows: pd.DataFrame) -> pd.DataFrame:
    """Frame indexed by (repetition, touches): accuracy after a fixed number of touches."""
    fixed = rows[(rows["stop"] == "fixed") & (rows["metric"] == "accuracy")]
    return fixed.pivot(index="repetition", columns="level", values="value")


def needed(rows: pd.DataFrame, accuracy: float) -> float:
    """Touches after which the mean accuracy of a fixed number reaches `accuracy`, interpolated; NaN if never."""
    curve = curves(rows).mean()
    reached = np.flatnonzero(curve >= accuracy)
    if len(reached) == 0:
        return np.nan
    last = curve.iloc[max(reached[0] - 1, 0) : reached[0] + 1]  # the step that reaches it, or the first touch
    return float(np.interp(accuracy, last, last.index))

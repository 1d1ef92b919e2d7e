"""Several touches: how many it takes, where to touch next, and whether a stated belief is right."""

from typing import Any

import numpy as np
import pandas as pd

from haptic_glance.know.split import Split, shared_by
from stages.charts.drawing import CYCLE, GREY, label, plt
from stages.charts.items import Figure, Table
from stages.charts.results import Results
from stages.charts.tables import grouped, interval_columns, interval_text, number, percent, records, within

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
        is_headline = (group["stop"] == "confidence") & np.isclose(group["level"], HEADLINE)
        stopped = group[is_headline & (group["metric"] == "accuracy")]
        for name, column in COLUMNS.items():
            ends = (1.0, most) if name == "touches" else (0.0, 1.0)
            line |= interval_columns(name, within(stopped[column], shared_by(line["split"]), *ends))
        lines.append(line | {"fixed": needed(group, line["accuracy"]), "most": most, "repetitions": len(stopped)})
    frame = pd.DataFrame(lines)
    most = ", ".join(map(str, sorted(set(frame["most"]))))
    words = {"headline": f"{100 * HEADLINE:.0f} %", "most": most, "not_run": results.left_out(STAGE)}
    text_table = _wide(frame, results)
    # no ranking: fewer touches stand against more right answers
    return Table(frame, text_table, words, answer=[name for name in map(str, text_table) if name not in HIDDEN])


def _wide(frame: pd.DataFrame, results: Results) -> pd.DataFrame:
    """A row a setting and way, the ways of a setting in the order of WAYS."""
    order = dict(zip(WAYS, range(len(WAYS)), strict=True))
    settings = frame.groupby(KEYS[:-1], sort=False).ngroup()
    ordered = frame.assign(setting=settings, order=frame["way"].map(order)).sort_values(["setting", "order"])
    return pd.DataFrame([
        {
            "objects": results.group_text(row.group), "held out": HELD_OUT[row.split],
            "belief": LIKELIHOODS[row.likelihood], "touched": label(row.method), "next place": WAYS[row.way],
            "touches": interval_text(row, "touches", places=1),
            "right, %": interval_text(row, "accuracy", 100, 0),
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
    places = np.flatnonzero(curve >= accuracy)
    if len(places) == 0:
        return np.nan
    last = curve.iloc[max(places[0] - 1, 0) : places[0] + 1]  # the step that reaches it, or the first touch
    return float(np.interp(accuracy, last, last.index))


LINES = {"imprint": ("-", "o"), "imprint_product": (":", "^")}


def _points(rows: pd.DataFrame, by: list[str]) -> pd.DataFrame:
    """Accuracy with its interval, mean touches and stated belief, one row for each combination of columns `by`."""
    points = []
    for key, group in grouped(rows, by):
        accuracy = within(group["value"], shared_by(group["split"].iloc[0]))
        points.append((*key, group["touches"].mean(), group["belief"].mean(), *accuracy))
    return pd.DataFrame(points, columns=[*by, "touches", "stated", "accuracy", "low", "high"])


def calibration(results: Results) -> Figure:
    """Accuracy against stated belief, for a fixed number of touches in random order: a panel a split and a method."""
    rows = results.measured(STAGE, group=GROUP, way="random", stop="fixed", metric="accuracy")
    frame = _points(rows, ["split", "likelihood", "method", "level"]).sort_values("level")
    methods = list(dict.fromkeys(rows["method"]))
    figure, grid = plt.subplots(
        len(HELD_OUT), len(methods), figsize=(2.9 * len(methods) + 0.4, 3.1 * len(HELD_OUT) + 0.5), squeeze=False,
        sharex=True, sharey=True, layout="constrained",
    )  # fmt: skip
    for line, split in zip(grid, HELD_OUT, strict=True):
        for axes, method in zip(line, methods, strict=True):
            axes.plot([0, 1], [0, 1], color=GREY, lw=0.8)
            for (likelihood, (dash, mark)), tint in zip(LINES.items(), CYCLE, strict=False):
                points = frame[(frame[["split", "likelihood", "method"]] == (split, likelihood, method)).all(axis=1)]
                axes.vlines(points["stated"], points["low"], points["high"], color=tint, lw=0.8, alpha=0.25)
                axes.plot(points["stated"], points["accuracy"], dash, marker=mark, ms=4, lw=1.3, color=tint,
                          label=LIKELIHOODS[likelihood])  # fmt: skip
            axes.set(xlim=(0.3, 1.0), ylim=(0.3, 1.0), aspect="equal")
            axes.grid()
        line[0].set_ylabel(f"rate of right answers\n{HELD_OUT[split]}")
    for above, below, method in zip(grid[0], grid[-1], methods, strict=True):
        above.set_title(label(method), fontsize=10)
        below.set_xlabel("stated belief")
    handles, names = grid[0, 0].get_legend_handles_labels()
    figure.legend(handles, names, loc="outside lower center", ncol=len(LINES), title="belief")
    figure.suptitle("\n".join(_honesty(frame)), x=0.01, ha="left", fontsize=11, fontweight="bold")
    return Figure(figure, {"most": int(rows["level"].max()), "group": results.group_text(GROUP)})


def _honesty(frame: pd.DataFrame) -> list[str]:
    """For each split, by how many points the belief by imprints lies beside the rate of right answers, on average."""
    lines = []
    for split, words in HELD_OUT.items():
        beliefs = frame[(frame["split"] == split) & (frame["likelihood"] == "imprint")]
        points = 100 * (beliefs["stated"] - beliefs["accuracy"]).mean()
        way = "too careful" if points < 0 else "too sure"
        unit = "point" if f"{abs(points):.0f}" == "1" else "points"
        lines.append(f"{str(words).capitalize()}: {abs(points):.0f} {unit} {way} on average")
    return lines


PAGE = "exploration"
TABLES = {"exploration": build}
FIGURES = {"exploration_calibration": calibration}
CHARTS = {}

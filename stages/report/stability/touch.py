"""Where recognition by touch breaks: the severity of each perturbation at which half of its lead is lost."""

from collections.abc import Sequence

import numpy as np
import pandas as pd
from matplotlib.axes import Axes

from stages.kit.breaking_point import breaking_point, lead_left
from stages.kit.split import shared_by
from stages.kit.stats import interval
from stages.report.grid import grouped
from stages.report.items import Figure, Table
from stages.report.results import Results
from stages.report.style import GREY, MARKERS, label
from stages.touch_stability import CLEAN, PERTURBATIONS

from .panels import add_legend, breaking_text, draw_line, finish, panels

STAGE = "touch_stability"
KEYS = ["split", "features", "classifier"]
LINES = {  # (split, features, classifier): how a person says it
    ("random", "imprint", "knn"): "kNN",
    ("regions", "imprint", "knn"): "kNN, unseen regions",
    ("random", "imprint", "svm"): "SVM",
    ("random", "imprint_place", "knn"): "kNN with places",
}
TINTS = ("#0072B2", "#56B4E9", "#D55E00", "#009E73")
ENOUGH = 0.02  # accuracy that may be lost before it is said to suffer
COLUMNS = ["perturbation", "unit", *KEYS, "breaking_point", "low", "high", "harmless", "harshest", "accuracy"]


def curve(rows: pd.DataFrame, perturbation: str, line: Sequence[str]) -> pd.DataFrame:
    """Frame by severity, from mild to harsh: accuracy, left, each with low and high; empty where it was not measured.

    left: what is left of the lead over guessing. The intervals are over the repetitions, widened for what they share.
    """
    mine = rows.loc[rows[KEYS].eq(list(line)).all(axis=1)].set_index("repetition")
    clean, mine = (mine.loc[mine["perturbation"] == name] for name in (CLEAN, perturbation))
    found = []
    for (severity,), group in grouped(mine, ["severity"]) if len(clean) else ():
        left = lead_left(group["value"], clean["value"].mean(), mine["chance"].iloc[0])
        point = {"severity": severity, "clean": clean["value"].mean(), "lost": (clean["value"] - group["value"]).mean()}
        for name, scores in (("accuracy", group["value"]), ("left", left)):
            ends = interval(scores, shared_by(line[0]))
            point |= dict(zip((name, f"{name}_low", f"{name}_high"), ends, strict=True))
        found.append(point)
    order = sorted(found, key=lambda point: abs(point["severity"] - PERTURBATIONS[perturbation].unharmed))
    return pd.DataFrame(order)


def breaking(points: pd.DataFrame, perturbation: str) -> tuple[float, ...]:
    """(severity at which half of the lead is lost, and for the low and the high end of the interval); NaN: beyond."""
    ends = [points[name].fillna(points["left"]) for name in ("left", "left_low", "left_high")]
    unharmed = PERTURBATIONS[perturbation].unharmed
    return tuple(breaking_point(list(points["severity"]), list(end), unharmed) for end in ends)


def harmless(points: pd.DataFrame) -> float:
    """The harshest severity up to which at most ENOUGH of accuracy is lost on average; NaN if none."""
    kept = points.loc[(points["lost"] <= ENOUGH).cumprod().astype(bool), "severity"]
    return float(kept.iloc[-1]) if len(kept) else float("nan")


def table(results: Results) -> Table:
    """Breaking points by classifier; what was not measured, or has no lead to lose, is left out."""
    rows, found, shown = results.measured(STAGE, metric="accuracy"), [], []
    for name in dict.fromkeys(rows.loc[rows["perturbation"] != CLEAN, "perturbation"]):
        known, cells, fine = PERTURBATIONS[name], {}, []
        for line, words in LINES.items():
            points = curve(rows, name, line)
            if points.empty or points["left"].isna().all():
                continue
            ends, harshest = breaking(points, name), points["severity"].iloc[-1]
            fine.append(harmless(points))
            found.append((name, known.unit, *line, *ends, fine[-1], harshest, points["accuracy"].iloc[-1]))
            cells[f"{words} breaks at"] = breaking_text(ends, harshest, known.unharmed)
        if cells:
            unknown = {f"{words} breaks at": "–" for words in LINES.values()}
            harm = {"harmless to kNN": "none" if np.isnan(fine[0]) else f"{fine[0]:g}"}
            shown.append({"perturbation": label(name), "unit": known.unit} | unknown | cells | harm)
    clean = {key: group["value"].mean() for key, group in grouped(rows.loc[rows["perturbation"] == CLEAN], KEYS)}
    said = [f"{words} {100 * clean[line]:.0f} %" for line, words in LINES.items() if line in clean]
    objects = results.group_text(rows["group"].iloc[0])
    words = {
        "points": 100 * ENOUGH, "objects": objects[:1].upper() + objects[1:], "method": label(rows["method"].iloc[0]),
        "clean": ", ".join(said), "guessing": 100 * rows["chance"].iloc[0], "not_run": results.left_out(STAGE),
    }  # fmt: skip
    return Table(pd.DataFrame(found, columns=COLUMNS), pd.DataFrame(shown), words)


def figure(results: Results) -> Figure:
    """Accuracy against severity: a panel a perturbation, a line a classifier, a cross where it breaks."""
    rows = results.measured(STAGE, metric="accuracy")
    found = [one for one in PERTURBATIONS if one in set(rows["perturbation"])]
    chance = rows["chance"].iloc[0]
    drawing, grid, legend = panels(found, "accuracy, %", 10.2, 2.3)
    for perturbation, axes in grid.items():
        ticks = []
        for kind, tint, mark in zip(LINES, TINTS, MARKERS, strict=False):
            points = curve(rows, perturbation, kind)
            if len(points):
                ticks = max(ticks, list(points["severity"]), key=len)
                _draw(axes, points, perturbation, tint, mark)
        axes.axhline(100 * chance, color=GREY, lw=1.2, ls=":")
        finish(axes, perturbation, PERTURBATIONS[perturbation].unit, ticks)
    marks = zip(LINES.values(), TINTS, MARKERS, strict=False)
    lines = {words: {"color": tint, "marker": mark, "ms": 4, "lw": 1.4} for words, tint, mark in marks}
    cross = {"ls": "", "marker": "x", "color": GREY, "ms": 7}
    add_legend(drawing, legend, lines | {"half of the lead lost": cross})
    words = {"perturbations": len(found), "classifiers": ", ".join(LINES.values())}
    words |= {"objects": results.group_text(rows["group"].iloc[0]), "method": label(rows["method"].iloc[0])}
    return Figure(drawing, words)


def _draw(axes: Axes, points: pd.DataFrame, perturbation: str, tint: str, mark: str) -> None:
    """One line with its intervals and its cross."""
    undisturbed = [points["clean"].iloc[0], np.nan, np.nan]
    values = np.vstack([undisturbed, points[["accuracy", "accuracy_low", "accuracy_high"]]])
    draw_line(axes, values, tint, mark)
    at = breaking(points, perturbation)[0]
    if np.isfinite(at):
        steps = np.array([PERTURBATIONS[perturbation].unharmed, *points["severity"]])
        sign, places = np.sign(steps[-1] - steps[0]), np.arange(len(steps))  # np.interp needs what rises
        where = np.interp(sign * at, sign * steps, places)
        height = np.interp(where, places, 100 * values[:, 0])
        axes.plot(where, height, "x", color=tint, ms=7, mew=1.8, zorder=4)

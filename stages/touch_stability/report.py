"""Breaking points of recognition by touch: the severity of each perturbation at which half of its lead is lost.

The lead is the accuracy above guessing.
"""

from collections.abc import Sequence

import numpy as np
import pandas as pd

from haptic_glance.disturb.touch_disturbances import TOUCH_PERTURBATIONS
from haptic_glance.know.split import shared_by
from stages.charts.breaking import ACCURACY, Curves, broken, degradation
from stages.charts.drawing import GREY, MARKERS, label
from stages.charts.items import Figure, Table
from stages.charts.results import Results
from stages.charts.tables import grouped
from stages.engine.statistics import breaking_point, interval, lead_left
from stages.touch_stability.disturbed_trials import CLEAN

STAGE = "touch_stability"
DENOISED = "household_denoised"  # the set whose touches are also denoised
DENOISERS = {"": "", "_autoencoder": "after an autoencoder"}  # behind `imprint`
KEYS = ["split", "features", "classifier"]
PLAIN = "imprint"
LINES = {  # (split, features, classifier): how a person says it
    ("random", "imprint", "knn"): "kNN",
    ("regions", "imprint", "knn"): "kNN, unseen regions",
    ("random", "imprint", "svm"): "SVM",
    ("random", "imprint_place", "knn"): "kNN with places",
}
TINTS = ("#0072B2", "#56B4E9", "#D55E00", "#009E73")
UNITS = {name: entry.unit for name, entry in TOUCH_PERTURBATIONS.items()}
UNHARMED = {name: entry.unharmed for name, entry in TOUCH_PERTURBATIONS.items()}
ENOUGH = 0.02  # accuracy that may be lost before it is said to suffer
COLUMNS = ["perturbation", "unit", *KEYS, "breaking_point", "low", "high", "harmless", "harshest", "accuracy"]
LEFT = ["left", "left_low", "left_high"]


def curve(rows: pd.DataFrame, perturbation: str, line: Sequence[str]) -> pd.DataFrame:
    """Frame by severity, from mild to harsh: clean, lost, ACCURACY and LEFT; empty where it was not measured.

    left: what is left of the lead over guessing. The intervals are over the repetitions, widened for what they share.
    """
    runs = rows.loc[rows[KEYS].eq(list(line)).all(axis=1)].set_index("repetition")
    clean, runs = (runs.loc[runs["perturbation"] == name] for name in (CLEAN, perturbation))
    points, whole, share = [], clean["value"].mean(), shared_by(line[0])
    for (severity,), group in grouped(runs, ["severity"]):
        losses, left = clean["value"] - group["value"], lead_left(group["value"], whole, runs["chance"].iloc[0])
        points.append((severity, whole, losses.mean(), *interval(group["value"], share), *interval(left, share)))
    points.sort(key=lambda point: abs(point[0] - UNHARMED[perturbation]))
    return pd.DataFrame(points, columns=["severity", "clean", "lost", *ACCURACY, *LEFT])


def breaking(points: pd.DataFrame, perturbation: str) -> tuple[float, ...]:
    """(severity at which half of the lead is lost, and for the low and the high end of the interval); NaN: beyond."""
    ends = [list(points[name].fillna(points["left"])) for name in LEFT]
    return tuple(breaking_point(list(points["severity"]), end, UNHARMED[perturbation]) for end in ends)


def harmless(points: pd.DataFrame) -> float:
    """The harshest severity up to which at most ENOUGH of accuracy is lost on average; NaN if none."""
    mild = points.loc[(points["lost"] <= ENOUGH).cumprod().astype(bool), "severity"]
    return float(mild.iloc[-1]) if len(mild) else float("nan")


def table(results: Results) -> Table:
    """Breaking points by classifier; what was not measured, or has no lead to lose, is left out."""
    blocks = [_block(*_curves(results), "")]
    for behind in list(DENOISERS)[1:] if DENOISED in results.datasets(STAGE) else ():
        blocks.append(_block(*_curves(results, DENOISED, behind), behind))
    frames, text_tables, texts = zip(*blocks, strict=True)
    rows = results.measured(STAGE, metric="accuracy")
    group, method = rows[["group", "method"]].iloc[0]
    words = {
        "points": 100 * ENOUGH, "objects": results.group_text(group).capitalize(), "method": label(method),
        "clean": "; ".join(texts), "guessing": 100 * rows["chance"].iloc[0], "not_run": results.left_out(STAGE),
    }  # fmt: skip
    return Table(pd.concat(frames), pd.concat(text_tables), words)


def _block(rows: pd.DataFrame, curves: Curves, behind: str) -> tuple[pd.DataFrame, pd.DataFrame, str]:
    """(breaking points, the same for a reader, undisturbed accuracies) of one denoiser, a name of DENOISERS."""
    entries = []
    for name, lines in curves.items():
        for line, points in lines.items():
            if points["left"].notna().any():
                ends, last = (*breaking(points, name), harmless(points)), points[["severity", "accuracy"]].iloc[-1]
                entries.append((name, UNITS[name], *line, *ends, *last))
    frame = pd.DataFrame(entries, columns=COLUMNS)
    labels = _lines(behind)
    heads = {line: f"{words} breaks at" for line, words in labels.items()}
    text_table = broken(frame, frame.set_index(KEYS).index.map(heads), UNHARMED)
    columns = ["perturbation", "unit", *(f"{words} breaks at" for words in LINES.values())]
    text_table = text_table.reindex(columns=columns, fill_value="–")
    first = frame.drop_duplicates("perturbation")["harmless"]
    text_table["harmless to kNN"] = ["none" if np.isnan(severity) else f"{severity:g}" for severity in first]
    if behind:
        text_table["perturbation"] += f", {DENOISERS[behind]}"
    clean = {key: group["value"].mean() for key, group in grouped(rows.loc[rows["perturbation"] == CLEAN], KEYS)}
    texts = [f"{words} {100 * clean[line]:.0f} %" for line, words in labels.items() if line in clean]
    return frame, text_table, " ".join(filter(None, [DENOISERS[behind], ", ".join(texts)]))


def figure(results: Results) -> Figure:
    """Accuracy against severity: a panel a perturbation, a line a classifier, a cross where it breaks."""
    (rows, curves), marks = _curves(results), zip(LINES.items(), TINTS, MARKERS, strict=False)
    looks: dict = {line: {"label": words, "color": tint, "marker": mark} for (line, words), tint, mark in marks}
    looks["cross"] = {"label": "half of the lead lost", "ls": "", "marker": "x", "color": GREY, "ms": 7}
    drawing, grid = degradation(curves, UNITS, looks, rows["chance"].iloc[0], 2.3)
    for name, axes in grid.items():
        for line, points in curves[name].items():
            steps = np.array([UNHARMED[name], *points["severity"]])
            sign, places = np.sign(steps[-1] - steps[0]), np.arange(len(steps))  # np.interp needs what rises
            where = np.interp(sign * breaking(points, name)[0], sign * steps, places)
            height = np.interp(where, places, [100 * points["clean"].iloc[0], *(100 * points["accuracy"])])
            axes.plot(where, height, "x", color=looks[line]["color"], ms=7, mew=1.8, zorder=4)
    words = {"perturbations": len(curves), "classifiers": ", ".join(LINES.values())}
    words |= {"objects": results.group_text(rows["group"].iloc[0]), "method": label(rows["method"].iloc[0])}
    return Figure(drawing, words)


def _lines(behind: str) -> dict[tuple[str, ...], str]:
    """LINES, or those on imprints alone that went through a denoiser, a name of DENOISERS."""
    lines = {line: words for line, words in LINES.items() if line[1] == PLAIN or not behind}
    return {(split, f"{features}{behind}", classifier): words for (split, features, classifier), words in lines.items()}


def _curves(results: Results, dataset: str | None = None, behind: str = "") -> tuple[pd.DataFrame, Curves]:
    """(rows, the curves of those that were measured)."""
    rows = results.measured(STAGE, dataset, metric="accuracy")
    names = [name for name in TOUCH_PERTURBATIONS if name in set(rows["perturbation"])]
    return rows, {
        name: {line: points for line in _lines(behind) if len(points := curve(rows, name, line))} for name in names
    }


PAGE = "stability"
TABLES = {"touch_stability": table}
FIGURES = {"touch_stability": figure}
CHARTS = {}

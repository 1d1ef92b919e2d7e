"""Where networks look, against where people look: T figures 3.35 and 3.36 as numbers, with their controls."""

import numpy as np
import pandas as pd

from stages.kit.stats import interval
from stages.report.items import Table
from stages.report.markdown import number, signed, with_interval
from stages.report.results import NotRun, Results

from .rows import (
    LEE,
    NO_PEOPLE,
    PERCENT,
    PRIOR,
    detector_text,
    detectors,
    gap,
    kind,
    network_text,
    networks,
    scores,
    sources,
    with_random_weights,
)

METRICS = {"pcc": "PCC", "pcc_masked": "PCC, the thesis's way", "nss": "NSS", "auc": "AUC",
           "distance": "distance, %", "distance_mean": "distance, mean of pairs, %"}  # fmt: skip
RANGES = {"pcc": (-1, 1), "pcc_masked": (-1, 1), "nss": (-np.inf, np.inf), "auc": (0, 1)}
COMPARED = ("pcc", "distance")  # metrics in which a detector is compared with the controls
OPPONENTS = {"weights": "random weights", "prior": "centre prior", "lee": "mesh saliency"}
NOTES = [
    "EWIGC: the Grad-CAM maps of four tasks (curvature, eccentricity, living or not, category), each weighing its "
    "entropy (T eq. 3.24); EWIGC_L4: only the highest of four levels of each map (T eq. 3.25). Frozen: ImageNet's "
    "weights, a new head for each task; fine-tuned: every layer learned each task. Controls: the same with a network "
    "of random weights, a Gaussian at the middle of each picture, and noise.",
    "PCC: Pearson's correlation over the vertices that a view sees, each weighing its area, mean of three views from "
    "the side. The thesis's way: over all vertices, hidden ones set to zero in both; to know what is hidden already "
    "gives some of it. NSS (0 is chance) and AUC (0.5 is chance): all views in one.",
    "Distance: between the centres of fixation, the least of a view as in the thesis, in % of the diameter of the "
    "object's bounding sphere; it shrinks with the number of centres alone, so that noise does well. Mean of pairs: "
    "over all pairs of centres of a view.",
    "Centres are those of the vertices above 95 % of the maximum. The three views are of the same objects, and 60 in "
    "100 of all views taught the heads their classes; none taught them where people look. Heads of frozen networks are "
    "logistic regressions with an L2 penalty on unaugmented views. ResNet50's weights are converted from Keras's "
    "training; VGG16's are its convolutions. Untrained: one draw of the weights. Seconds: an object, all views drawn, "
    "looked at and put on the surface.",
    "Brackets: 95 % interval, bootstrap over the objects. Two detectors differ beyond chance where the interval of "
    "their paired difference excludes zero, not where their own intervals are apart.",
]


def build(results: Results) -> Table:
    found = sources(results)
    frame = pd.DataFrame([line for source, rows in found.items() for line in _lines(source, rows)])
    notes = [_accuracy(source, rows) for source, rows in found.items() if (rows["metric"] == "accuracy").any()]
    notes += [NO_PEOPLE] if any(source.startswith("marks") for source in found) else []
    return Table("Where networks look, against people", frame, NOTES + notes + _missing(results), _wide(frame))


def _lines(source, rows):
    tables = {metric: scores(rows, metric) for metric in METRICS if (rows["metric"] == metric).any()}
    cost = rows.dropna(subset=["seconds"])
    cost = cost[cost["metric"] == "pcc"].drop_duplicates(["item", "method"]).groupby("method")["seconds"].median()
    order = detectors(tables["pcc"])
    for name in sorted(order, key=lambda name: -tables["pcc"][name].mean()):
        for metric, table in tables.items():
            if name not in table:
                continue
            values = (PERCENT if metric.startswith("distance") else 1) * table[name].dropna()
            mean, low, high = np.clip(interval(values), *RANGES.get(metric, (0, np.inf)))
            line = {
                "truth": source,
                "detector": detector_text(name),
                "method": name[0],
                "task": name[1],
                "kind": kind(name),
            }
            line |= {"metric": metric, "objects": len(values), "mean": mean, "low": low, "high": high}
            line |= {"seconds": cost.get(name[0])}
            yield line | (_gains(table, name, metric) if metric in COMPARED else {})


def _gains(table, name, metric):
    """How much more the detector has than each opponent, paired over the objects; empty where that is not measured."""
    method, task = name
    others = {"prior": PRIOR, "lee": LEE}
    if kind(name) == "fused":
        others["weights"] = (with_random_weights(method), task)
    found = {}
    for key, other in others.items():
        if other == name:
            continue
        try:
            values = interval((PERCENT if metric == "distance" else 1) * gap(table, name, other))
        except NotRun:
            continue
        found |= dict(zip((f"over_{key}", f"over_{key}_low", f"over_{key}_high"), values, strict=True))
    return found


def _accuracy(source, rows):
    """How well the heads know their tasks: of known objects from new directions, and of objects never seen."""
    said = []
    for method in networks(rows):
        own = rows[rows["method"] == method].groupby(["split", "metric"])["value"].mean()
        parts = [f"{text} {100 * own[split, 'accuracy']:.0f} (most frequent class {100 * own[split, 'chance']:.0f})"
                 for split, text in (("views", "known objects"), ("objects", "objects never seen"))
                 if (split, "accuracy") in own and (split, "chance") in own]  # fmt: skip
        said += [f"{network_text(method)}: {', '.join(parts)}"] if parts else []
    return f"Classes named right on {source}, %, mean of the tasks: {'; '.join(said)}."


def _missing(results):
    """Networks that this run asked for and could not have, and why."""
    if "fixation" not in results.stages:
        return []
    rows = results.rows("fixation")
    if "note" not in rows:
        return []
    missing = rows[rows["value"].isna() & rows["note"].notna() & rows["task"].isna()]
    return [f"Not run here: {network_text(row.method)}: {row.note}." for row in missing.itertuples()]


def _wide(frame):
    lines = []
    for (source, detector), group in frame.groupby(["truth", "detector"], sort=False):
        cell = group.set_index("metric")
        line = {"truth": source, "detector": detector}
        for metric, title in METRICS.items():
            if metric in cell.index:
                places = 1 if metric.startswith("distance") else 2
                line[title] = with_interval(*cell.loc[metric, ["mean", "low", "high"]], places=places)
            else:
                line[title] = "–"
        for key, title in OPPONENTS.items():
            line[f"it − {title}, PCC"] = _gain(cell.loc["pcc"], key)
        lines.append(line | {"seconds": number(cell["seconds"].iloc[0])})
    return pd.DataFrame(lines)


def _gain(row, key):
    values = row.reindex([f"over_{key}", f"over_{key}_low", f"over_{key}_high"]).astype(float)
    return signed(*values) if values.iloc[0] == values.iloc[0] else "–"

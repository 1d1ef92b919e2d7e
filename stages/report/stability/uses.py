"""What a disturbance costs where the points are used: simplification around them, recognition by touch there."""

import pandas as pd

from stages.kit.stats import interval
from stages.report.grid import grouped, within
from stages.report.items import Table
from stages.report.markdown import with_interval
from stages.report.results import Results
from stages.report.style import label
from stages.stability import PERTURBATIONS
from stages.stability.recognition import PARTITIONS, SET
from stages.stability.subject import UNPERTURBED
from stages.stability.uses import KEPT, PLAIN, SENSOR_NOISE, TARGET

from .score import BENCHMARK, STAGE

SHOWN = ("glance", "itti", "harris")  # the CSV has all
METRICS = ("lod_mean", "lod_salient", "recognised")


def table(results: Results) -> Table:
    """A row a disturbance: per method the salient error as a share of that of plain QEM, and recognition by touch."""
    rows = results.measured(STAGE, results.printed(BENCHMARK, STAGE), metric=list(METRICS))
    frame = pd.DataFrame([
        {"perturbation": name, "method": method, "metric": metric, **_number(rows, own, method, metric)}
        for (name, method, metric), own in grouped(rows, ["perturbation", "method", "metric"])
    ])  # fmt: skip
    cells = frame.set_index(["perturbation", "method", "metric"])
    methods = [name for name in SHOWN if name in set(frame["method"])] or list(dict.fromkeys(frame["method"]))
    names = [name for name in dict.fromkeys(frame["perturbation"]) if name != PLAIN]
    names.sort(key=lambda name: name != UNPERTURBED)
    severity = rows.dropna(subset=["severity"]).drop_duplicates("perturbation").set_index("perturbation")["severity"]
    shown = pd.DataFrame([
        {"disturbance": label(name),
         "severity": f"{severity[name]:g} {PERTURBATIONS[name].unit}" if name in severity else "–",
         **{f"{label(method)}, salient error, %": _text(cells, name, method, "lod_salient") for method in methods},
         **{f"{label(method)}, recognised, %": _text(cells, name, method, "recognised") for method in methods}}
        for name in names
    ])  # fmt: skip
    words = {
        "objects": rows["item"].nunique(), "target": f"{100 * TARGET:.0f}", "kept": KEPT,
        "set": SET, "partitions": PARTITIONS, "noise": f"{100 * SENSOR_NOISE:.0f}",
    }  # fmt: skip
    return Table(frame, shown, words)


def _number(rows, own, method, metric):
    """Mean, low and high over the objects; of an error as a share of that of plain QEM of the same object."""
    values = own.set_index("item")["value"]
    if metric == "recognised":
        found = within(values)
    else:
        plain = rows[(rows["perturbation"] == PLAIN) & (rows["method"] == method) & (rows["metric"] == metric)]
        found = interval(values / plain.set_index("item")["value"].reindex(values.index))
    return dict(zip(("mean", "low", "high"), found, strict=True)) | {"objects": len(values)}


def _text(cells, *key):
    if key not in cells.index:
        return "–"
    mean, low, high = cells.loc[key, ["mean", "low", "high"]]
    return with_interval(mean, low, high, 100, 0)

"""Stability of the agreement with people, and of uses.

The cost of disturbances on the objects that people looked at: points found again, agreement with gaze.

The cost of a disturbance where the points are used: simplification around them, recognition by touch there.
"""

import numpy as np
import pandas as pd

from haptic_glance.disturb.objects import PERTURBATIONS
from stages.engine.statistics import interval
from stages.report.drawing import label
from stages.report.items import Table
from stages.report.results import GAZED, Results, some
from stages.report.tables import grouped, records, signed, with_interval, within
from stages.stability.subject import UNPERTURBED
from stages.stability.uses import KEPT, PARTITIONS, PLAIN, SENSOR_NOISE, SET, TARGET

from .score import BENCHMARK, STAGE, of_gaze, scores

REFERENCE = "glance"  # Itti's attention was not disturbed on these sets


def people_table(results: Results) -> Table:
    """A row a disturbance: per method the share of points found again, and the NSS and AUC that are lost."""
    sets = some([name for name in GAZED if name in results.datasets(STAGE)], "no objects with gaze", STAGE)
    rows = pd.concat([results.measured(STAGE, name) for name in sets])
    plain = rows.loc[rows["perturbation"] == UNPERTURBED].set_index(["item", "method", "metric"])["value"]
    disturbed = rows.loc[rows["perturbation"] != UNPERTURBED]
    frame = pd.DataFrame([
        dict(zip(("perturbation", "severity", "method"), key, strict=True)) | _cell(case, plain)
        for key, case in grouped(disturbed, ["perturbation", "severity", "method"])
    ])  # fmt: skip
    methods = list(dict.fromkeys(frame["method"]))
    shown = pd.DataFrame([_line(key, case, methods) for key, case in grouped(frame, ["perturbation", "severity"])])
    start = plain.xs("nss", level="metric").groupby("method").mean()
    items = {name: results.rows(STAGE, name)["item"].nunique() for name in sets}
    words = {
        "count": sum(items.values()), "meshes": items.get("gaze", 0), "clouds": items.get("gaze_clouds", 0),
        "undisturbed": ", ".join(f"{label(name)} {start[name]:.2f}" for name in methods), "score": _score(rows),
        "not_run": "\n".join(filter(None, (results.left_out(STAGE, name) for name in sets))),
    }  # fmt: skip
    return Table(frame, shown, words)


def _score(rows: pd.DataFrame) -> str:
    """The mean corruption errors in AUC and what they have beyond the undisturbed error, in a sentence."""
    if REFERENCE not in set(rows["method"]):
        return ""
    found = scores(of_gaze(rows), REFERENCE)
    said = "; ".join(
        f"{label(row.method)} {with_interval(row.mce, row.mce_low, row.mce_high, 100, 0)} %, relative "
        f"{with_interval(row.relative, row.relative_low, row.relative_high, 100, 0)} %"
        for row in records(found[found["method"] != REFERENCE])
    )
    return (
        f"Mean corruption error of 1 - AUC, that of {label(REFERENCE)} being 100 %: {said}. Relative: of what is lost "
        "beyond the undisturbed error alone, where a disturbance costs the reference anything."
    )


def _cell(case, plain):
    """The numbers of one method under one disturbance: rows with item, method, metric, value."""
    wide = case.pivot(index="item", columns="metric", values="value")
    method = case["method"].iloc[0]
    again = np.clip(interval(wide["repeatability"], statistic=np.median), 0, 1)
    found = dict(zip(("again", "again_low", "again_high"), again, strict=True)) | {"chance": wide["chance"].mean()}
    for metric in ("nss", "auc"):
        lost = wide[metric] - plain.xs((method, metric), level=("method", "metric")).reindex(wide.index)
        found |= dict(zip((metric, f"{metric}_low", f"{metric}_high"), interval(lost), strict=True))
    return found | {"objects": len(wide)}


def _line(key, case, methods):
    perturbation, severity = key
    case = case.set_index("method")
    again = case[["again", "again_low", "again_high"]]
    return {
        "disturbance": label(perturbation), "severity": f"{severity:g} {PERTURBATIONS[perturbation].unit}",
        **{f"{label(name)}, %": with_interval(*again.loc[name], scale=100, places=0) for name in methods},
        "chance, %": f"{100 * case['chance'].mean():.0f}",
        **{f"{label(name)}, NSS": signed(*case.loc[name, ["nss", "nss_low", "nss_high"]]) for name in methods},
    }  # fmt: skip


SHOWN = ("glance", "itti", "harris")  # the CSV has all
METRICS = ("lod_mean", "lod_salient", "recognised")


def uses(results: Results) -> Table:
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

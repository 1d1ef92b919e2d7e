"""Which method is the most stable: the score of each, where it breaks, and its seconds and accuracy beside it."""

import numpy as np
import pandas as pd

from stages.kit.stats import interval
from stages.report.costs import attention_seconds
from stages.report.grid import percent, records
from stages.report.items import Figure, Table
from stages.report.markdown import number, with_interval
from stages.report.pareto import pareto_chart
from stages.report.results import Results, some
from stages.report.style import label
from stages.stability import PERTURBATIONS
from stages.stability.summary import breaking_points

from .panels import cell
from .score import BENCHMARK, KINDS, LEAST, REFERENCE, STAGE, Errors, of_points, scores

GAZE = "gaze"  # the set that tells accuracy and seconds
CHANCE = "random"
PROTOCOL = (  # conf/stability/benchmark.yaml
    "Smaller than the thesis: pictures of a fourth of the rows, two or three severities, three draws of what is "
    "random. Left out, since they are the slowest: regions of interest, spectral and cluster-based saliency. Copies of "
    "a primitive at other sizes count once."
)
BANDS = {0.3: "under 0.3", 0.6: "0.3 to 0.6", 1.2: "0.6 to 1.2", np.inf: "above 1.2"}  # NSS on gaze, for the chart


def table(results: Results) -> Table:
    """A row a method, the most stable first."""
    rows, frame, errors = _scored(results)
    frame = frame.merge(_accuracy(results), on="method", how="left").sort_values("mce")
    shown = pd.DataFrame([
        {
            "method": label(row.method),
            "mCE, %": with_interval(row.mce, row.mce_low, row.mce_high, 100, 0),
            **{f"{kind}, %": percent(getattr(row, kind)) for kind in KINDS},
            "found again, %": with_interval(row.found, row.found_low, row.found_high, 100, 0),
            "NSS on gaze": number(row.nss, 2) if np.isfinite(row.nss) else "–",
            "seconds": number(row.seconds, 2) if np.isfinite(row.seconds) else "–",
        }
        for row in records(frame)
    ])  # fmt: skip
    return Table(frame, shown, _words(results, rows, errors))


def breaking(results: Results) -> Table:
    """A row a method, a column a disturbance: the severity at which half of the points are lost."""
    rows, frame, errors = _scored(results)
    rows = rows[rows["perturbation"].isin(errors.perturbations)]
    found = pd.DataFrame([
        {"method": method, "perturbation": name, "unit": PERTURBATIONS[name].unit,
         "harshest": [severity for one, severity in errors.cases if one == name][-1],
         "breaking_point": at, "low": low, "high": high}
        for (name, method), (at, low, high) in breaking_points(rows[rows["method"] != CHANCE]).items()
    ])  # fmt: skip
    found["text"] = [cell(row, PERTURBATIONS[row.perturbation].unharmed) for row in records(found)]
    order = [name for name in frame.sort_values("mce")["method"] if name != CHANCE]
    wide = found.pivot(index="method", columns="perturbation", values="text").loc[order, errors.perturbations]
    shown = wide.rename(index=label, columns=label).rename_axis(columns=None).reset_index()
    units = "; ".join(f"{label(name)}: {PERTURBATIONS[name].unit}" for name in errors.perturbations)
    return Table(found.drop(columns="text"), shown, _words(results, rows, errors) | {"units": units})


def chart(results: Results) -> Figure:
    """The share of points found again against the seconds of a look, coloured by the agreement with gaze."""
    _, frame, errors = _scored(results)
    frame = frame[frame["method"] != CHANCE].merge(_accuracy(results), on="method").dropna(subset=["seconds"])
    some(frame, f"no seconds of a look on {GAZE}", "salient_points", runnable=False)
    frame = frame.assign(name=frame["method"].map(label), low=frame["found_low"], high=frame["found_high"])
    frame["band"] = [next(text for top, text in BANDS.items() if nss < top) for nss in frame["nss"].fillna(0)]
    frame = frame.sort_values("nss", ascending=False)
    for end in ("found", "low", "high"):
        frame[end] *= 100
    drawn = pareto_chart(
        frame, "found", title="Stability against the cost of a look", reference=label(REFERENCE),
        quality_label="points found again beyond chance, %", colour="band", legends={"band": "NSS on gaze"},
        clock=results.clock("salient_points", GAZE),
    )  # fmt: skip
    sharp = frame[frame["band"] == frame["band"].iloc[0]].sort_values("found", ascending=False).iloc[0]
    said = f"{sharp['name']}, {with_interval(sharp['found'], sharp['low'], sharp['high'], places=0)} %"
    drawn.words |= {"objects": len(errors.objects), "band": sharp["band"], "sharp": said}
    return drawn


def _scored(results: Results) -> tuple[pd.DataFrame, pd.DataFrame, Errors]:
    """(rows of the benchmark or else of the first set, `scores`, the Errors)."""
    rows = results.rows(STAGE, results.printed(BENCHMARK, STAGE), metric=["repeatability", "chance"])
    errors = of_points(rows)
    return rows, scores(errors), errors


def _accuracy(results: Results) -> pd.DataFrame:
    """Of each method the NSS on the meshes with gaze, with its interval, and the seconds of a look; empty without."""
    if not results.printed(GAZE, "salient_points"):
        return pd.DataFrame(columns=["method", "nss", "seconds"]).astype({"nss": float, "seconds": float})
    rows = results.measured("salient_points", GAZE, metric="nss")
    seconds = attention_seconds(results, GAZE)
    found = [
        dict(zip(("nss", "nss_low", "nss_high"), interval(own["value"]), strict=True)) | {"method": method}
        for method, own in rows.groupby("method")
    ]
    frame = pd.DataFrame(found)
    return frame.assign(seconds=frame["method"].map(seconds))


def _words(results, rows, errors):
    dropped = [
        label(name) for name, sums in zip(errors.perturbations, _of_reference(errors), strict=True) if sums <= LEAST
    ]
    return {
        "objects": len(errors.objects), "methods": len(errors.methods), "reference": label(REFERENCE),
        "perturbations": ", ".join(label(name) for name in errors.perturbations if label(name) not in dropped),
        "protocol": PROTOCOL if rows["dataset"].iloc[0] == BENCHMARK else "",
        "left_out": f"Without {', '.join(dropped)}, which cost the reference nothing." if dropped else "",
        "not_run": results.left_out(STAGE, rows["dataset"].iloc[0]),
    }  # fmt: skip


def _of_reference(errors):
    means = errors.by_perturbation(errors.means(np.ones((1, len(errors.objects)))))[0]
    return means[errors.methods.index(REFERENCE)] / errors.severities

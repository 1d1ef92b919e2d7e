"""Ours against the newest meshoptimizer: time and Metro error of paired cells, and the error where people look."""

from collections.abc import Iterator

import numpy as np
import pandas as pd

from stages.engine.statistics import interval
from stages.report.drawing import label
from stages.report.results import NotRun, Results
from stages.report.tables import with_interval

OURS, OTHER = "fast", "meshoptimizer"
Interval = tuple[float, float, float]


def sentences(rows: pd.DataFrame, results: Results) -> list[str]:
    """A sentence a task, of the rows of bench/simplification.csv.gz, and one on gaze; none where not measured."""
    tasks = [group for _, group in rows.groupby("with_points") if OTHER in set(group["backend"])]
    return [_plain(group) for group in tasks] + [*_salient(results)]


def _plain(rows: pd.DataFrame) -> str:
    error, time = _ratio(rows, "metro_mean"), _ratio(rows, "seconds")
    return (
        f"{label(OURS)}, {'points' if rows['with_points'].all() else 'nothing'} kept: {with_interval(*error)} times "
        f"{label(OTHER)}'s Metro error. It takes {with_interval(*time)} times its time."
    )


def _ratio(rows: pd.DataFrame, value: str) -> Interval:
    """(mean, low, high) of ours over the other's: geometric, over the meshes, in the cells that both reached."""
    reached = rows[rows["outcome"] == "reached"]
    pairs = reached.pivot(index=["mesh", "full", "target"], columns="backend", values=value)
    return _over_meshes(pairs[OURS] / pairs[OTHER])


def _over_meshes(ratios: pd.Series) -> Interval:
    mean, low, high = np.exp(interval(ratios.dropna().apply(np.log).groupby("mesh").mean()))
    return float(mean), float(low), float(high)


def _salient(results: Results) -> Iterator[str]:
    try:
        rows = results.bench("salient_simplification")
    except NotRun:
        return
    if "bar" not in rows or rows["bar"].isna().all():
        return
    own = rows[(rows["outcome"] == "reached") & (rows["method"] == f"{OURS}_weights")].set_index("mesh")
    found, meshes = _over_meshes(own["salient_ratio"]), own["salient_ratio"].dropna().index.nunique()
    means = own["salient_ratio"].apply(np.log).groupby(own["share"]).mean().apply(np.exp)
    shares = ", ".join(f"{mean:.2f} at {share:.0%}" for share, mean in means.items())
    yield (
        f"Error weighted by recorded gaze, {meshes} meshes: ours, with the gaze as weights, has "
        f"{with_interval(*found)} times that of {label(OTHER)} with its priority bit, its lock bit or neither, the "
        f"best in each cell ({shares} of the faces)."
    )

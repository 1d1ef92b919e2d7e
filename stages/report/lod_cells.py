"""The errors of simplified meshes, compared on the same objects and targets only."""

from typing import NamedTuple

import pandas as pd

from stages.report.results import NotRun

CELL = ["object", "target"]
PLAIN = "qem"
ELSEWHERE = ("princeton", "gaze")  # measured once, their tables committed
SETS = {"princeton": "psb", "gaze": "gaze meshes"}  # names as a person says them
ERRORS = {  # metric -> (name, factor to the unit in which it is shown)
    "metro_mean": ("Metro mean, %", 100), "metro_rms": ("Metro rms, %", 100), "metro_max": ("Metro max, %", 100),
    "ssim_error": ("1 − SSIM, %", 100), "dlap": ("DLap", 1), "dnor": ("Dnor", 1),
    "salient_error": ("error where our model looks, %", 100), "gaze_error": ("error where people look, %", 100),
}  # fmt: skip
FEWEST = 3  # objects that a mean over objects needs to be shown


class Source(NamedTuple):
    """Which rows: those of a committed data set (None: of this run), and whether only where nothing had to shrink."""

    data: str | None = None
    whole: bool = False


OWN = Source()


def data_sets(results):
    """dict name as a person says it -> Source: this run's first, then the committed; NotRun where there is none."""
    found = {}
    try:
        own = str(results.measurements("lod")["dataset"].iloc[0])
        found[SETS.get(own, own)] = OWN
    except NotRun as missing:
        own, why = None, missing
    for name in ELSEWHERE:
        if name != own and (results.reports / "simplification" / f"{name}.csv").exists():
            found[SETS[name]] = Source(name)
    if not found:
        raise why
    return found


def by_gaze(results):
    """The Source of the meshes with human gaze, this run's or the committed ones."""
    return data_sets(results).get(SETS["gaze"], Source("gaze"))


def cells(results, metrics, source=OWN, methods=None):
    """Measured rows of the lod stage with these metrics; methods: of these alone (None: of all).

    `seconds` is the simplification's (the committed tables have none); `plain` the value of plain QEM for the same
    object, target and metric.
    """
    rows = _rows(results, [*metrics, "faces"], source.data)
    rows = rows if methods is None else rows[rows["method"].isin([PLAIN, *methods])]
    made = rows[rows["metric"] == "faces"].reindex(columns=[*CELL, "method", "seconds"])
    rows = rows[rows["metric"].isin(metrics)].drop(columns="seconds", errors="ignore")
    plain = rows.loc[rows["method"] == PLAIN, [*CELL, "metric", "value"]].rename(columns={"value": "plain"})
    rows = rows if methods is None else rows[rows["method"].isin(methods)]
    return rows.merge(made, on=[*CELL, "method"]).merge(plain, on=[*CELL, "metric"], how="left")


def paired_cells(results, metrics, methods, source=OWN):
    """As `cells`, of those of the methods that were run, only where all of them reach the target of the object.

    With source.whole only where, moreover, none of them had to shrink its neighbourhoods: the thesis's own algorithm.
    """
    rows = cells(results, metrics, source, methods)
    counted = rows[~rows["shrunk"].fillna(False).astype(bool)] if source.whole else rows
    key = [*CELL, "metric"]
    reached = counted.groupby(key)["method"].nunique()
    everywhere = reached.index[reached == rows["method"].nunique()]
    return rows[pd.MultiIndex.from_frame(rows[key]).isin(everywhere)]


def face_counts(rows):
    """The targets of the rows with enough objects, most faces first: counts, or shares where there are no counts."""
    objects = rows.groupby("target")["object"].nunique()
    enough = sorted(objects.index[objects >= FEWEST], key=size)
    return [target for target in enough if target.isdigit()] or enough


def size(target):
    """A key that sorts targets: shares before counts, large before small."""
    return (not target.endswith("%"), -float(target.rstrip("%")))


def said(target):
    """A target in words: `25%`, `1,500 faces`."""
    return target if target.endswith("%") else f"{int(target):,} faces"


def _rows(results, metrics, data):
    if data is None:
        rows = results.measurements("lod", metric=list(metrics))
    else:
        rows = results.simplification(data)
        rows = rows[rows["metric"].isin(metrics)]
    return rows.dropna(subset=["value"]).astype({"target": str})

"""Who simplifies: time and error of each backend as ratios to pymeshlab's QEM, timed in one run of `make bench`."""

import numpy as np
import pandas as pd

from stages.kit.stats import interval
from stages.report.items import Table
from stages.report.markdown import with_interval
from stages.report.results import NotRun, Results
from stages.report.style import label
from stages.report.target import on_target

from .growth import FITTED, POWERS, growth

REFERENCE, OURS = "pymeshlab", "fast"
WANTED = 20  # times faster than the reference, at an error no larger, in a time that grows no faster than n log n,
LARGEST = 1_000_000  # to so many faces
CELL = ["mesh", "full", "target", "with_points"]
RATIOS = {  # part of a column's name -> (column of the bench, title)
    "time": ("ratio", "time ratio"), "whole": ("whole_ratio", "all of simplify"),
    "colours": ("colours_ratio", "with colours"),
    "error": ("error_ratio", "Metro ratio"), "seen": ("seen_ratio", "1 − SSIM ratio"),
}  # fmt: skip
NOTES = [
    "Ratios: geometric means over the meshes of the ratio to pymeshlab's QEM of the same mesh, target and kept points, "
    "timed in turns in one process [95 % interval over the meshes]; below 1 is faster, or closer. Only the cells that "
    "all backends of the task reached. Time: the backend alone, with its check of the result; all of simplify: with "
    "the kept faces found and the target tested; with colours: the same, colours of the vertices carried over. "
    "Slowest: the largest time ratio of these cells.",
    "Refused: cells, of those tried, in which the backend said why it made no mesh; missed: in which it made one of "
    "more faces than were asked for. Kept: share of the meshes within the target in which all kept vertices survived "
    "bit for bit; valid: share without new folded, degenerate or non-manifold face, with the pieces and handles that "
    "were there.",
    f"Growth: p of the fit seconds = c n^p, and of c (n log n)^p, from {FITTED:,} faces n on, over the same cells, "
    "with a level c of its own for each share of the faces [95 % interval, bootstrap over the meshes]; the second at 1 "
    "or less grows no faster than n log n.",
]


def build(results: Results) -> Table:
    rows = tried(results)
    frame = summarised(rows)
    paired = common(rows)
    parts = [paired[(paired["backend"] == row.backend) & (paired["with_points"] == row.with_points)]
             for row in frame.itertuples()]  # fmt: skip
    for shape in POWERS:
        fits = [growth(part, shape) for part in parts]
        for name in ("power", "low", "high"):
            frame[f"{shape}_{name}"] = [getattr(fit, name, np.nan) for fit in fits]
    return Table("Simplification: backends", frame, [*_said(frame), _meshes(rows), *NOTES], _wide(frame))


def tried(results):
    """The rows of bench/simplification.csv, with the columns with_points and seen_ratio; NotRun without outcomes."""
    rows = results.bench("simplification")
    if "outcome" not in rows:
        raise NotRun("bench/simplification.csv has no outcomes: `make bench` writes it anew", "lod", runnable=False)
    rows = rows.assign(with_points=rows["kept_points"] > 0)
    base = rows[rows["backend"] == REFERENCE].set_index(CELL)["ssim_error"]
    rows = rows.join(base.rename("base"), on=CELL)
    return rows.assign(seen_ratio=rows["ssim_error"] / rows["base"].where(rows["base"] > 0))


def common(rows):
    """The rows of the cells that all backends of their task (with points, or without) reached."""
    reached = rows[rows["outcome"] == "reached"]
    wanted = rows.groupby("with_points")["backend"].nunique()
    found = reached.groupby(CELL)["backend"].transform("nunique")
    return reached[found == reached["with_points"].map(wanted)]


def growths(rows, shape="loglinear"):
    """dict backend -> its Growth, over the cells that all backends reached, with points kept or not, each with a level
    of its own; None where the meshes are too small.
    """
    paired = common(rows)
    return {name: growth(paired[paired["backend"] == name], shape) for name in dict.fromkeys(rows["backend"])}


def summarised(rows):
    """A row a backend, without and with points to keep: refusals, misses, ratios of time and errors, kept, valid."""
    paired, found = common(rows), []
    for (backend, with_points), group in rows.groupby(["backend", "with_points"], sort=False):
        own = paired[(paired["backend"] == backend) & (paired["with_points"] == with_points)]
        asked, made = group[group["outcome"] != "infeasible"], group[group["outcome"] == "reached"]
        line = {"backend": backend, "with_points": bool(with_points), "meshes": own["mesh"].nunique()}
        line |= {"cells": len(own), "tried": len(asked)}
        line |= {name: int((asked["outcome"] == name).sum()) for name in ("refused", "missed")}
        for name, (column, _) in RATIOS.items():
            line |= dict(zip((f"{name}_ratio", f"{name}_low", f"{name}_high"), _ratio(own, column), strict=True))
        line |= {"slowest": own["ratio"].max(), "seconds": own["seconds"].median()}
        kept = _share(made["kept"]) if with_points else np.nan
        found.append(line | {"kept": kept, "valid": _share(made["valid"])})
    return pd.DataFrame(found).sort_values(["with_points", "time_ratio"], ascending=[True, False], ignore_index=True)


def _ratio(group, column):
    """(geometric mean, low, high) over the meshes."""
    logs = np.log(group[column].where(group[column] > 0)).groupby(group["mesh"]).mean()
    return tuple(np.exp(interval(logs)))


def _share(column):
    """Share of the cells that are true; empty ones do not count."""
    known = column.dropna().astype(str).str.lower()
    return (known == "true").mean() if len(known) else np.nan


def _said(frame):
    """The targets of ours in time, error and growth, and whether it met them, without and with points kept."""
    said, other = [], label(REFERENCE)
    for row in frame[(frame["backend"] == OURS) & (frame["cells"] > 0)].itertuples():
        faster = 1 / row.time_ratio, 1 / row.time_high, 1 / row.time_low
        error = row.error_ratio, row.error_low, row.error_high
        power = row.loglinear_power, row.loglinear_low, row.loglinear_high
        said.append(
            f"{label(OURS)}, {'points' if row.with_points else 'nothing'} kept: {with_interval(*faster)} times faster "
            f"than {other}; {WANTED} times is {on_target(*faster, at_least=WANTED)}. Its Metro error is "
            f"{with_interval(*error)} times {other}'s; 1 or less is {on_target(*error, at_most=1)}. Its time grows as "
            f"(n log n)^p, p = {with_interval(*power, places=2)}; no faster than n log n is "
            f"{on_target(*power, at_most=1)}."
        )
    return said


def _meshes(rows):
    counts = ", ".join(f"{n} {source}" for source, n in rows.groupby("source", sort=False)["mesh"].nunique().items())
    cells = rows.drop_duplicates(CELL)
    floor = (cells["outcome"] == "infeasible").sum()
    kept = cells.loc[cells["with_points"], "kept_points"]
    largest = f"The largest mesh has {rows['full'].max():,} faces"
    largest += f"; {LARGEST:,} were wanted." if rows["full"].max() < LARGEST else "."
    said = (
        f" with {kept.min()} to {kept.max()} points kept, as many as the target leaves room for;" if len(kept) else ""
    )
    return (
        f"Meshes: {counts}; {rows['full'].min():,} to {rows['full'].max():,} faces. {len(cells)} cells (mesh, target, "
        f"kept or not), {len(kept)} of them{said} {floor} targets are infeasible and were put to no backend. {largest}"
    )


def _wide(frame):
    shown = pd.DataFrame({"backend": frame["backend"].map(label)})
    shown["points kept"] = ["yes" if kept else "no" for kept in frame["with_points"]]
    for name in ("refused", "missed"):
        shown[name] = [f"{count} of {tried}" for count, tried in zip(frame[name], frame["tried"], strict=True)]
    shown["cells compared"] = frame["cells"]
    for name, (_, title) in RATIOS.items():
        shown[title] = _texts(frame[[f"{name}_ratio", f"{name}_low", f"{name}_high"]], "–")
    shown["slowest"] = frame["slowest"]
    for name in ("kept", "valid"):
        shown[name] = [f"{100 * share:.0f} %" if share == share else "–" for share in frame[name]]
    for shape, (title, _) in POWERS.items():
        shown[f"growth: p of {title}"] = _texts(frame[[f"{shape}_power", f"{shape}_low", f"{shape}_high"]], "–", 2)
    return shown.assign(meshes=frame["meshes"])


def _texts(columns, absent, places=None):
    rows = columns.itertuples(index=False)
    return [absent if row[0] != row[0] else with_interval(*row, places=places) for row in rows]

"""Who simplifies: time and error of each backend as ratios to pymeshlab's QEM, timed in one run of `make bench`."""

import numpy as np
import pandas as pd

from stages.kit.stats import interval
from stages.report.grid import percent
from stages.report.items import Table
from stages.report.markdown import with_interval
from stages.report.prose import shared_notes
from stages.report.results import NotRun, Results
from stages.report.style import label

from .against_meshoptimizer import sentences
from .growth import FITTED, growth

REFERENCE, OURS = "pymeshlab", "fast"
CELL, TASK = ["mesh", "full", "target", "with_points"], ["backend", "with_points"]
RATIOS = {  # first part of a column's name -> title
    "time": "time ratio", "whole": "all of simplify", "colours": "with colours",
    "error": "Metro ratio", "largest": "largest-error ratio", "seen": "1 − SSIM ratio",
}  # fmt: skip
MAXIMUM = "metro_max"  # a column that rows of the benchmark have since each call gets a new mesh
GROWTHS = {"linear": "n^p", "loglinear": "(n log n)^p"}
ANSWER = ["backend", "points kept", *(RATIOS[name] for name in ("time", "error", "largest", "seen")), "valid"]


def build(results: Results) -> Table:
    """A row a backend, without and with points to keep."""
    rows = tried(results)
    frame = summarised(rows, fitted=True)
    cells = rows.drop_duplicates(CELL)
    sources, kept = rows.groupby("source", sort=False)["mesh"].nunique(), cells.loc[cells["with_points"], "kept_points"]
    said = [_said(row) for row in frame[frame["backend"] == OURS].itertuples() if row.cells]
    words = {
        "measured": shared_notes(__package__, f"timed_{'cold' if MAXIMUM in rows else 'warm'}"),
        "said": "\n".join(said + sentences(rows, results)),
        "sources": ", ".join(f"{count} {source}" for source, count in sources.items()),
        "least": rows["full"].min(), "most": rows["full"].max(), "cells": len(cells), "with_points": len(kept),
        "kept": f"{kept.min()} to {kept.max()}" if len(kept) else "no",
        "infeasible": (cells["outcome"] == "infeasible").sum(), "fitted": FITTED,
    }  # fmt: skip
    # no ranking: time stands against error, as the chart of the same name shows
    return Table(frame, _wide(frame), words, answer=ANSWER)


def tried(results: Results) -> pd.DataFrame:
    """The rows of bench/simplification.csv.gz, with with_points and RATIOS' columns; NotRun without outcomes."""
    rows = results.bench("simplification").rename(columns={"ratio": "time_ratio"})
    if "outcome" not in rows:
        raise NotRun("bench/simplification.csv.gz has no outcomes: `make bench` writes it anew", "lod", runnable=False)
    rows = rows.assign(with_points=rows["kept_points"] > 0)
    rows["largest_ratio"] = rows.get("largest_ratio", np.nan)  # rows of before have none
    rows["base"] = rows["ssim_error"].where((rows["backend"] == REFERENCE) & (rows["ssim_error"] > 0))
    return rows.assign(seen_ratio=rows["ssim_error"] / rows.groupby(CELL)["base"].transform("first"))


def common(rows: pd.DataFrame) -> pd.DataFrame:
    """The rows of the cells that all backends of their task (with points, or without) reached."""
    reached = rows[rows["outcome"] == "reached"]
    wanted = rows.groupby("with_points")["backend"].nunique()
    found = reached.groupby(CELL)["backend"].transform("nunique")
    return reached[found == reached["with_points"].map(wanted)]


def summarised(rows: pd.DataFrame, fitted: bool = False) -> pd.DataFrame:
    """A row a backend, without and with points to keep: refusals, ratios of time and errors; fitted: and growth."""
    paired, found = common(rows), []
    for key, group in rows.groupby(TASK, sort=False):
        own, outcomes = paired[(paired[TASK] == key).all(axis=1)], group["outcome"].value_counts()
        line = dict(zip(TASK, key, strict=True)) | {"meshes": own["mesh"].nunique(), "cells": len(own)}
        line |= {"tried": len(group) - outcomes.get("infeasible", 0)}
        line |= {name: outcomes.get(name, 0) for name in ("refused", "missed")}
        for name in RATIOS:
            ratios = own[f"{name}_ratio"]
            logs = ratios.where(ratios > 0).apply(np.log).groupby(own["mesh"]).mean()
            line |= dict(zip((f"{name}_ratio", f"{name}_low", f"{name}_high"), np.exp(interval(logs)), strict=True))
        line |= {"slowest": own["time_ratio"].max(), "seconds": own["seconds"].median()}
        made = group[group["outcome"] == "reached"]
        line |= {name: made[name].dropna().astype(bool).mean() for name in ("kept", "valid")}
        for shape in GROWTHS if fitted else ():
            fit = growth(own, shape)
            line |= {f"{shape}_{name}": getattr(fit, name, np.nan) for name in ("power", "low", "high")}
        found.append(line if line["with_points"] else line | {"kept": np.nan})
    return pd.DataFrame(found).sort_values(["with_points", "time_ratio"], ascending=[True, False], ignore_index=True)


def _said(row) -> str:
    other, faster = label(REFERENCE), (1 / row.time_ratio, 1 / row.time_high, 1 / row.time_low)
    error = row.error_ratio, row.error_low, row.error_high
    power = row.loglinear_power, row.loglinear_low, row.loglinear_high
    return (
        f"{label(OURS)}, {'points' if row.with_points else 'nothing'} kept: {with_interval(*faster)} times as fast as "
        f"{other}. Its Metro error is {with_interval(*error)} times {other}'s. Its time grows as (n log n)^p, p = "
        f"{with_interval(*power, places=2)}."
    )


def _wide(frame: pd.DataFrame) -> pd.DataFrame:
    def texts(name: str, middle: str = "ratio", places: int | None = None) -> list[str]:
        rows = frame[[f"{name}_{middle}", f"{name}_low", f"{name}_high"]].itertuples(index=False)
        return [with_interval(*row, places=places).replace("not run", "–") for row in rows]

    counts, shares = frame.astype(str), frame[["kept", "valid"]].map(lambda share: f"{percent(share)} %")
    return pd.DataFrame({
        "backend": frame["backend"].map(label), "points kept": np.where(frame["with_points"], "yes", "no"),
        **{name: counts[name] + " of " + counts["tried"] for name in ("refused", "missed")},
        "cells compared": frame["cells"],
        **{title: texts(name) for name, title in RATIOS.items()},
        "slowest": frame["slowest"], **shares.replace("– %", "–"),
        **{f"growth: p of {title}": texts(shape, "power", 2) for shape, title in GROWTHS.items()},
        "meshes": frame["meshes"],
    })  # fmt: skip

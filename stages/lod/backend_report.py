"""Backends of simplification as a table: time and error as ratios to pymeshlab's QEM, of one `make bench`.

`growth` fits a backend's time by a power of n, or of n log n, with its interval.
"""

from collections.abc import Callable

import numpy as np
import pandas as pd

from stages.charts.drawing import label
from stages.charts.items import Table, shared_notes
from stages.charts.results import NotRun, Results
from stages.charts.tables import interval_columns, percent, with_interval
from stages.engine.statistics import interval

REFERENCE, OURS = "pymeshlab", "fast"
CELL, TASK = ["mesh", "full", "target", "with_points"], ["backend", "with_points"]
RATIOS = {  # first part of a column's name -> title
    "time": "time ratio", "whole": "all of simplify", "colours": "with colours",
    "error": "Metro ratio", "largest": "largest-error ratio", "seen": "1 − SSIM ratio",
}  # fmt: skip
GROWTHS = {"linear": "n^p", "loglinear": "(n log n)^p"}
ANSWER = ["backend", "points kept", *(RATIOS[name] for name in ("time", "error", "largest", "seen")), "valid"]


FITTED = 10_000  # faces from which the growth is fitted: below, the fixed cost of a call counts
POWERS: dict[str, Callable] = {"linear": lambda n: n, "loglinear": lambda n: n * np.log(n)}


def growth(rows: pd.DataFrame, shape: str = "loglinear") -> tuple[float, float, float]:
    """(power, low, high) of the seconds over the faces `full`; NaN for fewer than three sizes of FITTED faces or more.

    rows: of one backend; shape: of POWERS. A least-squares line through the logarithms, with a level of its own for
    each share of the faces and for kept points. The interval is a bootstrap over the meshes: a subdivided one goes
    with what it was.
    """
    rows = rows[(rows["full"] >= FITTED) & (rows["seconds"] > 0)]
    if rows["full"].nunique() < 3:
        return np.nan, np.nan, np.nan
    n = rows["full"].to_numpy(dtype=float)
    x, y = np.log(POWERS[shape](n)), np.log(rows["seconds"].to_numpy(dtype=float))
    level = pd.factorize(pd.MultiIndex.from_arrays([(rows["target"] / n).round(2), rows["with_points"]]))[0]
    mesh, names = pd.factorize(rows["mesh"])
    random = np.random.default_rng(0)
    picks = (random.multinomial(len(names), np.full(len(names), 1 / len(names))) for _ in range(1000))
    low, high = np.nanquantile([_slope(x, y, level, times[mesh]) for times in picks], [0.025, 0.975])
    return _slope(x, y, level, np.ones(len(x))), float(low), float(high)


def _slope(x: np.ndarray, y: np.ndarray, level: np.ndarray, weight: np.ndarray) -> float:
    """Weighted least-squares slope with an intercept for each level; NaN where no level has two places."""
    total = np.maximum(np.bincount(level, weight), 1e-9)
    x, y = (values - (np.bincount(level, weight * values) / total)[level] for values in (x, y))
    spread = (weight * x * x).sum()
    return (weight * x * y).sum() / spread if spread > 1e-12 else np.nan


def backends_table(results: Results) -> Table:
    """A row a backend, without and with points to keep."""
    rows = tried(results)
    frame = summarised(rows, fitted=True)
    cells = rows.drop_duplicates(CELL)
    sources, kept = rows.groupby("source", sort=False)["mesh"].nunique(), cells.loc[cells["with_points"], "kept_points"]
    words = {
        "measured": shared_notes(__package__, "timed"),
        "sources": ", ".join(f"{count} {source}" for source, count in sources.items()),
        "least": rows["full"].min(), "most": rows["full"].max(), "cells": len(cells), "with_points": len(kept),
        "kept": f"{kept.min()} to {kept.max()}" if len(kept) else "no",
        "infeasible": (cells["outcome"] == "infeasible").sum(), "fitted": FITTED,
    }  # fmt: skip
    # no ranking: time stands against error
    return Table(frame, _wide(frame), words, answer=ANSWER, keys=ANSWER[:2])


def tried(results: Results) -> pd.DataFrame:
    """The rows of bench/simplification.csv.gz, with with_points and RATIOS' columns; NotRun without outcomes."""
    rows = results.bench("simplification").rename(columns={"ratio": "time_ratio"})
    if "outcome" not in rows:
        raise NotRun("bench/simplification.csv.gz has no outcomes: `make bench` writes it anew", "lod", runnable=False)
    rows = rows.assign(with_points=rows["kept_points"] > 0)
    rows["base"] = rows["ssim_error"].where((rows["backend"] == REFERENCE) & (rows["ssim_error"] > 0))
    return rows.assign(seen_ratio=rows["ssim_error"] / rows.groupby(CELL)["base"].transform("first"))


def common(rows: pd.DataFrame) -> pd.DataFrame:
    """The rows of the cells that all backends of their task (with points, or without) reached."""
    reached_rows = rows[rows["outcome"] == "reached"]
    total = rows.groupby("with_points")["backend"].nunique()
    count = reached_rows.groupby(CELL)["backend"].transform("nunique")
    return reached_rows[count == reached_rows["with_points"].map(total)]


def summarised(rows: pd.DataFrame, fitted: bool = False) -> pd.DataFrame:
    """A row a backend, without and with points to keep: refusals, ratios of time and errors; fitted: and growth."""
    paired, lines = common(rows), []
    for key, group in rows.groupby(TASK, sort=False):
        cells, outcomes = paired[(paired[TASK] == key).all(axis=1)], group["outcome"].value_counts()
        line = dict(zip(TASK, key, strict=True)) | {"meshes": cells["mesh"].nunique(), "cells": len(cells)}
        line |= {"tried": len(group) - outcomes.get("infeasible", 0)}
        line |= {name: outcomes.get(name, 0) for name in ("refused", "missed")}
        for name in RATIOS:
            ratios = over_meshes(cells.set_index("mesh")[f"{name}_ratio"])
            line |= interval_columns(f"{name}_ratio", ratios, prefix=f"{name}_")
        line |= {"slowest": cells["time_ratio"].max(), "seconds": cells["seconds"].median()}
        reached_rows = group[group["outcome"] == "reached"]
        line |= {name: reached_rows[name].dropna().astype(bool).mean() for name in ("kept", "valid")}
        for shape in GROWTHS if fitted else ():
            line |= zip((f"{shape}_{name}" for name in ("power", "low", "high")), growth(cells, shape), strict=True)
        lines.append(line if line["with_points"] else line | {"kept": np.nan})
    return pd.DataFrame(lines).sort_values(["with_points", "time_ratio"], ascending=[True, False], ignore_index=True)


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


def over_meshes(ratios: pd.Series) -> tuple[float, float, float]:
    """(mean, low, high) of ratios with a level `mesh`: geometric, over the meshes; of positive ratios alone."""
    mean, low, high = np.exp(interval(ratios[ratios > 0].apply(np.log).groupby("mesh").mean()))
    return float(mean), float(low), float(high)

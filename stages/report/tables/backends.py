"""Who simplifies: time and error of each backend as ratios to pymeshlab's QEM, timed in one run of `make bench`."""

from dataclasses import dataclass

import numpy as np
import pandas as pd
from scipy import stats

from stages.report.intervals import interval
from stages.report.items import Table
from stages.report.markdown import with_interval
from stages.report.style import label

REFERENCE = "pymeshlab"
FITTED = 10_000  # faces from which the growth is fitted: below, the fixed cost of a call counts
NOTES = [
    "Time, Metro and SSIM: geometric means over the meshes of the ratio to pymeshlab's QEM of the same mesh, target "
    "and kept points, in the same run on one core [95 % interval over the meshes]; below 1 is faster, or closer. "
    "Slowest: the largest time ratio of all cells.",
    "Kept: share of the cells in which all kept vertices survived bit for bit; valid: share without new folded, "
    "degenerate or non-manifold faces. Growth: p of the fit seconds = c (n log n)^p over the faces n of the mesh [95 % "
    "interval of the regression]; 1 or less grows no faster than n log n.",
]


@dataclass(frozen=True)
class Growth:
    """seconds = factor (n log n)^power, with the 95 % interval of the power, over `span` faces."""

    factor: float
    power: float
    low: float
    high: float
    span: tuple[float, float]

    def __call__(self, n):
        return self.factor * (n * np.log(n)) ** self.power


def build(results):
    rows = results.bench("simplification")
    frame = summarised(rows)
    fits = {backend: growth(group) for backend, group in rows.groupby("backend", sort=False)}
    for name in ("power", "low", "high"):
        frame[f"growth_{name}"] = [getattr(fits[backend], name, np.nan) for backend in frame["backend"]]
    return Table("Simplification: backends", frame, [_meshes(rows), *NOTES], _wide(frame))


def summarised(rows):
    """A row a backend, without and with points to keep: ratios of time, Metro and SSIM error, kept, valid.

    rows: of benchmarks' simplification.csv.
    """
    rows = rows.assign(with_points=rows["kept_points"] > 0)
    cell = ["mesh", "target", "kept_points"]
    base = rows[rows["backend"] == REFERENCE].drop_duplicates(cell).set_index(cell)["ssim_error"]
    rows = rows.join(base.rename("base"), on=cell)
    rows["seen_ratio"] = rows["ssim_error"] / rows["base"].where(rows["base"] > 0)
    found = []
    for (backend, with_points), group in rows.groupby(["backend", "with_points"], sort=False):
        line = {"backend": backend, "with_points": bool(with_points), "meshes": group["mesh"].nunique()}
        for name, column in (("time", "ratio"), ("error", "error_ratio"), ("seen", "seen_ratio")):
            line |= dict(zip((f"{name}_ratio", f"{name}_low", f"{name}_high"), _ratio(group, column), strict=True))
        line |= {"slowest": group["ratio"].max(), "seconds": group["seconds"].median()}
        kept = _share(group["kept"]) if with_points else np.nan
        found.append(line | {"kept": kept, "valid": _share(group["valid"])})
    return pd.DataFrame(found).sort_values(["with_points", "time_ratio"], ascending=[True, False], ignore_index=True)


def growth(rows):
    """The Growth of a backend's seconds, or None for fewer than three sizes of mesh with FITTED faces or more.

    A least-squares line through the logarithms.
    """
    rows = rows[(rows["full"] >= FITTED) & (rows["seconds"] > 0)]
    if rows["full"].nunique() < 3:
        return None
    n = rows["full"].to_numpy(dtype=float)
    fit = stats.linregress(np.log(n * np.log(n)), np.log(rows["seconds"]))
    reach = stats.t.ppf(0.975, len(n) - 2) * fit.stderr
    return Growth(np.exp(fit.intercept), fit.slope, fit.slope - reach, fit.slope + reach, (n.min(), n.max()))


def _ratio(group, column):
    """(geometric mean, low, high) over the meshes."""
    logs = np.log(group[column].where(group[column] > 0)).groupby(group["mesh"]).mean()
    return tuple(np.exp(interval(logs)))


def _share(column):
    """Share of the cells that are true; empty ones do not count."""
    known = column.dropna().astype(str).str.lower()
    return (known == "true").mean() if len(known) else np.nan


def _meshes(rows):
    counts = ", ".join(f"{n} {source}" for source, n in rows.groupby("source", sort=False)["mesh"].nunique().items())
    return f"Meshes: {counts}; {rows['full'].min():,} to {rows['full'].max():,} faces."


def _wide(frame):
    shown = pd.DataFrame({"backend": frame["backend"].map(label)})
    shown["points kept"] = ["yes" if kept else "no" for kept in frame["with_points"]]
    for name, title in (("time", "time ratio"), ("error", "Metro ratio"), ("seen", "1 − SSIM ratio")):
        columns = frame[[f"{name}_ratio", f"{name}_low", f"{name}_high"]]
        shown[title] = [with_interval(*row) for row in columns.itertuples(index=False)]
    shown["slowest"] = frame["slowest"]
    for name in ("kept", "valid"):
        shown[name] = [f"{100 * share:.0f} %" if share == share else "–" for share in frame[name]]
    power = frame[["growth_power", "growth_low", "growth_high"]]
    shown["growth p"] = [with_interval(*row, places=2) for row in power.itertuples(index=False)]
    return shown.assign(meshes=frame["meshes"])

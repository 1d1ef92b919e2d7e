"""Levels of detail: statistics of claims, error against cost, and the growth of time with the number of faces.

`simplification` draws error against the seconds to find the points and to simplify, with a front at each share of the
faces. `growth` fits a backend's time by a power of n, or of n log n, with its interval.
"""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
import pandas as pd
from matplotlib.figure import Figure as Drawing

from stages.engine.statistics import interval
from stages.report.claims import Claim
from stages.report.drawing import INK, MARKERS, WAYS, colours, label, plain_logarithm, plt
from stages.report.effects import invalid_pairs, reasons_of, statistic
from stages.report.items import Figure
from stages.report.pareto import ON, attention_seconds, noise_by, placed
from stages.report.results import NotRun, Results, listed, some
from stages.report.tables import means, with_interval

from .tables import (
    CELL,
    CLASSICAL,
    ERRORS,
    HKS,
    METRICS,
    OURS,
    PLAIN,
    QSLIM,
    UNITS,
    WEIGHTED,
    is_drawn,
    paired_cells,
    size,
)

MANY = 5  # methods that a rank correlation needs


@statistic("spread")
def spread(results: Results, claim: Claim) -> pd.Series:
    """Standard deviation over the methods of the first side, under the first selection minus under the second."""
    tables = (_errors(results, claim, claim.first["method"], **where) for where in claim.contrast or ())
    first, second = (table.std(axis=1).droplevel("target") for table in tables)
    return first - second


@statistic("falls_with_faces")
def falls_with_faces(results: Results, claim: Claim) -> pd.Series:
    """Error at the fewest faces minus error at the largest number, of objects with several counts."""
    rows = results.measured(claim.stage, claim.sets[0], **claim.where, **claim.first).sort_values("faces")
    rows = _valid(results, claim, rows)
    rows = rows[rows.groupby("item")["faces"].transform("nunique") > 1]
    some(rows, "no object that is taken to two face counts", claim.stage, runnable=False)
    errors = rows.groupby("item")["value"]
    return errors.first() - errors.last()


@statistic("room")
def room(results: Results, claim: Claim) -> pd.Series:
    """Minus the relative difference from the second side of the method and metric whose interval leaves least room.

    With the claim's margin, an equivalence test by the interval: above zero where the whole interval of the difference
    lies within the margin (Schuirmann 1987, with the 95 % interval instead of 90 %: stricter).
    """
    base, gaps = claim.other["method"], []
    for metric in listed(claim.where["metric"]):
        table = _errors(results, claim, (base, *claim.first["method"]), metric=metric)
        if base not in table or table.shape[1] < 2:
            raise NotRun(f"lod did not run {base} beside another", claim.stage, runnable=False)
        middle = (table.add(table[base], axis=0) / 2).where(lambda mean: mean > 0, 1.0)
        shares = table.sub(table[base], axis=0) / middle
        gaps += [shares[name].groupby("item").mean() for name in table if name != base]
    return min((side * gap for gap in gaps for side in (-1, 1)), key=lambda series: interval(series)[1])


@statistic("ranks_agree")
def ranks_agree(results: Results, claim: Claim) -> pd.Series:
    """Rank correlation over the methods, per object, of the metrics of both sides; of the points without a second.

    Methods with a way behind their name keep the same points in another way and are left out.
    """
    metric = str(claim.first["metric"])
    errors = _by_method(results, claim, metric, "value")
    if errors.empty or errors.shape[1] < MANY:
        raise NotRun(f"fewer than {MANY} methods to rank", claim.stage, runnable=False)
    second = (str(claim.other["metric"]), "value") if claim.second else (metric, "points")
    return errors.corrwith(_by_method(results, claim, *second), axis=1, method="spearman")


def _errors(results: Results, claim: Claim, methods: tuple[str, ...], **where: object) -> pd.DataFrame:
    """Frame (object, target) x methods, where all of the methods that were run reach the target."""
    rows = results.measured(claim.stage, claim.sets[0], **{**claim.where, **where}, method=methods)
    table = _valid(results, claim, rows).pivot(index=CELL, columns="method", values="value").dropna()
    return some(table, f"no target that all of {', '.join(methods)} reach", claim.stage, runnable=False)


def _valid(results: Results, claim: Claim, rows: pd.DataFrame) -> pd.DataFrame:
    """The rows without those of an object and target at which a method's row is invalid."""
    bad = invalid_pairs(rows, reasons_of(results, claim, rows), CELL).index
    return rows[~pd.MultiIndex.from_frame(rows[CELL]).isin(bad)] if len(bad) else rows


def _by_method(results: Results, claim: Claim, metric: str, column: str) -> pd.DataFrame:
    """Frame objects x methods of a column, mean over the targets that all methods reach; no objects without ranks."""
    rows = results.measured(claim.stage, claim.sets[0], **claim.where, metric=metric)
    rows = rows[[is_drawn(name) and name not in (PLAIN, QSLIM) for name in rows["method"]]]
    method_counts = rows.groupby(CELL)["method"].transform("nunique")
    rows = rows[method_counts == rows["method"].nunique()]
    table = rows.pivot_table(index="item", columns="method", values=column)
    return table[table.nunique(axis=1) > 1]


# As many as have a colour of their own; the other methods are in figures 3.4 and 3.5.
METHODS = [PLAIN, OURS, f"{OURS}-soft", CLASSICAL, WEIGHTED, f"{WEIGHTED}-adaptive", "random", HKS]
DRAWN = (*METRICS, "salient_error")


def simplification(results: Results) -> Figure:
    """Three errors against cost as a ratio to plain QEM, with a front for each share of the faces."""
    rows = paired_cells(results, DRAWN, METHODS)
    rows = rows[rows["target"].str.endswith("%")]
    if PLAIN not in set(rows["method"]):
        message = "no share of the faces that plain QEM and all methods reach on the same object"
        raise NotRun(message, "lod", runnable=False)
    frame = _costed(rows, attention_seconds(results), noise_by(results.clock("lod")))
    targets = sorted(set(frame["target"]), key=size)
    objects = rows.groupby("target")["item"].nunique()
    plain = frame.query("method == @PLAIN and target == @targets[0]")["seconds"].iloc[0]
    words = {
        "methods": ", ".join(map(label, frame["method"].unique())), "targets": ", ".join(targets),
        "milliseconds": 1000 * plain, "first": targets[0],
        "over": ", ".join(f"{target}: {objects[target]} objects" for target in targets),
    }  # fmt: skip
    return Figure(_draw(frame, targets), words, frame, dpi=100)


def _costed(rows: pd.DataFrame, search: dict[str, float], noise: float) -> pd.DataFrame:
    """A row a metric, method and share: mean error in its unit, cost with the seconds of the search, and front."""
    frame = pd.DataFrame(means(rows, ["metric", "method", "target"]))
    base = frame["method"].str.replace(f"-({'|'.join(WAYS)})$", "", regex=True)
    frame = frame.assign(looked=base.map({**search, PLAIN: 0.0})).dropna(subset=["looked"])
    plain = frame["seconds"].where(frame["method"] == PLAIN).groupby([frame["metric"], frame["target"]])
    frame["seconds"] += frame["looked"]
    frame["cost_ratio"] = frame["seconds"] / plain.transform("first")
    ends = ["mean", "low", "high"]
    frame[ends] = frame[ends].mul(frame["metric"].map(UNITS), axis=0)
    for _, group in frame.groupby(["metric", "target"]):
        frame.loc[group.index, "on_front"] = placed(group, "cost_ratio", "mean", "low", noise)["on_front"] == ON
    return frame.astype({"on_front": bool})


def _draw(frame: pd.DataFrame, targets: list[str]) -> Drawing:
    tints = colours([method for method in METHODS if method in set(frame["method"])])
    forms = dict(zip(targets, MARKERS, strict=False))
    metrics = [metric for metric in DRAWN if metric in set(frame["metric"])]
    drawing, panels = plt.subplots(1, len(metrics), figsize=(4.0 * len(metrics), 4.2), squeeze=False)
    for axes, metric in zip(panels[0], metrics, strict=True):
        panel = frame[frame["metric"] == metric]
        for _, group in panel[panel["on_front"]].sort_values("cost_ratio").groupby("target"):
            ends = [*group["cost_ratio"], panel["cost_ratio"].max()]
            axes.step(ends, [*group["mean"], group["mean"].iloc[-1]], where="post", color=INK, lw=0.9, zorder=1)
        columns = panel[["method", "target", "cost_ratio", "mean", "low", "high"]]
        for method, target, cost, mean, *ends in columns.itertuples(index=False):
            axes.plot([cost] * 2, ends, color=tints[method], lw=1.2, alpha=0.5, zorder=2)
            name = f"_{label(method)}, {target}"
            axes.plot(cost, mean, forms[target], color=tints[method], ms=7, mec="white", mew=0.8, zorder=3, label=name)
        unit = "%" if metric == "ssim_error" else "% of the diagonal"
        axes.set(xscale="log", yscale="log", xlabel=f"cost, as a ratio to {label(PLAIN)}", ylabel=unit)
        axes.set_title(ERRORS[metric].removesuffix(", %"), fontsize=10)
        axes.grid(True)
        axes.margins(x=0.1)
        plain_logarithm(axes.xaxis, (1.0,))
        plain_logarithm(axes.yaxis)
    for method, tint in tints.items():
        axes.plot([], [], "o", color=tint, ms=6, label=label(method))
    for target, form in forms.items():
        axes.plot([], [], form, color="none", mec=INK, ms=6, label=f"{target} of the faces")
    axes.plot([], [], color=INK, lw=0.9, label="on the front of a share in 95 % of resamples")
    axes.legend(loc="center left", bbox_to_anchor=(1.02, 0.5), fontsize=9)
    drawing.subplots_adjust(wspace=0.32)
    return drawing


FITTED = 10_000  # faces from which the growth is fitted: below, the fixed cost of a call counts
POWERS: dict[str, Callable] = {"linear": lambda n: n, "loglinear": lambda n: n * np.log(n)}


@dataclass(frozen=True)
class Growth:
    """seconds = level * (shape(n) / shape(middle))^power, with the 95 % interval of the power; shape: of POWERS."""

    shape: str
    level: float
    middle: float
    power: float
    low: float
    high: float
    span: tuple[float, float]

    def __call__(self, n: np.ndarray, power: float | None = None) -> np.ndarray:
        """Seconds at n faces; power: another than the fitted, through the same middle."""
        shape = POWERS[self.shape]
        return self.level * (shape(n) / shape(self.middle)) ** (self.power if power is None else power)

    @property
    def text(self) -> str:
        """`1.04 [0.90, 1.11]`: the power with its interval."""
        return with_interval(self.power, self.low, self.high, places=2)


def growth(rows: pd.DataFrame, shape: str = "loglinear") -> Growth | None:
    """The Growth of the column `seconds` over `full`, or None for fewer than three sizes of FITTED faces or more.

    rows: of one backend. A least-squares line through the logarithms, with a level of its own for each share of the
    faces and for kept points. The interval is a bootstrap over the meshes: a subdivided one goes with what it was.
    """
    rows = rows[(rows["full"] >= FITTED) & (rows["seconds"] > 0)]
    if rows["full"].nunique() < 3:
        return None
    n = rows["full"].to_numpy(dtype=float)
    x, y = np.log(POWERS[shape](n)), np.log(rows["seconds"].to_numpy(dtype=float))
    level = pd.factorize(pd.MultiIndex.from_arrays([(rows["target"] / n).round(2), rows["with_points"]]))[0]
    mesh, names = pd.factorize(rows["mesh"])
    random = np.random.default_rng(0)
    picks = (random.multinomial(len(names), np.full(len(names), 1 / len(names))) for _ in range(1000))
    low, high = np.nanquantile([_slope(x, y, level, times[mesh]) for times in picks], [0.025, 0.975])
    power, middle = _slope(x, y, level, np.ones(len(x))), np.exp(np.log(n).mean())
    offset = (y - power * (x - np.log(POWERS[shape](middle)))).mean()
    return Growth(shape, np.exp(offset), middle, power, low, high, (n.min(), n.max()))


def _slope(x: np.ndarray, y: np.ndarray, level: np.ndarray, weight: np.ndarray) -> float:
    """Weighted least-squares slope with an intercept for each level; NaN where no level has two places."""
    total = np.maximum(np.bincount(level, weight), 1e-9)
    x, y = (values - (np.bincount(level, weight * values) / total)[level] for values in (x, y))
    spread = (weight * x * x).sum()
    return (weight * x * y).sum() / spread if spread > 1e-12 else np.nan

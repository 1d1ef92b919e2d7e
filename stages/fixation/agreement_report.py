"""Agreement of the networks' maps with people and between tasks, and its cost (T figures 3.28, 3.31, 3.32, 3.35, 3.36).

`build` is the table of T figures 3.35 and 3.36, `chart` sets agreement against seconds. T figure 3.28 shows the number
of classes of objects by shape, T figure 3.31 the correlation between the tasks' maps. The distance is between centres
of fixation. The thesis compares distances by a box plot over all views (T figure 3.36), so the claims compare
quantiles by `below`.
"""

from collections.abc import Callable, Collection, Iterator
from functools import partial
from itertools import product
from typing import Any

import numpy as np
import pandas as pd
from matplotlib.axes import Axes
from matplotlib.ticker import MaxNLocator

from stages.charts.datasets import dataset_text
from stages.charts.drawing import CYCLE, GREY, INK, MAP, PALE, colours, label, plain_logarithm, plt
from stages.charts.items import Figure, Table
from stages.charts.pareto import pareto_chart
from stages.charts.results import Results
from stages.charts.tables import Ranking, everywhere, grouped, number, records, signed, with_interval, within
from stages.engine.statistics import interval
from stages.fixation.agreement_rows import (
    FUSED,
    KINDS,
    LEE,
    NOISE,
    PRIOR,
    TASKS,
    Detector,
    detectors,
    network_text,
    networks,
    no_people,
    scores,
    sources,
    task_text,
    untrained,
    with_random_weights,
)
from stages.fixation.tasks import SHAPE_MEASURES

METRICS = {"pcc": "PCC", "pcc_masked": "PCC, the thesis's way", "nss": "NSS", "auc": "AUC",
           "distance": "distance, %", "distance_maximum": "distance of the maxima, %",
           "distance_mean": "distance, mean of pairs, %", "half_share": "half of it on, %"}  # fmt: skip
RANGES = {"half_share": (0, 100), "pcc": (-1, 1), "pcc_masked": (-1, 1), "nss": (-np.inf, np.inf), "auc": (0, 1)}
OPPONENTS = {"weights": "random weights", "prior": "centre prior", "lee": "mesh saliency"}
REFERENCE = "mobilenet_v2-frozen"
ENDS = ("", "_low", "_high")  # of the columns of what a detector has more than an opponent


def build(results: Results) -> Table:
    """Agreement of every detector with people in all metrics, beside what it has more than its controls."""
    truths = sources(results)
    frame = pd.DataFrame([line for source, rows in truths.items() for line in _lines(source, rows)])
    rows = results.rows("fixation").reindex(columns=["method", "task", "value", "note"])
    absent_rows = rows[rows["value"].isna() & rows["task"].isna()].dropna(subset=["note"])  # networks as a whole
    words = {
        "no_people": no_people(truths).strip(),
        "not_run": "\n".join(f"Not run here: {network_text(row.method)}: {row.note}." for row in records(absent_rows)),
    }
    text_table = _wide(frame)
    gains = [f"it − {OPPONENTS[name]}, PCC" for name in ("weights", "lee")]
    answer = ["detector", *(METRICS[name] for name in ("pcc_masked", "pcc", "nss", "auc")), *gains, "seconds"]
    best = Ranking([METRICS[name] for name in ("pcc_masked", "pcc", "nss", "auc")])
    return Table(frame, text_table, words, best, answer, split="truth")


def _lines(source: str, rows: pd.DataFrame) -> Iterator[dict[str, Any]]:
    tables = {metric: scores(rows, metric) for metric in METRICS if (rows["metric"] == metric).any()}
    seconds = _looking(rows)
    for name in sorted(detectors(tables["pcc"]), key=lambda name: -tables["pcc"][name].mean()):
        line = {"truth": source, "detector": name.text, **name._asdict(), "kind": name.kind}
        for metric, table in tables.items():
            if name in table:
                mean, low, high = within(table[name], 0, *RANGES.get(metric, (0, np.inf)))
                statistics = {"metric": metric, "objects": table[name].count(), "mean": mean, "low": low, "high": high}
                gains = _gains(table, name) if metric in ("pcc", "distance") else {}
                yield line | statistics | {"seconds": seconds.get(name.method)} | gains


def _looking(rows: pd.DataFrame) -> pd.Series:
    """Seconds of the median object by method: all views drawn, looked at and put on the surface."""
    timed_rows = rows[rows["metric"] == "pcc"].dropna(subset=["seconds"]).drop_duplicates(["item", "method"])
    return timed_rows.groupby("method")["seconds"].median()


def _gains(table: pd.DataFrame, name: Detector) -> dict[str, float]:
    """How much more the detector has than each opponent, paired over the objects; empty where that is not measured."""
    gains, rivals = {}, {"prior": PRIOR, "lee": LEE, "weights": name._replace(method=with_random_weights(name.method))}
    for key, rival in rivals.items():
        if rival in table and rival != name:
            gains |= zip((f"over_{key}{end}" for end in ENDS), interval(table[name] - table[rival]), strict=True)
    return gains


def _wide(frame: pd.DataFrame) -> pd.DataFrame:
    text = [with_interval(row.mean, row.low, row.high, places=1 if row.metric in list(METRICS)[4:] else 2)
            for row in records(frame[["metric", "mean", "low", "high"]])]  # fmt: skip
    wide = frame.assign(text=text).pivot(index=["truth", "detector"], columns="metric", values="text")
    wide = wide.reindex(columns=list(METRICS)).fillna("–").rename(columns=METRICS).rename_axis(columns=None)
    best_first = frame[frame["metric"] == "pcc"].set_index(["truth", "detector"])
    wide = wide.loc[best_first.index]
    for key, title in OPPONENTS.items():
        gains = best_first.reindex(columns=[f"over_{key}{end}" for end in ENDS]).astype(float).itertuples(index=False)
        wide[f"it − {title}, PCC"] = [signed(*gain) if gain[0] == gain[0] else "–" for gain in gains]
    return wide.assign(seconds=best_first["seconds"].map(number)).reset_index()


def chart(results: Results) -> Figure:
    """Agreement of the fused maps with people against the seconds of training and looking."""
    source, rows = next(iter(sources(results).items()))
    table = scores(rows, "pcc")
    maps = {method: table[method, FUSED] for method in networks(rows) if (method, FUSED) in table}
    timed_rows = rows.dropna(subset=["seconds"])
    objects = timed_rows[timed_rows["metric"] == "views"].groupby("method")["item"].nunique()
    lessons = timed_rows[timed_rows["metric"] == "accuracy"].drop_duplicates(["method", "task", "seconds"])
    teaching = lessons.groupby("method")["seconds"].sum()
    frame = pd.DataFrame(map(interval, maps.values()), list(maps), ["mean", "low", "high"])
    frame = frame.assign(objects=objects, teaching=teaching, looking=_looking(rows))
    frame = frame.fillna({"objects": 0, "teaching": 0})
    frame["seconds"] = frame["teaching"] + frame["objects"] * frame["looking"]
    frame.insert(0, "name", list(map(network_text, maps)))
    figure = pareto_chart(
        frame, "mean", title="Where networks look: what training costs",
        reference=network_text(REFERENCE), quality_label=f"PCC, {source}",
        clock=results.clock("fixation", rows["dataset"].iloc[0]),
        units=pd.DataFrame(maps).rename(columns=network_text),
    )  # fmt: skip
    figure.words |= {"source": source, "saved": _saved(maps)}
    return figure


def _saved(maps: dict[str, pd.Series]) -> str:
    """The change by training more than a head, paired over the objects; maps: {network: PCC of its fused maps}."""
    changes = []
    for method, pcc in maps.items():
        frozen = f"{method.rpartition('-')[0]}-frozen"
        if frozen != method and frozen in maps and not untrained(method):
            changes.append(f"{network_text(method)} minus frozen: PCC {(pcc - maps[frozen]).mean():+.2f}")
    return f"{'; '.join(changes)}." if changes else "No network was fine-tuned here."


# A set's colour, and where its chosen number stands, in points.
ELBOWS = ((CYCLE[0], (-14, -7)), (CYCLE[1], (7, 6)), (CYCLE[2], (-16, -9)))


def figure_3_28(results: Results) -> Figure:
    """The elbow of k-means in the sums of squares, by task of shape and data set."""
    by_set = everywhere(results, "fixation", "no sums of squares: the objects do not differ in shape", metric="ssd")
    rows = pd.concat(by_set.values())
    rows["chosen"] = rows["chosen"].astype(str) == "True"
    curves = dict(grouped(rows, ["task", "dataset"]))
    tasks = [task for task in SHAPE_MEASURES if task in set(rows["task"])]
    figure, (grid,) = plt.subplots(1, len(tasks), figsize=(3.5 * len(tasks), 3.0), squeeze=False)
    for axes, task in zip(grid, tasks, strict=True):
        for (tint, beside), dataset in zip(ELBOWS, by_set, strict=False):
            if (task, dataset) in curves:
                _elbow(axes, curves[task, dataset].sort_values("clusters"), dataset_text(dataset), tint, beside)
        axes.plot([], [], "o", mfc="none", mec=INK, mew=1.8, ms=10, label="chosen")
        axes.set(title=label(task), xlabel="clusters", ylim=(0, 1.15))
        axes.xaxis.set_major_locator(MaxNLocator(integer=True))
        axes.grid(axis="y")
    grid[0].set_ylabel("sum of squared distances,\nover that of the fewest clusters")
    grid[-1].legend(fontsize=8.5)
    figure.tight_layout()
    sets = [f"{dataset_text(dataset)}: {', '.join(f'{label(row.task)} {row.clusters:g}' for row in records(elbows))}"
            for (dataset,), elbows in grouped(rows[rows["chosen"]], ["dataset"])]  # fmt: skip
    return Figure(figure, {"chosen": "; ".join(sets)})


def _elbow(axes: Axes, rows: pd.DataFrame, source: str, tint: str, beside: tuple[int, int]) -> None:
    share = rows["value"] / rows["value"].iloc[0]
    axes.plot(rows["clusters"], share, "-o", color=tint, ms=4, lw=1.3, label=source)
    for spot in zip(rows["clusters"][rows["chosen"]], share[rows["chosen"]], strict=True):
        axes.plot(*spot, "o", mfc="none", mec=INK, mew=1.8, ms=10)
        axes.annotate(f"{spot[0]:g}", spot, beside, textcoords="offset points", color=INK, fontsize=9)


def figure_3_31(results: Results) -> Figure:
    """A matrix a network: the correlation of the maps of each two tasks."""
    source, rows = next(iter(sources(results, "pcc_tasks").items()))
    methods, rows = networks(rows), rows[rows["metric"] == "pcc_tasks"]
    across = min(4, len(methods))
    down = -(-len(methods) // across)
    figure, grid = plt.subplots(down, across, figsize=(3.6 * across + 0.5, 3.3 * down), squeeze=False)
    for axes, method in zip(grid.flat, methods, strict=False):
        pairs = rows[rows["method"] == method].pivot_table(index="item", columns="task", values="value", sort=False)
        _matrix(axes, pairs.mean())
        mean = with_interval(*within(pairs.mean(axis=1), least=-1), places=2)
        axes.set_title(f"{network_text(method)}\nmean {mean}", fontsize=9.5, fontweight="normal", loc="center")
    for axes in grid.flat[len(methods) :]:
        axes.set_axis_off()
    figure.tight_layout(w_pad=2)
    figure.colorbar(grid[0, 0].images[0], ax=grid, shrink=0.7, pad=0.015, aspect=22).set_label("PCC")
    return Figure(figure, {"source": source, "networks": "; ".join(map(network_text, methods))})


def _matrix(axes: Axes, means: pd.Series) -> None:
    """The lower triangle of the matrix, with its numbers; means: by `TASK~TASK`."""
    task_names = set("~".join(means.index).split("~"))
    tasks = [task for task in TASKS if task in task_names]
    matrix = np.full((len(tasks) - 1, len(tasks) - 1), np.nan)
    for pair, value in means.items():
        across, down = sorted(map(tasks.index, str(pair).split("~")))
        matrix[down - 1, across] = value
        tint = INK if value > 0.62 else "white"  # from there on the cell is bright
        axes.text(across, down - 1, f"{value:.2f}", ha="center", va="center", color=tint, fontsize=8)
    names = list(map(label, tasks))
    axes.set_xticks(range(len(tasks) - 1), names[:-1], rotation=40, ha="right", fontsize=8)
    axes.set_yticks(range(len(tasks) - 1), names[1:], fontsize=8)
    axes.tick_params(length=0)
    axes.spines[:].set_visible(False)
    axes.imshow(matrix, cmap=MAP, vmin=0, vmax=1)


LINES = (*TASKS, FUSED)
FLOOR = 0.1  # %: a centre nearer than this is on the spot, and the axis begins there
Tables = dict[str, tuple[pd.DataFrame, pd.DataFrame]]
DOT: dict[str, Any] = {"marker": "o", "ls": "", "ms": 5}
LOOKS = {"finetuned": {"marker": "s"}, "last_block": {"marker": "^"}, "random": {"mfc": "white"}}
DIAMOND = DOT | {"marker": "D", "color": "white", "ms": 4.5}


def figure_3_32(results: Results) -> Figure:
    """Correlation of each task's map with people as T3.3.6 prints it, a row a task, a colour a network."""
    truths = sources(results)
    methods = sorted(dict.fromkeys(method for rows in truths.values() for method in networks(rows)), key=untrained)
    parts = {method: method.rpartition("-") for method in methods}
    paint = colours(list(dict.fromkeys(base for base, *_ in parts.values())))
    marks = {method: DOT | {"color": paint[base]} | LOOKS.get(mode, {}) for method, (base, _, mode) in parts.items()}
    places = (np.arange(len(methods)) - (len(methods) - 1) / 2) * 0.72 / max(len(methods), 3)
    size = (4.0 * len(truths) + 2.6, 1.2 + len(LINES) * max(0.42, 0.14 * len(methods)))
    grid = _panels(truths, list(map(task_text, LINES)), "Pearson's correlation with people", size, 10)
    for axes, rows in zip(grid, truths.values(), strict=True):
        table = scores(rows, "pcc_masked")
        for (y, task), (down, method) in product(enumerate(LINES), zip(places, methods, strict=True)):
            if (method, task) in table:
                _span(axes, table[method, task], y + down, lw=1.5, **marks[method])
        axes.axvline(0, color=INK, lw=0.8)
        axes.axhline(len(TASKS) - 0.5, color=GREY, lw=0.6)
        axes.hlines(np.arange(len(TASKS) - 1) + 0.5, 0, 1, transform=axes.get_yaxis_transform(), color=PALE, lw=0.5)
    for method, mark in marks.items():
        grid[-1].plot([], [], label=network_text(method), **mark)
    return _with_noise(_with_legend(grid, truths), truths)


def figure_3_35(results: Results) -> Figure:
    """Correlation of detectors with people as T3.3.6 prints it, best mean first."""
    tables = {source: (scores(rows, "pcc_masked"), scores(rows, "pcc")) for source, rows in sources(results).items()}
    draw, zero = partial(_span, lw=1.6, mec="white", mew=0.5, **DOT), partial(Axes.axvline, color=INK, lw=0.8)
    grid = _ranked(tables, "mean", "Pearson's correlation with people", draw, zero, zorder=1.9)
    for words, tint in KINDS.values():
        grid[-1].plot([], [], color=tint, label=words, **DOT)
    return _with_noise(_with_legend(grid, tables, "over visible vertices alone"), sources(results))


def _with_noise(figure: Figure, truths: dict[str, pd.DataFrame]) -> Figure:
    """The figure, with what noise has by its correlation on the first truth among its words."""
    source, rows = next(iter(truths.items()))
    figure.words["noise"] = f"{number(scores(rows, 'pcc_masked')[NOISE].mean())} on {source}"
    return figure


def figure_3_36(results: Results) -> Figure:
    """Distance between centres of fixation of detectors and of people, least median first."""
    tables: Tables = {}
    for source, rows in sources(results, "distance").items():
        nearest, pairs = (scores(rows, metric, ("item", "view")) for metric in ("distance", "distance_mean"))
        tables[source] = nearest, pairs.clip(lower=FLOOR)
    axis = "distance, % of the diameter\nof the bounding sphere"
    grid = _ranked(tables, "median", axis, _box, _logarithmic)
    for words, tint in KINDS.values():
        grid[-1].barh([np.nan], [1], color=tint, alpha=0.45, label=words)
    figure = _with_legend(grid, tables, "median of the mean\nover all pairs", "of")
    nearest, _ = next(iter(tables.values()))
    praised = nearest.columns[nearest.columns.get_level_values("task").isin([FUSED, "leifman"])]
    figure.words["near"] = number(100 * (nearest[praised].stack([0, 1]) < FLOOR).mean())
    return figure


def _panels(truths: Collection[str], names: list[str], axis: str, size: tuple[float, float], font: float) -> np.ndarray:
    """Axes: a panel for each truth, one row per name."""
    _, (grid,) = plt.subplots(1, len(truths), figsize=size, squeeze=False, sharey=True, sharex=True)
    grid[0].set_yticks(range(len(names)), names, fontsize=font)
    grid[0].set_ylim(len(names) - 0.4, -0.6)
    for axes, source in zip(grid, truths, strict=True):
        axes.grid(axis="x")
        axes.tick_params(axis="y", length=0)
        axes.set_title(source, fontsize=10, fontweight="normal")
        axes.set_xlabel(axis)
    return grid


def _ranked(
    tables: Tables, middle: str, axis: str, draw: Callable, finish: Callable[[Axes], object], zorder: float = 2
) -> np.ndarray:
    """Axes: a row a detector, in the order of the first truth that has it; diamonds: middles of its second scores."""
    order = pd.concat([table[detectors(table)].agg(middle) for table, _ in tables.values()])
    order = order[~order.index.duplicated()].sort_values(ascending=middle == "median", kind="stable")
    names = [Detector(*name) for name in order.index]
    size = (3.9 * len(tables) + 3.6, 1.0 + 0.26 * len(names))
    grid = _panels(tables, [name.text for name in names], axis, size, 8.5)
    for axes, (table, beside) in zip(grid, tables.values(), strict=True):
        axes.hlines(range(len(names)), 0, 1, transform=axes.get_yaxis_transform(), color=PALE, lw=0.4, zorder=0)
        for y, name in enumerate(names):
            tint = KINDS[name.kind][1]
            if name in table:
                draw(axes, table[name], y, tint)
            if name in beside:
                axes.plot(beside[name].agg(middle), y, mec=tint, mew=1.1, zorder=zorder, **DIAMOND)
        finish(axes)
    return grid


def _with_legend(grid: np.ndarray, truths: Collection[str], diamond: str = "", joint: str = "with") -> Figure:
    if diamond:
        grid[-1].plot([], [], mec=INK, label=diamond, **DIAMOND)
    grid[-1].legend(loc="center left", bbox_to_anchor=(1.01, 0.5), fontsize=8.5)
    drawing = grid[-1].figure
    drawing.tight_layout()
    return Figure(drawing, {"sources": f" and {joint} ".join(truths), "no_people": no_people(truths), "floor": FLOOR})


def _span(axes: Axes, values: pd.Series, y: float, color: str, lw: float, **mark: Any) -> None:
    """The mean of values as a mark, and its interval as a line."""
    mean, low, high = interval(values)
    axes.plot([low, high], [y, y], color=color, lw=lw, alpha=0.5)
    axes.plot(mean, y, color=color, **mark)


def _logarithmic(axes: Axes) -> None:
    axes.set(xscale="log", xlim=(FLOOR, None))
    plain_logarithm(axes.xaxis, (1.0,))


def _box(axes: Axes, values: pd.Series, y: int, tint: str) -> None:
    """Quartiles as a box, the median as a line in it, and 5 to 95 % as whiskers."""
    low, left, middle, right, high = np.maximum(values.quantile([0.05, 0.25, 0.5, 0.75, 0.95]), FLOOR)
    axes.plot([low, high], [y, y], color=tint, lw=0.9)
    axes.barh(y, right - left, 0.6, left, color=tint, alpha=0.45)
    axes.plot([middle] * 2, [y - 0.3, y + 0.3], color=INK, lw=1.3)

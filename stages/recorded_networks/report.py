"""Networks and simulated imprints on recorded touches: accuracies, gains over controls, and costs (T5.4).

`build` has every network for photographs, `printed` the networks of T tables 5.1, 5.2 and 5.5 beside the thesis's
numbers, and `chart` accuracy against cost. `build_table` compares real touches alone with real touches and simulated
imprints, by kNN."""

from collections.abc import Iterable
from contextlib import suppress
from functools import partial

import numpy as np
import pandas as pd
from matplotlib.axes import Axes

from haptic_glance.base.timing import CLOCK
from haptic_glance.know.split import Split, shared_by
from stages.charts.drawing import INK, label, place_names, plain_logarithm, plt
from stages.charts.items import Figure, Table
from stages.charts.pareto import NOISE, ON, lines, placed, ticks
from stages.charts.results import NotRun, Results, require_rows
from stages.charts.tables import (
    Ranking,
    everywhere,
    grouped,
    percent,
    records,
    signed,
    with_interval,
    within,
)
from stages.engine.statistics import interval
from stages.transfer.network_rows import MODES, PASSES, PRINTED, STARTS, of_passes, origin

STAGE = "recorded_networks"
DATA = {
    "pressure": "pressure array, 22 objects",
    "grasps_object": "fingertips, which of 51 objects",
    "grasps_slip": "fingertips, slips or not",
    "vt60": "VT-60 (BathTip)",
    "vitac": "ViTac (GelSight)",
    "bigs": "BiGS (Barrett hand)",
    "bigs_instant": "BiGS, one reading of 7 x 3 cells",
}
SPLITS = {
    Split.RANDOM: "touches at random",
    Split.BLOCKS: "neighbouring touches together",
    Split.TEST_OBJECTS: "objects kept for the test",
    Split.OBJECTS: "objects or recordings together",
}
OVER = (Split.TEST_OBJECTS,)  # splits whose values are of independent objects, not of repetitions
KEYS = ["data", "split", "method", "weights", "mode", "size", "passes"]
GAINS = [f"over_{control}{end}" for control in ("features", "random") for end in ("", "_low", "_high", "_pairs")]
VALUES = ["accuracy", "low", "high", "values", *GAINS, "guess"]
CLASSICAL = ("features_knn", "", "", "", "printed")  # the control without a network: no weights, mode or size


def measured(results: Results, *metrics: str, passes: Iterable[str] = ("printed",)) -> pd.DataFrame:
    """Rows of some metrics that have a value after some of PASSES, of all recorded data sets; "" where KEYS lack.

    unit: the repetition, whose number is the same split for all, or the object where OVER. NotRun without any.
    """
    message = f"no {' or '.join(metrics)} of networks on recorded touches"
    by_set = everywhere(results, STAGE, message, metric=list(metrics))
    rows = of_passes(pd.concat(by_set.values(), ignore_index=True), *passes).astype({"size": "Int64"})
    rows = rows[rows["item"].notna() == rows["split"].isin(OVER)].astype(dict.fromkeys(["item", *KEYS], object))
    return rows.fillna(dict.fromkeys(KEYS, "")).assign(unit=rows["item"].fillna(rows["repetition"]))


def measured_lines(results: Results) -> pd.DataFrame:
    """A frame with a row a data set, split, network, start, mode, size and passes measured, the classical first.

    accuracy with low and high over so many values; guess; over_features and over_random: the gain over the classical
    features and over the same network untrained, each with _low, _high and the number of _pairs.
    """
    rows, guess, lines = measured(results, "accuracy", passes=PASSES), _guesses(results), []
    groups = {key: values.groupby("unit")["value"].mean() for key, values in grouped(rows, KEYS)}
    for key, values in groups.items():
        data, split, method, _, *way = key
        shared = 0.0 if split in OVER else shared_by(Split.RANDOM)
        line = [*key, *within(values, shared), len(values)]
        for control in (data, split, *CLASSICAL), (data, split, method, "random", *way):
            gains = (values - groups[control]).dropna() if control in groups and control != key else values[:0]
            line += [*interval(gains, shared), len(gains)]
        lines.append([*line, guess.get((data, split), np.nan)])
    frame = pd.DataFrame(lines, columns=[*KEYS, *VALUES]).join(rows.groupby(KEYS)["pretrained"].first(), on=KEYS)
    order = {name: k for k, name in enumerate([*DATA, *SPLITS, CLASSICAL[0]])}
    sort_options = {"by": ["data", "split", "method"], "key": lambda names: names.map(order).fillna(len(order))}
    return frame.sort_values(**sort_options, kind="stable", ignore_index=True)


def commonest(results: Results) -> pd.Series:
    """Share of right answers by object kept for the test, where the answer is always the commonest in training."""
    where = {"task": "slip", "split": Split.TEST_OBJECTS, "palm": "all", "scaled": "training"}
    rows = results.measured("recorded", "biotac_grasps", **where, classifier="majority", metric="accuracy")
    return rows.groupby("item")["value"].mean()


def _guesses(results: Results) -> dict[tuple[str, str], float]:
    """{(data, split): share that guessing gets right}: any class, or always the commonest, the better on average."""
    shares = {}
    with suppress(NotRun):
        rows = measured(results, "chance", "majority")
        means = rows.groupby(["data", "split", "metric", "unit"])["value"].mean().groupby(level=[0, 1, 2]).mean()
        shares |= means.groupby(level=[0, 1]).max().to_dict()
    with suppress(NotRun):  # which another stage has object by object
        shares["grasps_slip", Split.TEST_OBJECTS] = commonest(results).mean()
    return shares


ABSENT = (
    "Not run: the data set is not at hand. Its reader is tested on files in its layout; "
    "`experiment=recorded_touches` says how to switch it on."
)
COSTS = {
    "parameters": ("parameters, millions", 1e6),
    "operations": ("multiply-adds an image, billions", 1e9),
    "milliseconds": ("milliseconds an image, one thread", 1.0),
}
SIZE = 96  # pixels a side at which the recorded touches are seen
SLACK = 0.02  # accuracy that the smallest network may lack of the best one's
SETTING = {
    "data": "pressure", "split": Split.BLOCKS, "weights": "imagenet", "mode": "frozen", "size": SIZE,
    "passes": "printed",
}  # fmt: skip


ENDS = {"converged": ", until nothing improves"}


def build(results: Results) -> Table:
    """Accuracy of each network, start and mode on each recording and split, with its gains over the controls."""
    frame = measured_lines(results)
    lines = [
        {
            "data": DATA.get(row.data, row.data),
            "split": SPLITS.get(row.split, row.split),
            "network": "features and kNN" if row.method == CLASSICAL[0] else label(row.method),
            "starts from": origin(row.weights, row.pretrained) if row.weights in STARTS else "–",
            "filters": f"{label(row.mode)}, {row.size} px{ENDS.get(row.passes, '')}" if row.mode else "–",
            "accuracy, %": with_interval(row.accuracy, row.low, row.high, 100, 1),
            "guessing, %": percent(row.guess, 1),
            "over features and kNN": _gain(row.over_features, row.over_features_low, row.over_features_high),
            "over random weights": _gain(row.over_random, row.over_random_low, row.over_random_high),
            "over": f"{row.values} {'objects' if row.split in OVER else 'splits'}",
        }
        for row in records(frame)
    ]
    table = pd.DataFrame(lines)
    answer = [name for name in map(str, table) if name not in ("guessing, %", "over")]
    return Table(frame, table, best=Ranking("accuracy, %", among=["split"]), answer=answer, split="data")


def printed(data: str, thesis: str, results: Results) -> Table:
    """Networks on one of the thesis's data sets: its own table, and ours where the data were at hand."""
    figures = results.thesis(thesis).set_index("network")
    rows = measured(results, "accuracy")
    trials = rows[(rows["data"] == data) & (rows["split"] == Split.RANDOM) & (rows["weights"] == "imagenet")]
    frame = pd.DataFrame({"network": list(PRINTED)})
    texts = pd.DataFrame({"network": list(PRINTED.values())})
    for mode in MODES:
        group = trials[trials["mode"] == mode]
        spans = [interval(group[group["method"] == network]["value"], shared_by(Split.RANDOM)) for network in PRINTED]
        frame[[mode, f"{mode}_low", f"{mode}_high"]] = spans
        frame[f"{mode}_thesis"] = figures.loc[texts["network"], f"acc_{mode}"].to_numpy()
        size = "".join(f", {pixels} px" for pixels in group["size"].unique())
        texts[f"{label(mode)}{size}: ours, %"] = [with_interval(*ends, 100, 1) for ends in spans]
        texts[f"{label(mode)}: thesis, %"] = [percent(share, 1) for share in frame[f"{mode}_thesis"]]
    return Table(frame, texts, {"absent": "" if len(trials) else ABSENT})  # no ranking: the thesis's rows are printed


def chart(results: Results) -> Figure:
    """A panel for each cost, with the Pareto front; neighbouring touches are held out together."""
    lines = measured_lines(results)
    frame = lines[(lines[list(SETTING)] == pd.Series(SETTING)).all(axis=1)].rename(columns={"method": "network"})
    frame = frame.merge(results.bench("networks"), on=["network", "size"])
    require_rows(frame, "no frozen network on the pressure images", "transfer", runnable=False)
    near_best = frame[frame["accuracy"] >= frame["accuracy"].max() - SLACK]
    smallest = label(near_best.loc[near_best["parameters"].idxmin(), "network"])
    figure, panels = plt.subplots(1, len(COSTS), figsize=(11.4, 3.8), sharey=True)
    for axes, (words, _) in zip(panels, COSTS.values(), strict=True):
        axes.set_xlabel(words)
    panels[0].set_ylabel("accuracy, %")
    figure.tight_layout()  # before names find their places
    points = (100 * frame[["accuracy", "low", "high"]]).assign(name=frame["network"].map(label))
    for axes, (cost, (_, unit)) in zip(panels, COSTS.items(), strict=True):
        _draw(axes, points.assign(cost=frame[cost] / unit))
    return Figure(figure, {"size": SIZE, "slack": 100 * SLACK, "smallest": smallest}, frame)


def _gain(*points: float) -> str:
    """Points gained [interval]; a dash where there is nothing to compare with."""
    return signed(*(100 * value for value in points), places=1) if points[0] == points[0] else "–"


def _draw(axes: Axes, frame: pd.DataFrame) -> None:
    """frame: accuracy, low and high in per cent, cost and name."""
    axes.set_xscale("log")
    ranked = placed(frame, "cost", "accuracy", noise=NOISE[CLOCK])
    front = ranked[ranked["on_front"] == ON].sort_values("cost")
    axes.step(front["cost"], front["accuracy"], where="post", color=INK, lw=1, zorder=1)
    axes.plot([frame["cost"]] * 2, [frame["low"], frame["high"]], color="#0072B2", lw=1.2, alpha=0.5)
    axes.plot(frame["cost"], frame["accuracy"], "o", color="#0072B2", ms=6, mec="white")
    axes.margins(x=0.2)
    axes.grid(True)
    plain_logarithm(axes.xaxis)
    axes.xaxis.set_major_locator(ticks(frame["cost"].max() / frame["cost"].min()))
    names = zip(frame["name"], zip(frame["cost"], frame["accuracy"], strict=True), strict=True)
    place_names(axes, names, frame[["cost", "accuracy"]].to_numpy(), lines(frame, front, "cost", "accuracy"))


PAGE = "know"
TABLES = {
    "real_networks": build,
    "table_5_1": partial(printed, "vt60", "table_5_1_vt60_bathtip"),
    "table_5_2": partial(printed, "vitac", "table_5_2_vitac_gelsight"),
    "table_5_5": partial(printed, "bigs", "table_5_5_bigs_barrett"),
}
FIGURES = {}
CHARTS = {"network_sizes": chart}

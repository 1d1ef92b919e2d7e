"""How far simulated imprints help to recognise real touches: a table, and a figure of two classifiers."""

from typing import Any

import pandas as pd

from stages.kit.split import Split, shared_by
from stages.report.grid import grid, means
from stages.report.items import Figure, Table
from stages.report.results import Results
from stages.report.style import CYCLE, GREY, INK, MARKERS, label, plt

STAGE = "simulated_to_real"
BY = ["training", "simulation", "aligned", "touches", "classifier"]
SIMULATIONS = {
    "none": "none", "array": "the thesis's array", "resting": "resting", "resting_skin": "resting, skin",
    "resting_grain": "resting, skin, gain and grain", "resting_small": "resting, objects at 56 %",
}  # fmt: skip
SHOWN = "knn"  # the best of the five on real touches
PANELS = (SHOWN, "deep_learning")  # and the one that simulation might help to train


def build_table(results: Results) -> Table:
    """Accuracy of kNN by kind of simulated imprints and number of real touches."""
    frame, rows = accuracies(results), _rows(results)
    alone = rows[(rows["group"] != "all") & (rows["training"] == "simulated")]
    ways = [(way, own.groupby("group")["value"].mean()) for way, own in alone.groupby(["simulation", "aligned"])]
    best, shares = max(ways, key=lambda way: way[1].mean())
    shares = shares.sort_values(ascending=False)
    words = {"way": _way(*best), "shares": ", ".join(f"{name} {100 * share:.0f}" for name, share in shares.items())}
    return Table(frame, _wide(frame), words | {"best": _best(frame)})


def build_figure(results: Results) -> Figure:
    """Accuracy against the number of real touches in training, with and without simulated imprints."""
    frame = accuracies(results)
    frame = frame[frame["aligned"] == (frame["simulation"] != "none")]
    kinds = [kind for kind in SIMULATIONS if kind in set(frame["simulation"])]
    tints = {"none": INK} | dict(zip([kind for kind in kinds if kind != "none"], CYCLE, strict=False))
    ticks = sorted(set(frame["touches"]))
    figure, panels = plt.subplots(1, 2, figsize=(9.4, 4.0), sharey=True)
    for axes, classifier in zip(panels, PANELS, strict=True):
        for kind, marker in zip(kinds, MARKERS, strict=False):
            mine = frame[(frame["simulation"] == kind) & (frame["classifier"] == classifier)].sort_values("touches")
            place, real = [ticks.index(count) for count in mine["touches"]], kind == "none"
            axes.plot(
                place, 100 * mine["accuracy"], marker=marker, color=tints[kind], lw=2.2 if real else 1.3, ms=4.5,
                label="real touches alone" if real else SIMULATIONS[kind],
            )  # fmt: skip
            if real:
                axes.fill_between(place, 100 * mine["low"], 100 * mine["high"], color=INK, alpha=0.12, lw=0)
        axes.axhline(10, color=GREY, lw=0.9, ls=":")
        axes.text(1.01, 10, "chance", transform=axes.get_yaxis_transform(), va="center", fontsize=8.5)
        axes.set_xticks(range(len(ticks)), ticks)
        axes.set_xlabel("real touches of each class in training")
        axes.set_title(label(classifier))
        axes.grid(axis="y")
        axes.set_ylim(0, 100)
    panels[0].set_ylabel("accuracy on real touches, %")
    handles, names = panels[0].get_legend_handles_labels()
    figure.legend(handles, names, loc="lower center", bbox_to_anchor=(0.5, 0.97), ncols=3, fontsize=9)
    return Figure(figure)


def accuracies(results: Results) -> pd.DataFrame:
    """Tidy frame: training, simulation, aligned, touches, classifier, accuracy, low, high."""
    rows = _rows(results)
    found = means(rows[rows["group"] == "all"], BY, shared_by(Split.RANDOM), top=1.0)
    return pd.DataFrame(found).rename(columns={"mean": "accuracy"})[[*BY, "accuracy", "low", "high"]]


def _rows(results: Results) -> pd.DataFrame:
    """The rows; those of real touches alone have the simulation "none"."""
    rows = results.rows(STAGE)
    return rows.assign(simulation=rows["simulation"].fillna("none"), aligned=rows["aligned"].fillna(False).astype(bool))


def _way(simulation: Any, aligned: Any) -> str:
    return SIMULATIONS[simulation] + (", aligned" if aligned else "")


def _best(frame: pd.DataFrame) -> str:
    """The best of all classifiers by the number of real touches, with and without simulated imprints."""
    top = frame.loc[frame.groupby(["training", "touches"])["accuracy"].idxmax()]
    said = {}
    for training, simulation, aligned, touches, classifier, share, *_ in top.itertuples(index=False):
        way = f", {_way(simulation, aligned)}" if training == "both" else ""
        said[training, touches] = f"{100 * share:.0f} ({label(classifier)}{way})"
    counts = sorted(set(frame["touches"]) - {0})
    return "; ".join(f"{count}: {said['real', count]} without, {said['both', count]} with" for count in counts)


def _wide(frame: pd.DataFrame) -> pd.DataFrame:
    """Of one classifier: ways to simulate down, numbers of real touches across."""
    mine = frame[frame["classifier"] == SHOWN].sort_values("touches", kind="stable")
    mine["simulated imprints"] = [_way(*pair) for pair in zip(mine["simulation"], mine["aligned"], strict=True)]
    head = f"real touches a class, {label(SHOWN)}, %"
    wide = grid(mine, "simulated imprints", "touches", beside=(), head=lambda count: f"{count} {head}")
    wide = wide.replace("not run", "–")  # with neither real nor simulated touches there is nothing to run
    return wide.sort_values("simulated imprints", key=lambda way: way != "none", kind="stable")

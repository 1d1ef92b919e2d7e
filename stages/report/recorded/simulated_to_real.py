"""How far simulated imprints help to recognise real touches: a table, and a figure of two classifiers."""

from typing import Any

import pandas as pd

from haptic_glance.know.split import Split, shared_by
from stages.report.grid import grid, means
from stages.report.items import Figure, Table
from stages.report.ranking import Ranking
from stages.report.results import Results
from stages.report.style import CYCLE, GREY, INK, MARKERS, label, plt

BY = ["training", "simulation", "aligned", "touches", "classifier"]
SIMULATIONS = {
    "none": "none", "array": "the thesis's array", "resting": "resting", "resting_skin": "resting, skin",
    "resting_grain": "resting, skin, gain and grain", "resting_small": "resting, objects at 56 %",
}  # fmt: skip
SHOWN = "knn"  # the best of the five on real touches
PANELS = (SHOWN, "deep_learning")  # and the one that simulation might help to train


def build_table(results: Results) -> Table:
    """Accuracy of kNN by kind of simulated imprints and number of real touches."""
    frame, rows = _accuracies(results)
    alone = rows[(rows["group"] != "all") & (rows["training"] == "simulated")]
    shares = alone.groupby(["simulation", "aligned", "group"])["value"].mean()
    way: Any = shares.groupby(level=[0, 1]).mean().idxmax()
    said = [f"{label(name)} {100 * share:.0f}" for name, share in shares[way].sort_values(ascending=False).items()]
    mine = frame[frame["classifier"] == SHOWN].sort_values("touches", kind="stable")
    mine["simulated imprints"] = [*map(_way, mine["simulation"], mine["aligned"])]
    wide = grid(mine, "simulated imprints", "touches", head=lambda count: f"{count} real touch{'es' * (count != 1)}, %")
    wide = wide.replace("not run", "–")  # with neither real nor simulated touches there is nothing to run
    wide = wide.sort_values("simulated imprints", key=lambda way: way != "none", kind="stable")
    words = {"way": _way(*way), "shares": ", ".join(said), "best": _best(frame)}
    return Table(frame, wide, words, Ranking(wide.columns[-1]))


def build_figure(results: Results) -> Figure:
    """Accuracy against the number of real touches in training, with and without simulated imprints."""
    frame, _ = _accuracies(results)
    frame = frame[frame["aligned"] == (frame["simulation"] != "none")]
    kinds = [kind for kind in SIMULATIONS if kind in set(frame["simulation"])]
    ticks = sorted(set(frame["touches"]))
    figure, panels = plt.subplots(1, 2, figsize=(9.4, 4.0), sharey=True)
    for axes, classifier in zip(panels, PANELS, strict=True):
        for kind, marker, tint in zip(kinds, MARKERS, [INK, *CYCLE], strict=False):
            mine = frame[(frame["simulation"] == kind) & (frame["classifier"] == classifier)].sort_values("touches")
            place, real = [ticks.index(count) for count in mine["touches"]], kind == "none"
            axes.plot(
                place, 100 * mine["accuracy"], marker=marker, color=tint, lw=2.2 if real else 1.3, ms=4.5,
                label="real touches alone" if real else SIMULATIONS[kind],
            )  # fmt: skip
            if real:
                axes.fill_between(place, 100 * mine["low"], 100 * mine["high"], color=INK, alpha=0.12, lw=0)
        axes.axhline(10, color=GREY, lw=0.9, ls=":")
        axes.text(1.01, 10, "chance", transform=axes.get_yaxis_transform(), va="center", fontsize=8.5)
        axes.set_xticks(range(len(ticks)), ticks)
        axes.set(title=label(classifier), xlabel="real touches of each class in training", ylim=(0, 100))
        axes.grid(axis="y")
    panels[0].set_ylabel("accuracy on real touches, %")
    explained = panels[0].get_legend_handles_labels()
    figure.legend(*explained, loc="lower center", bbox_to_anchor=(0.5, 0.97), ncols=3, fontsize=9)
    return Figure(figure)


def _accuracies(results: Results) -> tuple[pd.DataFrame, pd.DataFrame]:
    """(accuracy, low and high by the columns BY, the rows); of real touches alone the simulation is "none"."""
    rows = results.rows("simulated_to_real").fillna({"simulation": "none", "aligned": False}).astype({"aligned": bool})
    found = means(rows[rows["group"] == "all"], BY, shared_by(Split.RANDOM), top=1.0)
    return pd.DataFrame(found).rename(columns={"mean": "accuracy"})[[*BY, "accuracy", "low", "high"]], rows


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

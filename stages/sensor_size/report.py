"""The effect of the pressure array's size and of the distance of its sensels on recognition (T4.3.2)."""

import numpy as np
import pandas as pd

from haptic_glance.know.split import Split
from stages.charts.datasets import dataset_text
from stages.charts.drawing import CYCLE, GREY, MARKERS, label, plt
from stages.charts.items import Figure, Table
from stages.charts.pareto import NORMAL, noise_by
from stages.charts.results import Results
from stages.charts.tables import WHOSE, Ranking, beside_thesis, everywhere, grid, grouped, means, over_items, records
from stages.engine.statistics import interval

EMPTY = {"fine": "", "extent": ""}  # of one array and one touch a sample
EXTENTS = {
    "": "", "points": ", five separate points", "region": ", five in a salient region", "disc": ", five in a disc",
}  # fmt: skip
PRINTED_SET = "princeton_4_3_sets"  # four classes of three objects each, as the thesis has
SPLITS = {Split.OBJECTS: "unseen objects", Split.RANDOM: "known objects, other touches"}


def table(results: Results) -> Table:
    """One row per array, data set and split; the sets that are switched on first."""
    by_set = everywhere(results, STAGE, metric=["accuracy", "smallest_chosen_again"])
    rows = pd.concat([rows.sort_values("split", kind="stable") for rows in by_set.values()])
    rows, smallest = (rows[rows["metric"] == metric] for metric in ("accuracy", "smallest_chosen_again"))
    thesis = results.thesis("figure_4_11_sensor_32x32_sensel_0_01").set_index("classifier")["accuracy"]
    rows = rows.reindex(columns=[*rows.columns.union([*EMPTY, "set"], sort=False)]).fillna(EMPTY)
    frame = _cells(rows, ["dataset", "split", "cells", "pitch", *EMPTY, "classifier"])
    frame["thesis"] = frame["classifier"].map(thesis).where((frame["cells"] == LARGE) & (frame["pitch"] == COARSE))
    cells = frame.assign(width=(frame["cells"] * frame["pitch"]).map("{:.2f}".format), cells=_arrays(frame))
    cells = cells.assign(
        thesis=frame["thesis"].where((frame[["split", *EMPTY]] == [Split.OBJECTS, "", ""]).all(axis=1))
    )
    cells["set"] = cells["dataset"].map(dataset_text) + ", " + cells["split"].map(SPLITS)
    cells = cells.sort_values("dataset", key=lambda names: names != PRINTED_SET, kind="stable", ignore_index=True)
    down, heads = (
        ["set", "cells", "pitch", "width", WHOSE],
        [f"{label(name)}, %" for name in cells["classifier"].unique()],
    )
    text_table = grid(beside_thesis(cells, down[:-1]), down, "classifier", head=lambda name: f"{label(name)}, %")
    text_table = text_table.rename(columns={"pitch": "pitch, units", "width": "width, units"})
    words = {"classes": _classes(rows), "smallest": _smallest(smallest)}
    return Table(frame, text_table, words, Ranking(heads), split="set")


def _arrays(frame: pd.DataFrame) -> list[str]:
    """For each row `16 x 16`, with the finer array beside it, or where the touches of one sample lie."""
    return [f"{row.cells} x {row.cells}{_beside(row.fine)}{EXTENTS[row.extent]}" for row in records(frame)]


def _beside(array: str) -> str:
    """` and 12 x 12 at 0.005` of `12-0.005`; empty where there is none."""
    cells, _, pitch = array.partition("-")
    return f" and {cells} x {cells} at {pitch}" if array else ""


def _cells(rows: pd.DataFrame, by: list[str]) -> pd.DataFrame:
    """Mean accuracy and interval over the tested objects, one row for each combination of the columns `by`."""
    objects = rows.groupby([*by, "item"], sort=False)[["value", "seconds"]].mean().reset_index()
    averages = pd.DataFrame(means(objects, by, top=1.0)).rename(columns={"mean": "accuracy"}).drop(columns="values")
    return averages.assign(seconds=rows.groupby(by, sort=False)["seconds"].median().to_numpy())


def _classes(rows: pd.DataFrame) -> str:
    """The content of each set, in words."""
    return "; ".join(
        f"{dataset_text(str(name))}: {', '.join(sorted(set(part['group'])))}, {part['item'].nunique()} objects, "
        f"{int(part['touches'].iloc[0])} touches each, "
        f"guessing {100 / part.groupby('set', dropna=False)['group'].nunique().max():.1f} %"
        for name, part in rows.groupby("dataset", sort=False)
    )


def _smallest(rows: pd.DataFrame) -> str:
    """The smallest array of each set, a line each."""
    lines = []
    for name, part in rows.groupby("dataset", sort=False):
        arrays = [
            f"{label(row.classifier)} {row.cells:.0f} x {row.cells:.0f} at {row.pitch:g} ({100 * row.value:.0f} %)"
            for row in records(part)
        ]
        lines.append(f"The smallest array that is enough, {dataset_text(str(name))}: {'; '.join(arrays)}.")
    return "\n".join(lines)


def chart(results: Results) -> Figure:
    """Accuracy on unseen objects against the number of sensels, for each distance, and the cost of a touch."""
    rows = results.measured(STAGE, **UNSEEN)
    cells = _cells(rows, ["cells", "pitch", "classifier"])
    touched = results.measured(STAGE, metric="seconds_a_touch")
    costs = 1e3 * pd.DataFrame([
        dict(zip(("cells", "pitch", "mean", "low", "high"), (*key, *interval(over_items(points))), strict=True))
        for key, points in grouped(touched, ["cells", "pitch"])
    ]).set_index(["cells", "pitch"]).sort_index()  # fmt: skip
    clock = results.clock(STAGE)
    spread = np.exp(NORMAL * noise_by(clock))  # of a cost without objects of its own, from run to run
    costs = costs.assign(
        low=costs["low"].fillna(costs["mean"] / spread), high=costs["high"].fillna(costs["mean"] * spread)
    )
    names = list(dict.fromkeys(cells["classifier"]))
    pitches, sizes = sorted(set(cells["pitch"])), sorted(set(cells["cells"]))
    figure, panels = plt.subplots(1, len(names) + 1, figsize=(1.95 * (len(names) + 1), 3.4))
    accuracies, cost = dict(zip(names, panels, strict=False)), panels[-1]
    for k, pitch in enumerate(pitches):
        style = {"color": CYCLE[k], "marker": MARKERS[k], "ms": 5, "lw": 1.3}
        for name, axes in accuracies.items():
            points = cells[(cells["classifier"] == name) & (cells["pitch"] == pitch)].sort_values("cells")
            x = points["cells"] * 1.03 ** (k - (len(pitches) - 1) / 2)  # apart, so that no interval hides another
            axes.vlines(x, 100 * points["low"], 100 * points["high"], color=CYCLE[k], lw=1, alpha=0.5)
            axes.plot(x, 100 * points["accuracy"], label=f"cells {pitch:g} units apart", **style)
        points = costs.xs(pitch, level="pitch")
        x = points.index * 1.06 ** (k - (len(pitches) - 1) / 2)
        cost.vlines(x, points["low"], points["high"], color=CYCLE[k], lw=1, alpha=0.5)
        cost.plot(x, points["mean"], **style)
    for name, axes in accuracies.items():
        axes.axhline(100 / rows["group"].nunique(), color=GREY, lw=0.8, ls=":")
        axes.set(title=label(name), ylim=(0, min(100 * cells["high"].fillna(cells["accuracy"]).max() + 5, 100)))
        axes.tick_params(labelleft=axes is panels[0])
    cost.set(title="cost of a touch", ylim=(0, None), ylabel="milliseconds")
    for axes in panels:
        axes.set_xscale("log", base=2)
        axes.set_xticks(sizes, [f"{size}²" for size in sizes])
        axes.grid(axis="y")
    panels[0].set_ylabel("accuracy on unseen objects, %")
    figure.supxlabel("cells of the array", fontsize=10, y=0.12)
    figure.suptitle(_best(cells), x=0.01, ha="left", fontsize=11, fontweight="bold")
    figure.tight_layout(w_pad=1.2, rect=(0, 0.1, 1, 1))
    figure.legend(*panels[0].get_legend_handles_labels(), loc="lower center", ncol=len(pitches), fontsize=9)
    return Figure(figure, {"clock": clock, "on": dataset_text(str(rows["dataset"].iloc[0]))})


def _best(cells: pd.DataFrame) -> str:
    """The best array, and the loss of the one with the fewest and closest cells."""
    best = cells.sort_values("accuracy").iloc[-1]
    small = cells[cells["classifier"] == best["classifier"]].sort_values(["cells", "pitch"]).iloc[0]
    texts = (
        f"{label(row['classifier'])}, {row['cells']}² cells {row['pitch']:g} apart: {100 * row['accuracy']:.0f} %"
        for row in (best, small)
    )
    return "Best: {}; the smallest array: {}".format(*texts)


STAGE = "sensor_size"
COARSE, LARGE = 0.01, 32  # the array of T figure 4.9 that the thesis prints
UNSEEN = {"metric": "accuracy", "split": Split.OBJECTS}


PAGE = "touch"
TABLES = {"figure_4_11": table}
FIGURES = {}
CHARTS = {"sensor_size": chart}

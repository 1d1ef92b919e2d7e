"""T tables 4.1, 4.2, 4.5 and 4.6: recognition by one touch and by several, beside the thesis's; 4.1 is drawn too."""

from collections.abc import Iterator
from contextlib import suppress
from dataclasses import replace
from functools import partial
from typing import Any

import numpy as np
import pandas as pd
from matplotlib.axes import Axes

from haptic_glance.know.split import Split
from stages.report.drawing import INK, colours, label, plt
from stages.report.items import Figure, Table
from stages.report.results import OWN_FOLDER, SETS_4_2, NotRun, Results, some
from stages.report.tables import CLASSIFIERS, MEANS, READINGS, Ranking, blocks, grid, grouped, scaled, with_means
from stages.report.words import shared_notes

from .rows import EQUAL, MODEL, SSIM, STAGE, Protocol, accuracies, fifteen, protocols, sampling_text

DRAWN = ("random", "itti", EQUAL, SSIM, MODEL)  # samplings
FURTHER = ["deep_learning", "naive_bayes", "knn"]  # shown in the further rows; all are in the CSV
JUDGED = ["svm", "knn", *MEANS]  # shown where the SVM is not dead
WAYS = {
    "": "", "_unplaced": "without positions", "_ordered": "touches in the order of their height",
    "_disjoint": "each imprint in one combination", "_many": "five times as many combinations",
    "_mixed": "combinations drawn before the split", "first_15_mixed": "drawn before the split, 15 imprints per object",
}  # fmt: skip
MIXED = ["_mixed", "first_15_mixed"]
KEYS = ["sampling", "way", "classifier", "touches"]
DOWN, PRINTED = ["protocol", "sampling"], "the thesis"
BELOW = {"accuracy_regions": "{}, unseen regions".format, "thesis": lambda protocol: PRINTED}
RANKING = Ranking("kNN, %", among=["protocol"], exempt=[PRINTED])


def beside_thesis(results: Results, group: str, printed: str, variant: str = "plain") -> Table:
    """The Table of one group of objects beside the thesis's, by protocol; below, samplings of this project alone.

    Then the readings of the scale of the samples, each as a protocol.
    """
    thesis = results.thesis(printed).set_index("sampling")
    thesis = thesis.assign(**{name: thesis[list(several)].mean(axis=1) for name, several in MEANS.items()})
    parts, fifteen_parts = [], []
    for protocol in protocols(results, on_sets=True, group=group, variant=variant):
        parts.append(_cells(protocol, thesis, whole=not parts))
    with suppress(NotRun):
        for protocol in protocols(results, on_sets=True, group=group, variant=fifteen(variant)):
            fifteen_parts.append(_cells(protocol, thesis, ", 15 imprints"))
    scaled = [_cells(entry, thesis) for entry in readings(results, group=group, variant=variant)]
    frame = pd.concat([*parts, *fifteen_parts]).sort_values("protocol", kind="stable")
    frame = pd.concat([frame, *scaled], ignore_index=True)
    once = frame.assign(thesis=frame["thesis"].mask(frame["sampling"].str.contains(", ")))  # not beside 15 imprints too
    once["accuracy_regions"] = once["accuracy_regions"].mask(once["protocol"].str.contains(": "))
    text_table = grid(
        blocks(once, DOWN, "classifier", BELOW), DOWN, "classifier",
        names={"sampling": sampling_text}, head=lambda name: f"{label(name)}, %",
    )  # fmt: skip
    words = {name: shared_notes(__package__, name) for name in ("cells", "regions")}
    words |= {"fifteen": shared_notes(__package__, "fifteen") if fifteen_parts else "15 imprints per object: not run."}
    words |= {"group": results.group_text(group), "not_run": results.left_out(STAGE, group=group, variant=variant)}
    return Table(frame, text_table, words, RANKING)


def readings(results: Results, **where: Any) -> Iterator[Protocol]:
    """The readings of the scale: of the protocol as printed on random sets, or else of the first that has them."""
    for scaling, words in READINGS.items():
        with suppress(NotRun):
            versions = list(protocols(results, True, scaling, **where))
            base = next((version for version in versions if version.dataset in SETS_4_2), versions[0])
            yield replace(base, name=f"{base.name}: {words}")


def _cells(protocol: Protocol, thesis: pd.DataFrame, few: str = "", whole: bool = False) -> pd.DataFrame:
    """whole: whether the thesis's samplings that were not run have cells too."""
    rows, thesis = with_means(protocol.rows), thesis.rename(index=protocol.samplings)
    run = set(rows["method"])
    names = [name for name in [*thesis.index, *sorted(run - {*thesis.index})] if whole or name in run]
    groups_by_key = grouped(rows[rows["metric"] == "accuracy"], ["method", "classifier"])
    classifiers = [*thesis.columns, *added(rows["classifier"])]
    thesis, groups = thesis.reindex(names, columns=classifiers), dict(groups_by_key)
    return pd.DataFrame(
        [
            {"protocol": protocol.name, "sampling": f"{sampling}{few}", "classifier": classifier}
            | accuracies(groups.get((sampling, classifier), rows[:0]))
            | {"thesis": thesis.loc[sampling, classifier]}
            for sampling in names
            for classifier in classifiers
        ]
    )


def added(classifiers: pd.Series) -> list[str]:
    """The classifiers that the thesis does not have, such as those that somebody adds."""
    return sorted({*classifiers.dropna()} - {*CLASSIFIERS, *MEANS})


table_4_1 = partial(beside_thesis, group="six", printed="table_4_1_six_virtual_objects")
table_4_2 = partial(beside_thesis, group="four", printed="table_4_2_four_virtual_objects")
table_4_5 = partial(beside_thesis, group="six", printed="table_4_5_six_objects_with_locations", variant="locations")


def recognition(results: Results) -> Table:
    """Recognition by one touch in a folder of one's own, of whatever groups there are."""
    if not results.own_meshes:
        raise NotRun("tables 4.1 and 4.2 have the groups of the thesis", OWN_FOLDER, runnable=False)
    splits = [Split.RANDOM, Split.REGIONS]
    rows = scaled(results.measured(STAGE, metric="accuracy", variant="plain", split=splits))
    keys, ends = ["group", "split", "sampling", "classifier"], ["accuracy", "low", "high", "repetitions"]
    parts = dict(grouped(rows.rename(columns={"method": "sampling"}), keys))
    frame = pd.DataFrame([dict(zip(keys, key, strict=True)) | accuracies(parts[key], key[1]) for key in sorted(parts)])
    text_table = grid(
        frame, keys[:3], "classifier", head=lambda name: f"{label(name)}, %",
        names={"group": results.group_text, "split": lambda name: Split(name).words, "sampling": label},
    ).rename(columns={"split": "tested on", "sampling": "places"})  # fmt: skip
    words = {"not_run": results.left_out(STAGE, variant="plain")}
    return Table(frame[[*keys, *ends]], text_table, words, Ranking(RANKING.by, among=["group", "tested on"]))


def table_4_6(results: Results) -> Table:
    """Recognition by one to five touches, beside the thesis, by protocol."""
    thesis = results.thesis("table_4_6_number_of_imprints").set_index("classifier")
    means = {name: thesis.loc[list(several)].mean() for name, several in MEANS.items()}
    thesis = pd.concat([thesis, pd.DataFrame(means).T]).rename_axis("classifier").reset_index()
    thesis = thesis.melt("classifier", var_name="touches", value_name="thesis")
    variants = [name for name in results.measured(STAGE)["variant"].dropna().unique() if "touches_" in name]
    where = {"group": "six", "variant": variants or ["touches"]}  # sets of single touches alone do not count
    versions = [*protocols(results, on_sets=True, **where), *readings(results, **where)]
    frame = pd.concat([_by_touches(version, thesis) for version in versions], ignore_index=True)
    some(frame, "no several touches", STAGE)
    scaled = frame["protocol"].str.contains(": ")
    plain = frame["best"] & (frame["way"] == "") & ~scaled
    is_judged = (scaled | frame["way"].isin(MIXED)) & frame["best"] & frame["classifier"].isin(JUDGED)
    samplings = frame["sampling"].map(label).mask(frame["best"], "")
    words = zip(frame["classifier"].map(label), frame["way"].map(WAYS), samplings, strict=True)
    names = pd.Series([", ".join(filter(None, parts)) for parts in words])
    labelled = frame.assign(name=names)
    down, extras = ["protocol", "name"], labelled[~plain & (is_judged | (frame["classifier"].isin(FURTHER) & ~scaled))]
    cells = pd.concat([blocks(labelled[plain], down, "touches", BELOW), extras])
    wide = grid(cells, down, "touches", head=lambda n: f"{n} touch{'es' if n > 1 else ''}, %", printed=PRINTED)
    wide = wide.rename(columns={"name": "classifier"})
    ranking = Ranking(wide.columns[-1], among=["protocol"], exempt=[PRINTED])
    return Table(frame, wide, {"group": results.group_text("six")}, ranking)


def _by_touches(protocol: Protocol, thesis: pd.DataFrame) -> pd.DataFrame:
    """Accuracies of one protocol by sampling, way to join touches, classifier and their number, with the thesis's."""
    rows = with_means(protocol.rows)
    touches = rows["variant"].str.extract(r"touches_(\d+)", expand=False).dropna().astype(int)
    ways = rows["variant"].str.replace(r"_?touches_\d+", "", regex=True)
    groups = rows.loc[touches.index].assign(sampling=rows["method"], way=ways, touches=touches)
    frame = pd.DataFrame([dict(zip(KEYS, key, strict=True)) | accuracies(group) for key, group in groups.groupby(KEYS)])
    if frame.empty:
        return frame
    samplings = [protocol.best, *sorted({*frame["sampling"]} - {protocol.best})]
    classifiers = [*CLASSIFIERS[::-1], *MEANS, *added(frame["classifier"])]
    orders: dict[Any, list[str]] = {"way": list(WAYS), "sampling": samplings, "classifier": classifiers}
    frame = frame.sort_values(list(orders), key=lambda column: column.map(orders[column.name].index), ignore_index=True)
    best = frame["sampling"] == protocol.best
    printed = frame.merge(thesis.astype({"touches": int}), how="left")["thesis"].where(best & (frame["way"] == ""))
    return frame.assign(protocol=protocol.name, best=best, thesis=printed)


def draw_bars(
    axes: Axes, frame: pd.DataFrame, classifiers: list[str], chance: float, regions: bool = False
) -> dict[str, float]:
    """Draws the samplings of DRAWN that were run; returns dict method -> its place about the middle of a group.

    frame: the tidy table 4.1 or 4.2. regions: whether accuracies on unseen regions are drawn too.
    """
    samplings = set(frame.dropna(subset=["accuracy"])["sampling"])
    paint = colours([method for method in DRAWN if method in samplings])
    width = 0.8 / max(len(paint), 1)
    places = {method: (k - (len(paint) - 1) / 2) * width for k, method in enumerate(paint)}
    for k, (method, place) in enumerate(places.items()):
        rows, x = frame[frame["sampling"] == method].set_index("classifier"), np.arange(len(classifiers)) + place
        cells = 100 * rows.loc[classifiers, ["accuracy", "low", "high", "accuracy_regions", "thesis"]]
        diamonds, dashes = (None, None) if k else ("the thesis's figure", "regions not touched before")
        axes.bar(x, cells["accuracy"], width * 0.92, color=paint[method], label=label(method))
        axes.vlines(x, cells["low"], cells["high"], color=INK, lw=1)
        axes.plot(x, cells["thesis"], "D", color="white", mec=INK, ms=5, mew=1.1, label=diamonds)
        if regions:
            axes.plot(x, cells["accuracy_regions"], "_", color=INK, ms=13, mew=2, label=dashes)
    axes.axhline(100 * chance, color=INK, lw=0.9, ls=":")
    axes.text(1.01, 100 * chance, "chance", transform=axes.get_yaxis_transform(), va="center", fontsize=8.5)
    axes.set_xticks(range(len(classifiers)), [label(name) for name in classifiers])
    axes.set(ylim=(0, 100), ylabel="accuracy, %")
    axes.grid(axis="y")
    axes.tick_params(axis="x", length=0)
    return places


def figure_4_1(results: Results) -> Figure:
    """Table 4.1 as a picture, a panel a protocol."""
    table = table_4_1(results).frame
    parts = list(table[~table["protocol"].str.contains(": ")].groupby("protocol", sort=False))
    figure, panels = plt.subplots(len(parts), 1, figsize=(8.4, 4.1 * len(parts)), squeeze=False)
    figure.subplots_adjust(hspace=0.52)
    for axes, (protocol, frame) in zip(panels[:, 0], parts, strict=True):
        draw_bars(
            axes, frame, [*CLASSIFIERS, *added(frame["classifier"])], chance=1 / results.classes("six"), regions=True
        )
        axes.set_title(f"Recognising {results.group_text('six')} by one touch, {protocol}", pad=42)
        handles, names = axes.get_legend_handles_labels()
        axes.legend(
            handles[1:] + handles[:1], names[1:] + names[:1], loc="lower left", bbox_to_anchor=(-0.01, 0.99), ncols=3,
            fontsize=9, columnspacing=1.4, handlelength=1.2,
        )  # fmt: skip
    return Figure(figure)

"""T tables 4.1 to 4.6 and section 4.2.4: recognition by one touch and by several, and imprints that objects share.

`protocols` has the rows of the stage classification, as printed in the thesis (T4.2) and in our protocol, `accuracies`
their accuracies. `METHODS` maps the thesis's samplings to methods.
"""

from collections import Counter
from collections.abc import Callable, Iterator
from contextlib import suppress
from dataclasses import dataclass, replace
from functools import partial
from itertools import product
from typing import Any

import numpy as np
import pandas as pd

from haptic_glance.know.classifiers import TRAINING
from haptic_glance.know.split import Split, shared_by
from haptic_glance.look.weights.weights import GLANCE
from stages.charts.datasets import SECTION_4_2, SETS_4_2
from stages.charts.drawing import label
from stages.charts.items import Table, shared_notes
from stages.charts.results import OWN_FOLDER, NotRun, Results, require_rows
from stages.charts.tables import (
    CLASSIFIERS,
    MEANS,
    READINGS,
    WHOSE,
    Ranking,
    beside_thesis,
    everywhere,
    grid,
    grouped,
    scaled,
    with_means,
    with_printed_means,
    within,
)

STAGE = "classification"
PRINTED = SECTION_4_2
EQUAL, SSIM = "VisAttAll", "thesis_ssim"  # the thesis's models of T3.1, and of T3.2 with its SSIM weights
MODEL = GLANCE  # this project's model of gaze
METHODS = {  # sampling of the thesis: its method; enhanced visual attention is SSIM in our protocol
    "blind_touch": "random", "hks": "heat_kernel", "salient_points": "salient_points",
    "mesh_saliency": "mesh_saliency", "visual_attention": "itti", "enhanced_visual_attention": EQUAL,
}  # fmt: skip
BLIND = ("random", *(f"random+{draw}" for draw in range(2, 6)))  # draws of blind touch
# The mean share of six objects that two random sets have in common: a deck is dealt again when it is used up.
COMMON = {SETS_4_2[0]: 0.0859, SETS_4_2[1]: 0.0270, SETS_4_2[2]: 0.0}


def shared_objects(*datasets: str) -> float:
    """The test over training share of splits that are as much alike as random sets of objects, for `interval`.

    datasets: that of each random set; one name stands for any number of its sets. Two sets with a share r of their
    objects in common correlate by r, and so do repeated splits with a share of r / (1 - r) (Nadeau and Bengio 2003).
    """
    counts = Counter(datasets * 2 if len(datasets) == 1 else datasets)
    pairs = sum(count * (count - 1) * COMMON.get(name, 0.0) for name, count in counts.items())
    common = pairs / (counts.total() * (counts.total() - 1))
    return common / (1 - common)


@dataclass(frozen=True)
class Protocol:
    """Rows of one set: of T4.2's own sensor, views and model, or of ours.

    dataset: its name, that of the first of several. rows: what was measured. name: as the tables call it. best: the
    model whose points are looked at closer.
    """

    dataset: str
    rows: pd.DataFrame
    name: str
    best: str

    @property
    def samplings(self) -> dict[str, str]:
        """{sampling of the thesis: method}."""
        return METHODS | ({} if self.best == EQUAL else {"enhanced_visual_attention": SSIM})


def protocols(results: Results, on_sets: bool = False, scaling: str = TRAINING, **where: Any) -> Iterator[Protocol]:
    """The protocol as printed, where it was run, then ours on the first other set; NotRun where neither has rows.

    on_sets: also that as printed on random sets of objects. scaling: of the samples; rows about no classifier
    have none.
    """
    by_set = everywhere(results, STAGE, **where)
    by_set = {name: part for name, rows in by_set.items() if not (part := scaled(rows, scaling)).empty}
    by_set = {name: rows for name, rows in by_set.items() if on_sets or name not in SETS_4_2}
    require_rows(by_set, f"no rows of the scaling {scaling}", STAGE)
    if PRINTED in by_set:
        yield Protocol(PRINTED, by_set.pop(PRINTED), "as printed", EQUAL)
    if printed_sets := {name: by_set.pop(name) for name in SETS_4_2 if name in by_set}:
        rows = pd.concat(printed_sets.values(), ignore_index=True).replace({"method": dict.fromkeys(BLIND, BLIND[0])})
        count = len(rows[["dataset", "set"]].drop_duplicates())
        yield Protocol(next(iter(printed_sets)), rows, f"as printed, {count} random sets", EQUAL)
    for dataset, rows in list(by_set.items())[:1]:
        yield Protocol(dataset, rows, "ours", MODEL)


def accuracies(rows: pd.DataFrame, split: Split = Split.RANDOM) -> dict[str, float]:
    """accuracy, low, high, repetitions of one split, and mean accuracy on the others; NaN where not measured.

    The interval is over repeated splits of the same objects, or over random sets of objects.
    """
    is_accuracy = ((rows["metric"] == "accuracy") & rows["value"].notna()).to_numpy()
    values, splits = (rows[name].to_numpy()[is_accuracy] for name in ("value", "split"))
    of_split, share = values[splits == split], shared_by(split)
    if "set" in rows and rows["set"].notna().to_numpy()[is_accuracy][splits == split].any():
        split_rows = rows.loc[is_accuracy, ["dataset", "set", "value"]][splits == split]
        of_split = split_rows.groupby(["dataset", "set"])["value"].mean()
        share = shared_objects(*of_split.index.get_level_values("dataset"))
    ends = zip(("accuracy", "low", "high"), within(of_split, share), strict=True)
    by_split = {name: values[splits == name] for name in (Split.FOLDS, Split.REGIONS, Split.RANDOM_FEWER)}
    means = {f"accuracy_{name}": group.mean() if len(group) else np.nan for name, group in by_split.items()}
    return {**dict(ends), "repetitions": len(of_split), **means}


def fifteen(variant: str) -> str:
    """The variant of the stage that has only the first 15 imprints of each object, as the thesis had."""
    return "first_15" if variant == "plain" else f"first_15_{variant}"


FEW = ", 15 imprints"  # behind a sampling or a classifier: with the first 15 imprints of each object alone


def few_last(frame: pd.DataFrame, column: str) -> pd.DataFrame:
    """The frame with FEW behind the protocol, no longer behind the names of a column."""
    few = frame[column].str.endswith(FEW)
    protocols = frame["protocol"] + np.where(few, FEW, "")
    return frame.assign(**{column: frame[column].str.removesuffix(FEW)}, protocol=protocols)


def by_protocol(
    cells: pd.DataFrame, down: str, across: str, names: dict[str, Callable], head: Callable[[Any], str]
) -> pd.DataFrame:
    """The grid of each protocol, the thesis's rows behind ours; unseen regions are protocols of their own.

    The protocol as printed comes first: with 15 imprints, over random sets of objects.
    """
    regions = cells[~cells["protocol"].str.contains(": ")].dropna(subset=["accuracy_regions"])
    regions = regions.assign(accuracy=regions["accuracy_regions"], low=np.nan, high=np.nan, thesis=np.nan)
    cells = pd.concat([cells, regions.assign(protocol=regions["protocol"] + ", unseen regions")], ignore_index=True)
    place = cells["protocol"].map(
        lambda name: (": " in name, "unseen" in name, "sets" not in name, not name.endswith(FEW))
    )
    cells = cells.assign(place=place).sort_values("place", kind="stable", ignore_index=True)
    return grid(beside_thesis(cells, ["protocol", down]), ["protocol", down, WHOSE], across, names, head)


FURTHER = ["deep_learning", "naive_bayes", "knn"]  # shown in the further rows; all are in the CSV
JUDGED = ["svm", "knn", *MEANS]  # shown where the SVM is not dead
WAYS = {
    "": "", "_unplaced": "without positions", "_ordered": "touches in the order of their height",
    "_disjoint": "each imprint in one combination", "_many": "five times as many combinations",
    "_mixed": "combinations drawn before the split", "first_15_mixed": "drawn before the split, 15 imprints per object",
}  # fmt: skip
MIXED = ["_mixed", "first_15_mixed"]
KEYS = ["sampling", "way", "classifier", "touches"]


def one_touch(results: Results, group: str, printed: str, variant: str = "plain") -> Table:
    """The Table of one group of objects beside the thesis's, by protocol and by reading of the samples' scale."""
    thesis = with_printed_means(results.thesis(printed).set_index("sampling").T).T
    parts, fifteen_parts = [], []
    for protocol in protocols(results, on_sets=True, group=group, variant=variant):
        parts.append(_cells(protocol, thesis, whole=not parts))
    with suppress(NotRun):
        for protocol in protocols(results, on_sets=True, group=group, variant=fifteen(variant)):
            fifteen_parts.append(_cells(protocol, thesis, FEW))
    scaled = [_cells(entry, thesis) for entry in readings(results, group=group, variant=variant)]
    frame = pd.concat([*parts, *fifteen_parts]).sort_values("protocol", kind="stable")
    frame = pd.concat([frame, *scaled], ignore_index=True)
    cells = few_last(frame[frame["classifier"] != "mean_of_all"], "sampling")
    names, classifiers = {"sampling": label}, [f"{label(name)}, %" for name in cells["classifier"].unique()]
    text_table = by_protocol(cells, "sampling", "classifier", names, lambda name: f"{label(name)}, %")
    text_table = text_table.rename(columns={"sampling": "touched at"})
    words = {name: shared_notes(__package__, name) for name in ("cells", "regions")}
    words |= {"fifteen": "" if fifteen_parts else "15 imprints of each object: not run."}
    words |= {"group": results.group_text(group), "not_run": results.left_out(STAGE, group=group, variant=variant)}
    return Table(frame, text_table, words, Ranking(classifiers), split="protocol")


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


table_4_1 = partial(one_touch, group="six", printed="table_4_1_six_virtual_objects")
table_4_2 = partial(one_touch, group="four", printed="table_4_2_four_virtual_objects")
table_4_5 = partial(one_touch, group="six", printed="table_4_5_six_objects_with_locations", variant="locations")


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
    return Table(frame[[*keys, *ends]], text_table, words, Ranking("kNN, %", among=["tested on"]), split="group")


def table_4_6(results: Results) -> Table:
    """Recognition by one to five touches, beside the thesis, by protocol."""
    thesis = with_printed_means(results.thesis("table_4_6_number_of_imprints").set_index("classifier")).reset_index()
    thesis = thesis.melt("classifier", var_name="touches", value_name="thesis")
    variants = [name for name in results.measured(STAGE)["variant"].dropna().unique() if "touches_" in name]
    where = {"group": "six", "variant": variants or ["touches"]}  # sets of single touches alone do not count
    versions = [*protocols(results, on_sets=True, **where), *readings(results, **where)]
    frame = pd.concat([_by_touches(version, thesis) for version in versions], ignore_index=True)
    require_rows(frame, "no several touches", STAGE)
    scaled = frame["protocol"].str.contains(": ")
    plain = frame["best"] & (frame["way"] == "") & ~scaled
    is_judged = (scaled | frame["way"].isin(MIXED)) & frame["best"] & frame["classifier"].isin(JUDGED)
    extra = ~plain & (is_judged | (frame["classifier"].isin(FURTHER) & ~scaled))
    ways = zip(
        frame["protocol"], frame["way"].map(WAYS), frame["sampling"].map(label).mask(frame["best"], ""), strict=True
    )
    cells = frame.assign(protocol=[", ".join(filter(None, parts)) for parts in ways])[plain | extra]
    cells = cells.assign(accuracy_regions=cells["accuracy_regions"].where(plain))
    heads = {count: f"{count} touch{'es' if count > 1 else ''}, %" for count in sorted(frame["touches"].unique())}
    wide = by_protocol(cells, "classifier", "touches", {"classifier": label}, heads.__getitem__)
    words = {"group": results.group_text("six")}
    return Table(frame, wide, words, Ranking([*heads.values()]), split="protocol")


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


SELECTIONS = {
    "plain": "no selection", "selected": "selection", "selected_control": "as many left out at random",
    "selected_train": "selection in training alone",
}  # fmt: skip
PRINTED_SELECTIONS = {"plain": "all", "selected": "selected"}  # column of the thesis's table, behind the group
# T4.2.4, enhanced visual attention; of the thesis's cow, dromedary, glasses, hand, plane and cup.
BY_OBJECT = {
    "elephant": 0.3333, "duck": 0.4, "eyeglasses": 0.0667, "hand": 0.2667, "airplane": 0.1333, "cup": 0.2,
}  # fmt: skip


def table_4_3(results: Results) -> Table:
    """The gain from leaving out imprints that another object has too, by protocol."""
    fifteen_ways = [fifteen(way) for way in SELECTIONS]
    thesis = results.thesis("table_4_3_imprint_selection_virtual").set_index("classifier")
    selected = {version.dataset for version in protocols(results, variant="selected")}
    versions = protocols(results, group=["six", "four"], variant=[*SELECTIONS, *fifteen_ways])
    frame = pd.concat(
        [_selections(version, thesis) for version in versions if version.dataset in selected], ignore_index=True
    )
    cells = few_last(frame, "classifier")
    cells = cells.assign(protocol=cells["objects"] + " objects, " + cells["protocol"], accuracy_regions=np.nan)
    heads = {way: f"{words}, %" for way, words in SELECTIONS.items()}
    text_table = by_protocol(cells, "classifier", "selection", {"classifier": label}, heads.__getitem__)
    words = {"not_run": results.left_out(STAGE, variant=[*SELECTIONS, *fifteen_ways])}
    return Table(frame, text_table, words, Ranking([*heads.values()]), split="protocol")


def _selections(protocol: Protocol, thesis: pd.DataFrame) -> pd.DataFrame:
    """Accuracies of one protocol at its model's points by classifier, group and way to select, with the thesis's."""
    rows, cells = protocol.rows[protocol.rows["method"] == protocol.best], []
    for suffix, name, group, way in product(("", FEW), thesis.index, rows["group"].unique(), SELECTIONS):
        variant = fifteen(way) if suffix else way
        trials = rows[(rows["classifier"] == name) & (rows["group"] == group) & (rows["variant"] == variant)]
        recall = trials[(trials["split"] == Split.RANDOM) & (trials["metric"] == "recall")]["value"].mean()
        printed = thesis.loc[name].get(f"{group}_{PRINTED_SELECTIONS.get(way)}", np.nan)
        cell = {"protocol": protocol.name, "classifier": f"{name}{suffix}", "objects": group, "selection": way}
        cells.append(
            cell | accuracies(trials) | {"imprints": trials["imprints"].max(), "recall": recall, "thesis": printed}
        )
    return pd.DataFrame(cells)


def section_4_2_4(results: Results) -> Table:
    """How many imprints correlate by 0.85 or more with one of another object, by protocol."""
    thesis = results.thesis("section_4_2_similar_imprints").set_index("sampling")["share_with_ncc_over_0_85"]
    frame = pd.concat([
        _shares(protocol, thesis) for protocol in protocols(results, group="six", metric="similar_share")
    ], ignore_index=True)  # fmt: skip
    text_table = frame[["protocol", "of"]].assign(
        name=frame["name"].where(frame["of"] == "object", frame["name"].map(label))
    )
    for column, head in (("all", "ours, all, %"), ("first_15", "ours, first 15, %"), ("thesis", "thesis, %")):
        text_table[head] = 100 * frame[column]
    return Table(frame, text_table, split="protocol")  # no ranking: a share of alike imprints is neither good nor bad


def _shares(protocol: Protocol, thesis: pd.Series) -> pd.DataFrame:
    """The shares of one protocol: of each sampling, then of each object at the points of its model."""
    rows = protocol.rows[protocol.rows["item"].isna() | (protocol.rows["method"] == protocol.best)]
    rows = rows.assign(of=np.where(rows["item"].isna(), "sampling", "object"), name=rows["item"].fillna(rows["method"]))
    thesis = thesis.rename(index=protocol.samplings)
    wide = rows.pivot_table(index=["of", "name"], columns="variant", values=["imprints", "value"], sort=False)
    columns = {"imprints": ("imprints", "plain"), "all": ("value", "plain"), "first_15": ("value", "first_15")}
    frame = wide.reindex(columns=list(columns.values())).set_axis(list(columns), axis=1).reset_index()
    frame["thesis"] = frame["name"].map(thesis.to_dict() | BY_OBJECT)
    order = {"sampling": 0, "object": 1} | {name: k for k, name in enumerate(thesis.index)}
    frame = frame.sort_values(["of", "name"], key=lambda column: column.map(order))
    return frame.assign(protocol=protocol.name)

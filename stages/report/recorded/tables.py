"""Tables of recorded touches: pressure images (T table 4.4), grasps, and touches over time.

On pressure images a control removes as many touches at random as the selection of dissimilar touches does (T4.2.4).
`grasps` is about three BioTac SP fingertips: slip or hold, and one of 51 objects. `touch_events` compares events of a
fingertip with the published networks; `grasp_series` has grasps by a hand with pressure arrays.
"""

from collections.abc import Iterator
from itertools import product
from typing import Any

import numpy as np
import pandas as pd

from haptic_glance.know.split import Split, shared_by
from stages.engine.statistics import interval
from stages.report.drawing import label
from stages.report.items import Table
from stages.report.results import Results
from stages.report.tables import (
    READINGS,
    Ranking,
    blocks,
    cell_texts,
    grid,
    grouped,
    number,
    percent,
    records,
    scaled,
    signed,
    with_interval,
    with_means,
    with_printed_means,
    within,
)

CLASSES = {
    "four": "first four classes", "four_drawn": "four classes at random", "four_alike": "four most alike",
    "six": "first six classes", "six_drawn": "six classes at random", "six_alike": "six most alike",
    "all": "all 22 classes",
}  # fmt: skip
SELECTIONS = {
    "all": "no selection", "selected": "selection", "selected_control": "as many left out at random",
    "selected_training": "selection in training alone",
}  # fmt: skip
PRINTED = {name: f"the thesis, {name} toys" for name in ("four", "six")}
COLUMNS = {"group": "set", "method": "selection"}
KEYS = ["set", "selection", "classifier"]
VALUES = ["accuracy", "low", "high", "thesis", "accuracy_folds", "accuracy_blocks"]


def table_4_4(results: Results) -> Table:
    """Accuracy by set of classes, selection and classifier, beside the thesis's where it has one."""
    trials = results.rows("recorded", "pressure_images")
    thesis = with_printed_means(results.thesis("table_4_4_imprint_selection_real").set_index("classifier"))
    rows = scaled(trials).rename(columns=COLUMNS)
    scores = _scores(scaled(trials))
    frame = pd.DataFrame(
        [_line(scores, thesis, *key) for key in product(CLASSES, SELECTIONS, thesis.index)] + _readings(trials, thesis),
        columns=[*KEYS, *VALUES],
    )
    names = {"set": lambda name: CLASSES.get(name, name), "selection": lambda name: SELECTIONS.get(name, name)}
    cells = blocks(frame, KEYS[:2], KEYS[2], {"thesis": PRINTED.__getitem__})
    text_table = grid(cells, KEYS[:2], KEYS[2], names=names, head=lambda name: f"{label(name)}, %")
    by_metric = dict(list(rows.groupby("metric")))
    removals = by_metric["share_similar"].groupby("set")["value"].mean()
    class_lists = rows.groupby("set")["chosen"].first().str.replace(" ", ", ")
    near, far = (interval(by_metric[f"{kind}_correlation"]["value"]) for kind in ("neighbour", "pair"))
    whole = frame[(frame["set"] == "all") & (frame["selection"] == "all")].set_index("classifier")
    optimism = 100 * (whole["accuracy"] - whole["accuracy_blocks"])  # by which the random hold-out flatters
    words = {
        "removed": ", ".join(f"{text} {100 * removals.get(name, np.nan):.1f} %" for name, text in CLASSES.items()),
        "four": class_lists.get("four_alike", ""), "six": class_lists.get("six_alike", ""),
        "near": with_interval(*near, places=2), "far": with_interval(*far, places=2),
        "knn": optimism["knn"], "least": optimism.min(), "most": optimism.max(),
    }  # fmt: skip
    return Table(frame, text_table, words, Ranking("kNN, %", among=["set"], exempt=PRINTED.values()))


def _scores(rows: pd.DataFrame) -> dict[tuple, pd.Series]:
    """{(set, selection, classifier, split): accuracies}, with the means over classifiers."""
    rows = with_means(rows[rows["metric"] == "accuracy"]).rename(columns=COLUMNS)
    return {key: group["value"] for key, group in rows.groupby([*KEYS, "split"])}


def _readings(rows: pd.DataFrame, thesis: pd.DataFrame) -> list[tuple]:
    """Lines of all touches of the sets that were scaled otherwise, their selection said as that reading."""
    lines = []
    for scaling, words in READINGS.items():
        scores = _scores(scaled(rows, scaling))
        sets = [name for name in CLASSES if any(key[:2] == (name, "all") for key in scores)]
        cells = [_line(scores, thesis, name, "all", classifier) for name in sets for classifier in thesis.index]
        lines += [(line[0], f"no selection: {words}", *line[2:6], np.nan, *line[7:]) for line in cells]
    return lines


def _line(scores: dict[tuple, pd.Series], thesis: pd.DataFrame, *key: str) -> tuple:
    """Values of one set, selection and classifier, in the order of the columns."""
    name, selection, classifier = key
    shared = 0.0 if name.endswith("drawn") else shared_by(Split.RANDOM)  # drawn: another set each time
    accuracies = within(scores.get((*key, Split.RANDOM), []), shared)
    column = f"{name}_{selection}"
    printed = thesis.loc[classifier, column] if column in thesis else np.nan
    return (*key, *accuracies, printed, *(interval(scores.get((*key, split), []))[0] for split in ("folds", "blocks")))


BY = ["task", "split", "palm", "scaled", "components"]
TASKS = {
    ("slip", Split.TEST_OBJECTS): "slips or not, ten objects kept for the test",
    ("slip", Split.OBJECTS): "slips or not, objects left out of training in turn",
    ("recognition", Split.RANDOM): "which of 51 objects, a random quarter held out",
    ("recognition", Split.BLOCKS): "which of 51 objects, a run of rows held out",
}
PALMS = ("all", "45", "down", "side")
SCALED = {"training": "training part", "own": "each part by its own"}


def grasps(results: Results) -> Table:
    """Accuracy by task, palm direction, scaling, values and classifier, and how far the electrodes drift."""
    rows = results.rows("recorded", "biotac_grasps")
    lines = []
    for key, group in grouped(rows[rows["metric"] == "accuracy"], [*BY, "classifier"]):
        shared = shared_by(Split.RANDOM) if group["item"].isna().all() else 0.0
        lines.append((*key, *interval(group["value"], shared)))
    frame = pd.DataFrame(lines, columns=[*BY, "classifier", "accuracy", "low", "high"]).astype({"components": int})
    drift = {
        metric: ", ".join(f"palm {row.palm} {row.value:.1f}" for row in records(rows[rows["metric"] == metric]))
        for metric in ("drift", "drift_drawn")
    }
    tasks = [TASKS[pair] for pair in zip(frame["task"], frame["split"], strict=True)]
    cells = frame.assign(
        task=pd.Categorical(tasks, list(TASKS.values())), palm=pd.Categorical(frame["palm"], PALMS),
        low=frame["low"].clip(lower=0), high=frame["high"].clip(upper=1),
    )  # fmt: skip
    keys = ["task", "palm", "scaled", "components"]
    names = {"scaled": SCALED.get, "components": lambda count: "12 components" if count == 12 else "electrodes"}
    cells = cells.sort_values(keys)
    wide = grid(cells, keys, "classifier", names=names, head=lambda name: f"{label(name)}, %")
    wide = wide.rename(columns={"scaled": "scaled by", "components": "values"})
    return Table(frame, wide, drift | {"better": _better(frame)}, Ranking("kNN, %", among=["task"]))


def _better(frame: pd.DataFrame) -> str:
    """How many classifiers are better than the majority on one palm direction, by the way they are scaled."""
    test = (frame["task"] == "slip") & (frame["split"] == Split.TEST_OBJECTS) & (frame["palm"] != "all")
    trials = frame[test].set_index(BY)
    common = trials.loc[trials["classifier"] == "majority", "accuracy"]
    learners = trials[trials["classifier"] != "majority"]
    counts = (learners["low"] > common.reindex(learners.index)).groupby(["palm", "scaled"]).agg(["sum", "size"])
    texts = [f"palm {palm}, {SCALED[way]} {better} of {count}" for palm, way, better, count in counts.to_records()]
    return "; ".join(texts)


SET = "touch_events"
GROUPS = {"objects": "36 objects", "containers": "20 containers"}
SHOWN = ("discriminant", "linear_svm", "knn")  # of the chart, and of what it takes
OURS = "discriminant"
# Per cent on the publisher's test part: as Zhu, Hu, Zhou, Du and Li list them (Localist topographic expert routing,
# NeurIPS 2025, table 1), their own last.
PUBLISHED = {
    "GCN (Gu and others 2020)": (85.14, 58.83),
    "grid-based CNN (Gu and others 2020)": (88.40, 60.17),
    "TactileSGNet, spiking graph network (Gu and others 2020)": (89.44, 64.17),
    "GGT-SNN (2024)": (92.36, 75.00),
    "barrel network, shared (Zhu and others 2025)": (94.44, 86.67),
}
CONDITIONS = {
    "heard": "share of the touch heard", "cells": "taxels", "dead_taxels": "share of the taxels dead",
    "dropped_events": "share of the events dropped", "jitter": "deviation of an event's time, steps",
}  # fmt: skip


def touch_events(results: Results) -> Table:
    """Each method on the publisher's test part, asked one time, beside the published figures."""
    rows = results.rows("recorded", SET)
    tested = rows[(rows["part"] == "test") & (rows["metric"] == "accuracy")]
    scores = {key: part.set_index("item")["value"] for key, part in grouped(tested, ["group", "method"])}
    overall = {
        key: part["value"].iloc[0] for key, part in grouped(rows[rows["item"].isna()], ["group", "method", "metric"])
    }
    frame = pd.DataFrame([
        {"group": group, "method": method} | _beside_ours(part, scores[group, OURS])
        | {metric: overall[group, method, metric] for metric in ("cross_validated", "milliseconds", "training_seconds")}
        | tested[(tested["group"] == group) & (tested["method"] == method)].iloc[0][["bins", "parameter"]].to_dict()
        for (group, method), part in scores.items()
    ])  # fmt: skip
    published = [{"method": f"published: {name}"} | {
        GROUPS[group]: f"{share:.2f}" for group, share in zip(GROUPS, shares, strict=True)
    } for name, shares in PUBLISHED.items()]  # fmt: skip
    ours = [_event_line(part) for _, part in grouped(frame, ["method"])]
    text_table = pd.DataFrame(ours + published).fillna("–")
    return Table(frame, text_table, {"chosen": _chosen(frame)})


def _beside_ours(hits: pd.Series, ours: pd.Series) -> dict[str, float]:
    """Accuracy of a method from its hits by item, and what ours gains over it; both with an interval over the items."""
    names = ("accuracy", "low", "high", "gain", "gain_low", "gain_high")
    return dict(zip(names, (*within(hits), *interval(ours - hits)), strict=True))


def _gain_text(row: Any, places: int) -> str:
    """The gain of our method over the method of a row, in points; a dash for our own row."""
    ends = (100 * value for value in (row.gain, row.gain_low, row.gain_high))
    return "–" if row.method == OURS else signed(*ends, places=places)


def touch_events_conditions(results: Results) -> Table:
    """Accuracy within the training part by time heard, taxels and disturbance."""
    lines = [
        {"group": group, "method": method, "condition": condition, "level": level}
        | dict(zip(("accuracy", "low", "high"), within(trials["value"]), strict=True))
        for condition, rows in _varied(results)
        for (group, method, level), trials in grouped(rows, ["group", "method", "level"])
    ]
    frame = pd.DataFrame(lines)
    subset = frame[frame["method"].isin(SHOWN)]
    head = subset["group"].map(GROUPS) + ": " + subset["method"].map(label) + ", %"
    names = {"condition": CONDITIONS.get, "level": number}
    return Table(frame, grid(subset.assign(head=head), ["condition", "level"], "head", names))


def _event_line(rows: pd.DataFrame) -> dict[str, str]:
    line = {"method": label(rows["method"].iloc[0])}
    for row in records(rows):
        line[GROUPS[row.group]] = with_interval(row.accuracy, row.low, row.high, 100, 2)
        line[f"{label(OURS)} − it, {row.group}"] = _gain_text(row, 1)
    for row in records(rows):
        line[f"in training, {row.group}, %"] = percent(row.cross_validated, 1)
    for row in records(rows):
        line[f"milliseconds a touch, {row.group}"] = number(row.milliseconds)
    return line


def _chosen(frame: pd.DataFrame) -> str:
    """The method of each group with the highest accuracy in training, and its accuracy on the test part."""
    best = frame.loc[frame.groupby("group", sort=False)["cross_validated"].idxmax()]
    texts = [
        f"of the {GROUPS[row.group]} {label(row.method)}, {with_interval(row.accuracy, row.low, row.high, 100, 1)} %"
        for row in records(best)
    ]
    return "; ".join(texts)


def _varied(results: Results) -> Iterator[tuple[str, pd.DataFrame]]:
    """(condition, its rows within the training part, with the column level); undisturbed for heard and cells."""
    rows = results.rows("recorded", SET, part="training", metric="accuracy")
    plain, max_cells = rows[rows["disturbance"].isna()], rows["cells"].max()
    yield "heard", plain[plain["cells"] == max_cells].assign(level=lambda part: part["heard"])
    whole = plain[plain["heard"] == 1]
    yield "cells", whole.assign(level=whole["cells"]).sort_values("level", kind="stable")
    for kind, part in grouped(rows.dropna(subset=["disturbance"]), ["disturbance"]):
        yield str(kind[0]), part.assign(level=part["severity"])


GRASPS = "schunk"
BEST_GRASPS = Ranking("grasps left out in turn, %")


def grasp_series(results: Results) -> Table:
    """Each method: all grasps left out in turn, with intervals over grasps, and the publisher's five test grasps."""
    rows = results.rows("recorded", GRASPS, metric="accuracy")
    scores = {key: trials.set_index("item")["value"] for key, trials in grouped(rows, ["method", "part"])}
    lines = []
    for method in rows["method"].unique():
        trials, test_hits = scores[method, "training"], scores[method, "test"]
        line = {"method": method} | _beside_ours(trials, scores[OURS, "training"])
        lines.append(line | {"grasps": len(trials), "listed": int(test_hits.sum()), "listed_of": len(test_hits)})
    frame = pd.DataFrame(lines)
    text_table = pd.DataFrame({
        "method": frame["method"].map(label),
        "grasps left out in turn, %": cell_texts(frame),
        f"{label(OURS)} − it": [_gain_text(row, 0) for row in records(frame)],
        "published test list": frame["listed"].astype(str) + " of " + frame["listed_of"].astype(str),
    })  # fmt: skip
    counts = rows[rows["part"] == "training"].drop_duplicates("item")["item"].str.split("/").str[0].value_counts()
    return Table(
        frame, text_table, {"grasps": int(counts.sum()), "commonest": 100 * counts.max() / counts.sum()}, BEST_GRASPS
    )

"""Recorded touches: selection of imprints on a real pressure array (T4.2.4)."""

from itertools import product

import numpy as np
import pandas as pd

from haptic_glance.know.split import Split, shared_by
from stages.charts.drawing import label
from stages.charts.items import Table
from stages.charts.results import Results
from stages.charts.tables import (
    READINGS,
    WHOSE,
    Ranking,
    beside_thesis,
    grid,
    number,
    scaled,
    with_means,
    with_printed_means,
    within,
)
from stages.engine.statistics import interval

CLASSES = {
    "four": "first four classes", "four_drawn": "four classes at random", "four_alike": "four most alike",
    "six": "first six classes", "six_drawn": "six classes at random", "six_alike": "six most alike",
    "all": "all 22 classes",
}  # fmt: skip
SELECTIONS = {
    "all": "no selection", "selected": "selection", "selected_control": "as many left out at random",
    "selected_training": "selection in training alone",
}  # fmt: skip
FIRST = "six_alike"  # of the sets, shown first: as many as the thesis has toys, and touches to remove
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
    cells = frame[frame["classifier"] != "mean_of_all"]
    cells = cells.sort_values("set", key=lambda names: names != FIRST, kind="stable", ignore_index=True)
    cells, heads = beside_thesis(cells, KEYS[:2]), [f"{label(name)}, %" for name in cells["classifier"].unique()]
    text_table = grid(cells, [*KEYS[:2], WHOSE], KEYS[2], names, lambda name: f"{label(name)}, %")
    by_metric = dict(list(rows.groupby("metric")))
    removals = by_metric["share_similar"].groupby("set")["value"].mean()
    class_lists = rows.groupby("set")["chosen"].first().str.replace(" ", ", ")
    near, far = (by_metric[f"{kind}_correlation"]["value"].mean() for kind in ("neighbour", "pair"))
    whole = frame[(frame["set"] == "all") & (frame["selection"] == "all")].set_index("classifier")
    optimism = 100 * (whole["accuracy"] - whole["accuracy_blocks"])  # by which the random hold-out flatters
    words = {
        "removed": ", ".join(f"{text} {100 * removals.get(name, np.nan):.1f} %" for name, text in CLASSES.items()),
        "four": class_lists.get("four_alike", ""), "six": class_lists.get("six_alike", ""),
        "near": number(near, 2), "far": number(far, 2),
        "knn": optimism["knn"], "least": optimism.min(), "most": optimism.max(),
    }  # fmt: skip
    return Table(frame, text_table, words, Ranking(heads), split="set")


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
    column = f"{name.partition('_')[0]}_{selection}"  # the thesis has sets of four and of six
    printed = thesis.loc[classifier, column] if column in thesis else np.nan
    return (*key, *accuracies, printed, *(interval(scores.get((*key, split), []))[0] for split in ("folds", "blocks")))


PAGE = "touch"
TABLES = {
    "table_4_4": table_4_4,
}
FIGURES = {}
CHARTS = {}

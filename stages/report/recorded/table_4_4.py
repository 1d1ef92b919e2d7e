"""T table 4.4: real touches of four and six objects, with and without the selection of dissimilar ones."""

from itertools import product
from typing import Any

import numpy as np
import pandas as pd

from stages.kit.split import Split, shared_by
from stages.kit.stats import interval
from stages.report.grid import grid, within
from stages.report.items import Table
from stages.report.markdown import with_interval
from stages.report.results import Results
from stages.report.style import label

SETS = {
    "four": "first four classes", "four_drawn": "four classes at random", "four_alike": "four most alike",
    "six": "first six classes", "six_drawn": "six classes at random", "six_alike": "six most alike",
    "all": "all 22 classes",
}  # fmt: skip
SELECTIONS = {"all": "no selection", "selected": "selection", "selected_training": "selection in training alone"}
KEYS = ["set", "selection", "classifier"]


def build(results: Results) -> Table:
    """Accuracy by set of classes, selection and classifier, beside the thesis's where it has one."""
    rows = results.rows("recorded", "pressure_images").rename(columns={"group": "set", "method": "selection"})
    thesis = results.thesis("table_4_4_imprint_selection_real").set_index("classifier")
    right = rows[rows["metric"] == "accuracy"]
    scores = {key: own["value"].to_numpy() for key, own in right.groupby([*KEYS, "split"])}
    frame = pd.DataFrame([_line(scores, thesis, *key) for key in product(SETS, SELECTIONS, thesis.index)])
    names = {"set": SETS.get, "selection": SELECTIONS.get}
    shown = grid(frame, KEYS[:2], KEYS[2], names=names, head=lambda name: f"{label(name)}: ours · thesis, %", gap=None)
    return Table(frame, shown, _words(rows, frame))


def _line(scores: dict[tuple, np.ndarray], thesis: pd.DataFrame, *key: str) -> dict[str, Any]:
    """A row of one set, selection and classifier."""
    name, selection, classifier = key
    shared = 0.0 if name.endswith("drawn") else shared_by(Split.RANDOM)  # drawn: another set each time
    mean, low, high = within(scores.get((*key, Split.RANDOM), []), shared)
    line: dict[str, Any] = dict(zip(KEYS, key, strict=True)) | {"accuracy": mean, "low": low, "high": high}
    column = f"{name}_{selection}"
    line["thesis"] = thesis.loc[classifier, column] if column in thesis else np.nan
    others = {f"accuracy_{split}": interval(scores.get((*key, split), []))[0] for split in (Split.FOLDS, Split.BLOCKS)}
    return line | others


def _words(rows: pd.DataFrame, frame: pd.DataFrame) -> dict[str, object]:
    """What was removed, and what the random hold-out flatters."""
    by_metric = dict(list(rows.groupby("metric")))
    removed = by_metric["share_similar"].groupby("set")["value"].mean()
    chosen = {
        name: " ".join(rows.loc[rows["set"] == f"{name}_alike", "chosen"].dropna().unique()).split()
        for name in ("four", "six")
    }
    near, far = (interval(by_metric[f"{kind}_correlation"]["value"]) for kind in ("neighbour", "pair"))
    whole = frame[(frame["set"] == "all") & (frame["selection"] == "all")].set_index("classifier")
    lost = 100 * (whole["accuracy"] - whole["accuracy_blocks"])
    return {
        "removed": ", ".join(f"{said} {100 * removed.get(name, np.nan):.1f} %" for name, said in SETS.items()),
        **{name: ", ".join(classes) for name, classes in chosen.items()},
        "near": with_interval(*near, places=2), "far": with_interval(*far, places=2),
        "knn": lost["knn"], "least": lost.min(), "most": lost.max(),
    }  # fmt: skip

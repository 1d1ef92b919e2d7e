"""T table 4.6: recognition by one to five touches."""

from typing import Any

import pandas as pd

from stages.report.grid import grid
from stages.report.items import Table
from stages.report.results import NotRun, Results
from stages.report.style import label

from .rows import ENHANCED, STAGE, accuracies

CLASSIFIERS = ["deep_learning", "naive_bayes", "decision_tree", "svm", "knn"]  # in the thesis's order
FURTHER = ["deep_learning", "naive_bayes", "knn"]  # shown in the further rows; all are in the CSV
VARIANT = r"^(?P<few>first_15)?_?touches_(?P<touches>\d+)(?P<suffix>_\w+)?$"
WAYS = {
    "": "", "_unplaced": "without positions", "_ordered": "touches in the order of their height",
    "_disjoint": "each imprint in one combination",
    "_many": "five times as many combinations", "_mixed": "combinations drawn before the split",
    "first_15_mixed": "drawn before the split, 15 imprints per object",
}  # fmt: skip
KEYS = ["sampling", "way", "classifier", "touches"]


def table_4_6(results: Results) -> Table:
    """Recognition by one to five touches, beside the thesis."""
    rows = results.measured(STAGE, group="six")
    parts = rows["variant"].str.extract(VARIANT).dropna(subset=["touches"])
    if parts.empty:
        raise NotRun("no several touches", STAGE)
    ways, touches = parts["few"].fillna("") + parts["suffix"].fillna(""), parts["touches"].astype(int)
    groups = rows.loc[parts.index].assign(sampling=rows["method"], way=ways, touches=touches).groupby(KEYS)
    frame = pd.DataFrame([dict(zip(KEYS, key, strict=True)) | accuracies(group) for key, group in groups])
    samplings = [ENHANCED, *sorted({*frame["sampling"]} - {ENHANCED})]
    orders: dict[Any, list[str]] = {"way": list(WAYS), "sampling": samplings, "classifier": CLASSIFIERS}
    frame = frame.sort_values(list(orders), key=lambda column: column.map(orders[column.name].index), ignore_index=True)
    thesis = results.thesis("table_4_6_number_of_imprints").set_index("classifier").stack()
    printed = [thesis.get((cell.classifier, str(cell.touches))) for cell in frame.itertuples()]
    plain = (frame["sampling"] == ENHANCED) & (frame["way"] == "")  # as the thesis has it
    frame["thesis"] = pd.Series(printed, dtype=float).where(plain)
    named = frame.assign(name=[_name(cell) for _, cell in frame.iterrows()])
    parts = (named[plain], ("accuracy_regions", "thesis")), (named[~plain & frame["classifier"].isin(FURTHER)], ())
    shown = [
        grid(cells, "name", "touches", beside=beside, head=lambda n: f"{n} touch{'es' if n > 1 else ''}, %")
        for cells, beside in parts
        if not cells.empty
    ]
    wide = pd.concat(shown).fillna("not run").rename(columns={"name": "classifier"})
    return Table(frame, wide, {"group": results.group_text("six")})


def _name(cell: pd.Series) -> str:
    words = [WAYS[cell["way"]], "" if cell["sampling"] == ENHANCED else label(cell["sampling"])]
    further = ", ".join(filter(None, words))
    return label(cell["classifier"]) + (f", {further}" if further else ": ours · unseen regions · thesis")

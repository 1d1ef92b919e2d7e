"""T table 4.6: recognition by one to five touches."""

import re

import pandas as pd

from stages.report.grid import cell_text
from stages.report.items import Table
from stages.report.results import NotRun, Results
from stages.report.style import label

from .rows import ENHANCED, STAGE, accuracies

CLASSIFIERS = ["deep_learning", "naive_bayes", "decision_tree", "svm", "knn"]  # in the thesis's order
FURTHER = ["deep_learning", "naive_bayes", "knn"]  # shown in the further rows; all are in the CSV
NAMED = re.compile(r"(first_15_)?touches_(\d+)(_\w+)?")
WAYS = {
    "": "", "_unplaced": "without positions", "_ordered": "touches in the order of their height",
    "_disjoint": "each imprint in one combination",
    "_many": "five times as many combinations", "_mixed": "combinations drawn before the split",
    "first_15_mixed": "drawn before the split, 15 imprints per object",
}  # fmt: skip
NOTES = [
    "Each cell of the first rows: our hold-out accuracy in per cent [95 % interval], then our accuracy on one "
    "side of all objects that no training touch overlaps, then the thesis's figure; further rows: ours alone.",
    "Each imprint's 41 features become two numbers by a self-organising map of 10 x 10 neurons (RapidMiner's default); "
    "with the position, five numbers per touch. Map and scales are learned on the training touches; a combination "
    "never mixes training and test touches. No PCA: the numbers are few.",
    "The thesis gives no number of combinations: here a few per imprint (classification.combinations), for one "
    "touch (copies) to five, so that all columns train on equally many samples. Its column of one imprint repeats "
    "table 4.5 (no map); ours has the map.",
    "Each imprint in one combination: the more touches, the fewer samples to train on; one guess at why the thesis's "
    "network falls from 79 to 46 per cent.",
    "Drawn before the split: the test's touches were seen in training, in other combinations. The thesis's 15 imprints "
    "per object hold out three or four, which make no five different touches: it seems to have drawn before the split.",
    "SVM: gamma 1 is narrow for 10 to 25 standardised numbers, where every sample is far from all others.",
]


def table_4_6(results: Results) -> Table:
    """Recognition by one to five touches, beside the thesis."""
    rows = results.measured(STAGE, group="six")
    rows = rows.assign(parts=rows["variant"].map(lambda name: NAMED.fullmatch(str(name)))).dropna(subset=["parts"])
    if rows.empty:
        raise NotRun("no several touches", STAGE)
    thesis = results.thesis("table_4_6_number_of_imprints").set_index("classifier")
    rows = rows.assign(
        touches=[int(parts[2]) for parts in rows["parts"]],
        way=[f"{(parts[1] or '').rstrip('_')}{parts[3] or ''}" for parts in rows["parts"]],
    )
    frame = pd.DataFrame(_cells(rows, thesis))
    title = f"Table 4.6: recognising {results.group_text('six')} by one to five touches, beside the thesis"
    return Table(title, frame, NOTES, _wide(frame))


def _cells(rows, thesis):
    cells = []
    for (method, way, classifier, touches), mine in rows.groupby(["method", "way", "classifier", "touches"]):
        printed = float("nan")
        if (method, way) == (ENHANCED, "") and str(touches) in thesis:
            printed = thesis.loc[classifier, str(touches)]
        cell = {"sampling": method, "way": way, "classifier": classifier, "touches": touches}
        cells.append(cell | accuracies(mine) | {"thesis": printed})
    first = [ENHANCED, *sorted({cell["sampling"] for cell in cells} - {ENHANCED})]
    return sorted(cells, key=lambda cell: _place(cell, first))


def _place(cell, samplings):
    """Where a cell stands: ways, samplings and classifiers in their order."""
    orders = (("way", list(WAYS)), ("sampling", samplings), ("classifier", CLASSIFIERS))
    return tuple(order.index(cell[column]) for column, order in orders)


def _wide(frame):
    plain = (frame["sampling"] == ENHANCED) & (frame["way"] == "")
    frame = frame.assign(printed=plain)[plain | frame["classifier"].isin(FURTHER)]
    beside = {True: ("accuracy_regions", "thesis"), False: ()}
    text = [cell_text(row, beside=beside[row["printed"]]) for _, row in frame.iterrows()]
    names = [_name(row, row.printed) for row in frame.itertuples()]
    wide = frame.assign(text=text, name=names).pivot(index="name", columns="touches", values="text")
    wide = wide.loc[list(dict.fromkeys(names))].rename(columns=lambda n: f"{n} touch{'es' if n > 1 else ''}, %")
    return wide.fillna("not run").reset_index(names="classifier")


def _name(row, printed):
    if printed:
        return f"{label(row.classifier)}: ours · unseen regions · thesis"
    words = [WAYS[row.way]] if row.way else []
    if row.sampling != ENHANCED:
        words.append(label(row.sampling))
    return f"{label(row.classifier)}, {', '.join(words)}"

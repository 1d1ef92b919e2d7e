"""T table 4.3: what it brings to leave out imprints that another object has too."""

import pandas as pd

from stages.report.items import Table
from stages.report.markdown import with_interval
from stages.report.results import NotRun
from stages.report.style import label

from ._touch import OURS, accuracies, percent

ENHANCED = OURS["enhanced_visual_attention"]
WAYS = {"plain": "all", "selected": "selected", "selected_train": None}  # variant: column of the thesis's table
SPOKEN = {"plain": "no selection", "selected": "selection", "selected_train": "selection in training alone"}
FEW = {"plain": "first_15", "selected": "first_15_selected", "selected_train": "first_15_selected_train"}
NOTES = [
    "Each cell: our hold-out accuracy in per cent [95 % interval], then the thesis's figure. Enhanced attention.",
    "Selection removes all imprints that correlate by 0.85 or more with an imprint of another object of the set, "
    "before the split, as in the thesis: the test part then holds no hard imprint either, and objects keep unequal "
    "numbers.",
    "Selection in training alone: only training imprints are compared and removed; the test part is whole, as it is "
    "for a robot that cannot choose what it will feel.",
    "In the CSV, recall is the mean over the objects of the rate of right answers, which unequal numbers do not lift.",
    "Rows of 15 imprints: only the first 15 of each object, as the thesis had.",
]


def build(results):
    rows = results.measured("classification", method=ENHANCED, object=["six", "four"], variant=list(WAYS))
    if "selected" not in set(rows["variant"]):
        raise NotRun("; ".join(results.notes("classification", variant="selected")) or "no selection", "classification")
    thesis = results.thesis("table_4_3_imprint_selection_virtual").set_index("classifier")
    few = results.measurements("classification", method=ENHANCED, object=["six", "four"], variant=list(FEW.values()))
    cells = _cells(rows, thesis, {name: name for name in WAYS}, "")
    cells += _cells(few, thesis, FEW, ", 15 imprints")
    frame = pd.DataFrame(cells)
    told = results.notes("classification", method=ENHANCED, variant=[*WAYS, *FEW.values()])
    notes = NOTES + [f"Not run: {note}." for note in told]
    title = "Table 4.3: leaving out imprints that another object has too, beside the thesis"
    return Table(title, frame, notes, _wide(frame))


def _cells(rows, thesis, variants, suffix):
    cells = []
    for classifier in thesis.index:
        for objects in dict.fromkeys(rows["object"]):
            for way, variant in variants.items():
                mine = rows[(rows["classifier"] == classifier) & (rows["object"] == objects)]
                mine = mine[mine["variant"] == variant].dropna(subset=["value"])
                column = f"{objects}_{WAYS[way]}"
                cell = {"classifier": f"{classifier}{suffix}", "objects": objects, "selection": way}
                cell |= accuracies(mine) | {"imprints": mine["imprints"].max()}
                cell["recall"] = mine.loc[mine["metric"] == "recall_holdout", "value"].mean()
                cells.append(cell | {"thesis": thesis.loc[classifier, column] if column in thesis else float("nan")})
    return cells


def _wide(frame):
    text = [
        f"{with_interval(row.accuracy, row.low, row.high, 100, 0)} · {percent(row.thesis)}"
        for row in frame.itertuples()
    ]
    heads = [f"{row.objects}, {SPOKEN[row.selection]}: ours · thesis, %" for row in frame.itertuples()]
    wide = frame.assign(text=text, head=heads).pivot(index="classifier", columns="head", values="text")
    wide = wide.loc[list(dict.fromkeys(frame["classifier"])), list(dict.fromkeys(heads))].reset_index()
    names = [label(name.partition(", ")[0]) + name[len(name.partition(", ")[0]) :] for name in wide["classifier"]]
    return wide.assign(classifier=names)

"""Imprints that another object has too: their shares (section 4.2.4), and what removing them brings (table 4.3)."""

import pandas as pd

from stages.kit.split import Split
from stages.report.grid import grid
from stages.report.items import Table
from stages.report.results import NotRun, Results

from .one_touch import sampling_text
from .rows import ENHANCED, OURS, STAGE, accuracies

WAYS = {"plain": "all", "selected": "selected", "selected_train": None}  # variant: column of the thesis's table
WORDS = {"plain": "no selection", "selected": "selection", "selected_train": "selection in training alone"}
FEW = {"plain": "first_15", "selected": "first_15_selected", "selected_train": "first_15_selected_train"}
SELECTION_NOTES = [
    "Each cell: our hold-out accuracy in per cent [95 % interval], then the thesis's figure. Enhanced attention.",
    "Selection removes all imprints that correlate by 0.85 or more with an imprint of another object of the group, "
    "before the split, as in the thesis: the test part then holds no hard imprint either, and objects keep unequal "
    "numbers.",
    "Selection in training alone: only training imprints are compared and removed; the test part is whole, as it is "
    "for a robot that cannot choose what it will feel.",
    "In the CSV, recall is the mean over the objects of the rate of right answers, which unequal numbers do not lift.",
    "Rows of 15 imprints: only the first 15 of each object, as the thesis had.",
]
# T4.2.4, enhanced visual attention; of the thesis's cow, dromedary, glasses, hand, plane and cup.
BY_OBJECT = {
    "elephant": 0.3333, "duck": 0.4, "eyeglasses": 0.0667, "hand": 0.2667, "airplane": 0.1333, "cup": 0.2,
}  # fmt: skip
SHARE_NOTES = [
    "Per cent of the imprints that have a normalised cross-correlation of 0.85 or more with an imprint of another "
    "object of the group of six. A flat imprint counts as like every other flat one and like nothing else.",
    "The share grows with the number of imprints, since each is compared with all: all of this run's beside the first "
    "15 of each object, as many as the thesis had (its shares by object are fifteenths).",
    "By object: enhanced visual attention. The thesis had cow, dromedary, glasses, hand, plane and cup; each figure "
    "stands beside the object of this run that takes the place.",
]


def table_4_3(results: Results) -> Table:
    """What it brings to leave out imprints that another object has too."""
    where = {"method": ENHANCED, "group": ["six", "four"]}
    rows = results.measured(STAGE, **where, variant=list(WAYS))
    if "selected" not in set(rows["variant"]):
        raise NotRun("; ".join(results.notes(STAGE, variant="selected")) or "no selection", STAGE)
    thesis = results.thesis("table_4_3_imprint_selection_virtual").set_index("classifier")
    few = results.rows(STAGE, **where, variant=list(FEW.values()))
    cells = _selected(rows, thesis, {name: name for name in WAYS}, "")
    frame = pd.DataFrame(cells + _selected(few, thesis, FEW, ", 15 imprints"))
    left_out = results.notes(STAGE, method=ENHANCED, variant=[*WAYS, *FEW.values()])
    shown = grid(
        frame.assign(head=[f"{row.objects}, {WORDS[row.selection]}" for row in frame.itertuples()]), "classifier",
        "head", names={"classifier": sampling_text}, head=lambda name: f"{name}: ours · thesis, %",
    )  # fmt: skip
    title = "Table 4.3: leaving out imprints that another object has too, beside the thesis"
    return Table(title, frame, [*SELECTION_NOTES, *(f"Not run: {note}." for note in left_out)], shown)


def _selected(rows, thesis, variants, suffix):
    cells = []
    for classifier in thesis.index:
        for group in dict.fromkeys(rows["group"]):
            for way, variant in variants.items():
                mine = rows[(rows["classifier"] == classifier) & (rows["group"] == group)]
                mine = mine[mine["variant"] == variant].dropna(subset=["value"])
                at_random, column = mine[mine["split"] == Split.RANDOM], f"{group}_{WAYS[way]}"
                cell = {"classifier": f"{classifier}{suffix}", "objects": group, "selection": way}
                cell |= accuracies(mine) | {"imprints": mine["imprints"].max()}
                cell["recall"] = at_random.loc[at_random["metric"] == "recall", "value"].mean()
                cells.append(cell | {"thesis": thesis.loc[classifier, column] if column in thesis else float("nan")})
    return cells


def section_4_2_4(results: Results) -> Table:
    """How many imprints correlate by 0.85 or more with one of another object."""
    rows = results.measured(STAGE, group="six", metric="similar_share")
    thesis = results.thesis("section_4_2_similar_imprints").set_index("sampling")["share_with_ncc_over_0_85"]
    whole, cells = rows[rows["item"].isna()], []
    for method in dict.fromkeys(rows["method"]):
        name = next((theirs for theirs, ours in OURS.items() if ours == method), method)
        shares = _shares(whole[whole["method"] == method])
        cells.append({"of": "sampling", "name": name} | shares | {"thesis": thesis.get(name)})
    for name, mine in rows[rows["method"] == ENHANCED].dropna(subset=["item"]).groupby("item", sort=False):
        cells.append({"of": "object", "name": name} | _shares(mine) | {"thesis": BY_OBJECT.get(name)})
    order = list(thesis.index)
    cells.sort(key=lambda cell: order.index(cell["name"]) if cell["name"] in order else len(order))
    frame = pd.DataFrame(cells)
    names = [
        name if of == "object" else sampling_text(name) for of, name in zip(frame["of"], frame["name"], strict=True)
    ]
    shown = pd.DataFrame({"of": frame["of"], "name": names})
    for column, head in (("all", "ours, all, %"), ("first_15", "ours, first 15, %"), ("thesis", "thesis, %")):
        shown[head] = 100 * frame[column].astype(float)
    title = "Section 4.2.4: imprints that another object has too, beside the thesis"
    return Table(title, frame, SHARE_NOTES, shown)


def _shares(rows):
    by_variant = rows.set_index("variant")[["value", "imprints"]]
    shares = by_variant["value"]
    imprints = by_variant["imprints"].get("plain")
    return {"imprints": imprints, "all": shares.get("plain"), "first_15": shares.get("first_15")}

"""Imprints that another object has too: their shares, what removing them brings, and how objects correlate (T4.2.4)."""

from itertools import combinations, product

import numpy as np
import pandas as pd

from stages.classification.similarity import SIMILARITY_THRESHOLD, similarity
from stages.kit.files import read_arrays
from stages.kit.split import Split
from stages.report.grid import grid
from stages.report.items import Figure, Table
from stages.report.results import Results, some
from stages.report.style import GREY, INK, METHOD_COLOURS, plt

from .rows import ENHANCED, STAGE, THEIRS, accuracies, fifteen, sampling_text

WAYS = {"plain": "no selection", "selected": "selection", "selected_train": "selection in training alone"}
PRINTED = {"plain": "all", "selected": "selected"}  # column of the thesis's table, behind the group
SAMPLINGS = {"random": "blind touch", ENHANCED: "enhanced visual attention"}  # of the correlations
# T4.2.4, enhanced visual attention; of the thesis's cow, dromedary, glasses, hand, plane and cup.
BY_OBJECT = {
    "elephant": 0.3333, "duck": 0.4, "eyeglasses": 0.0667, "hand": 0.2667, "airplane": 0.1333, "cup": 0.2,
}  # fmt: skip


def table_4_3(results: Results) -> Table:
    """What it brings to leave out imprints that another object has too."""
    where, few = {"method": ENHANCED, "group": ["six", "four"]}, [fifteen(way) for way in WAYS]
    rows = results.measured(STAGE, **where, variant=list(WAYS))
    why = "; ".join(results.notes(STAGE, variant="selected")) or "no selection"
    some(rows[rows["variant"] == "selected"], why, STAGE)
    rows = pd.concat([rows, results.rows(STAGE, **where, variant=few).dropna(subset=["value"])])
    thesis = results.thesis("table_4_3_imprint_selection_virtual").set_index("classifier")
    cells = []
    for suffix, name, group, way in product(("", ", 15 imprints"), thesis.index, rows["group"].unique(), WAYS):
        variant = fifteen(way) if suffix else way
        mine = rows[(rows["classifier"] == name) & (rows["group"] == group) & (rows["variant"] == variant)]
        recall = mine[(mine["split"] == Split.RANDOM) & (mine["metric"] == "recall")]["value"].mean()
        printed = thesis.loc[name].get(f"{group}_{PRINTED.get(way)}", np.nan)
        cell = {"classifier": f"{name}{suffix}", "objects": group, "selection": way} | accuracies(mine)
        cells.append(cell | {"imprints": mine["imprints"].max(), "recall": recall, "thesis": printed})
    frame = pd.DataFrame(cells)
    shown = grid(
        frame.assign(head=frame["objects"] + ", " + frame["selection"].map(WAYS)), "classifier", "head",
        names={"classifier": sampling_text}, head=lambda name: f"{name}: ours · thesis, %",
    )  # fmt: skip
    return Table(frame, shown, {"not_run": results.left_out(STAGE, method=ENHANCED, variant=[*WAYS, *few])})


def section_4_2_4(results: Results) -> Table:
    """How many imprints correlate by 0.85 or more with one of another object."""
    rows = results.measured(STAGE, group="six", metric="similar_share")
    thesis = results.thesis("section_4_2_similar_imprints").set_index("sampling")["share_with_ncc_over_0_85"]
    rows = rows[rows["item"].isna() | (rows["method"] == ENHANCED)]
    rows = rows.assign(
        of=np.where(rows["item"].isna(), "sampling", "object"), name=rows["item"].fillna(rows["method"].replace(THEIRS))
    )
    wide = rows.pivot_table(index=["of", "name"], columns="variant", values=["imprints", "value"], sort=False)
    columns = {"imprints": ("imprints", "plain"), "all": ("value", "plain"), "first_15": ("value", "first_15")}
    frame = wide.reindex(columns=list(columns.values())).set_axis(list(columns), axis=1).reset_index()
    frame["thesis"] = frame["name"].map(thesis.to_dict() | BY_OBJECT)
    order = {"sampling": 0, "object": 1} | {name: k for k, name in enumerate(thesis.index)}
    frame = frame.sort_values(["of", "name"], key=lambda column: column.map(order), ignore_index=True)
    shown = frame[["of"]].assign(name=frame["name"].where(frame["of"] == "object", frame["name"].map(sampling_text)))
    for column, head in (("all", "ours, all, %"), ("first_15", "ours, first 15, %"), ("thesis", "thesis, %")):
        shown[head] = 100 * frame[column]
    return Table(frame, shown)


def figure_4_4(results: Results) -> Figure:
    """Correlations of the imprints of each two objects, for blind touch and enhanced attention."""
    folder = results.folder("classification")
    groups = sorted(folder.glob("six.*.npz")) or sorted(folder.glob("four.*.npz"))
    first = some(groups, "no groups in data/classification", "classification")[0]
    pairs = list(combinations(map(str, read_arrays(first)["objects"]), 2))
    images = {name: results.imprints(name) for pair in pairs for name in pair}
    found = {way: [similarity(images[one][way], images[two][way]) for one, two in pairs] for way in SAMPLINGS}
    order = np.argsort([np.median(values) for values in found[ENHANCED]], kind="stable")
    figure, axes = plt.subplots(figsize=(7.6, 0.42 * len(pairs) + 1.2))
    for offset, (method, words) in zip((0.18, -0.18), SAMPLINGS.items(), strict=True):
        tint, correlations = METHOD_COLOURS[method], [found[method][k] for k in order]
        axes.boxplot(
            [values.ravel() for values in correlations], positions=np.arange(len(pairs)) + offset, widths=0.3,
            orientation="horizontal", whis=(5, 95), showfliers=False, patch_artist=True,
            boxprops={"facecolor": tint, "edgecolor": tint, "alpha": 0.75}, medianprops={"color": INK},
            whiskerprops={"color": tint}, capprops={"color": tint}, label=words,
        )  # fmt: skip
        for k, values in enumerate(correlations):
            share = (values.max(axis=1) >= SIMILARITY_THRESHOLD).mean()
            axes.text(1.03, k + offset, f"{100 * share:.0f} %", va="center", fontsize=8, color=INK)
    axes.axvline(SIMILARITY_THRESHOLD, color=GREY, lw=1, ls="--")
    axes.text(1.03, len(pairs) - 0.35, "share", fontsize=8, color=INK)
    axes.set_yticks(range(len(pairs)), [" – ".join(pairs[k]) for k in order])
    axes.set(xlim=(-1, 1), xlabel="normalised cross-correlation of two imprints")
    axes.tick_params(axis="y", length=0)
    axes.set_title("How alike the imprints of two objects are", pad=26)
    axes.legend(loc="lower left", bbox_to_anchor=(-0.01, 0.99), ncols=2, fontsize=9)
    return Figure(figure, {"threshold": SIMILARITY_THRESHOLD})

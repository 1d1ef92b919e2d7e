"""Imprints that another object has too: their shares, what removing them brings, and how objects correlate (T4.2.4)."""

from itertools import combinations, product

import numpy as np
import pandas as pd

from haptic_glance.base.files import read_arrays
from haptic_glance.know.features import SIMILARITY_THRESHOLD, similarity
from haptic_glance.know.split import Split
from stages.report.drawing import GREY, INK, colours, label, plt
from stages.report.items import Figure, Table
from stages.report.results import Results, dataset_text, some
from stages.report.tables import Ranking, blocks, grid

from .rows import EQUAL, PRINTED, SSIM, STAGE, Protocol, accuracies, fifteen, protocols, sampling_text

THESIS = "the thesis"
WAYS = {
    "plain": "no selection", "selected": "selection", "selected_control": "as many left out at random",
    "selected_train": "selection in training alone",
}  # fmt: skip
PRINTED_WAYS = {"plain": "all", "selected": "selected"}  # column of the thesis's table, behind the group
# T4.2.4, enhanced visual attention; of the thesis's cow, dromedary, glasses, hand, plane and cup.
BY_OBJECT = {
    "elephant": 0.3333, "duck": 0.4, "eyeglasses": 0.0667, "hand": 0.2667, "airplane": 0.1333, "cup": 0.2,
}  # fmt: skip


def table_4_3(results: Results) -> Table:
    """The gain from leaving out imprints that another object has too, by protocol."""
    fifteen_ways = [fifteen(way) for way in WAYS]
    thesis = results.thesis("table_4_3_imprint_selection_virtual").set_index("classifier")
    selected = {version.dataset for version in protocols(results, variant="selected")}
    versions = protocols(results, group=["six", "four"], variant=[*WAYS, *fifteen_ways])
    frame = pd.concat(
        [_selections(version, thesis) for version in versions if version.dataset in selected], ignore_index=True
    )
    down, few_of = ["protocol", "classifier"], frame["classifier"].str.contains(", ")
    cells = frame.assign(thesis=frame["thesis"].mask(few_of))
    cells = cells.assign(head=cells["objects"] + ", " + cells["selection"].map(WAYS))
    cells, names = blocks(cells, down, "head", {"thesis": lambda protocol: THESIS}), {"classifier": sampling_text}
    text_table = grid(cells, down, "head", names, head=lambda name: f"{name}, %", printed=THESIS)
    words = {"not_run": results.left_out(STAGE, variant=[*WAYS, *fifteen_ways])}
    return Table(frame, text_table, words, Ranking("six, no selection, %", among=["protocol"], exempt=[THESIS]))


def _selections(protocol: Protocol, thesis: pd.DataFrame) -> pd.DataFrame:
    """Accuracies of one protocol at its model's points by classifier, group and way to select, with the thesis's."""
    rows, cells = protocol.rows[protocol.rows["method"] == protocol.best], []
    for suffix, name, group, way in product(("", ", 15 imprints"), thesis.index, rows["group"].unique(), WAYS):
        variant = fifteen(way) if suffix else way
        trials = rows[(rows["classifier"] == name) & (rows["group"] == group) & (rows["variant"] == variant)]
        recall = trials[(trials["split"] == Split.RANDOM) & (trials["metric"] == "recall")]["value"].mean()
        printed = thesis.loc[name].get(f"{group}_{PRINTED_WAYS.get(way)}", np.nan)
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
        name=frame["name"].where(frame["of"] == "object", frame["name"].map(sampling_text))
    )
    for column, head in (("all", "ours, all, %"), ("first_15", "ours, first 15, %"), ("thesis", "thesis, %")):
        text_table[head] = 100 * frame[column]
    return Table(frame, text_table)  # no ranking: a share of alike imprints is neither good nor bad


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


def figure_4_4(results: Results) -> Figure:
    """Correlations of the imprints of each two objects, for blind touch and the thesis's attention."""
    folder = results.folder("classification")
    dataset = folder.parent.name
    best = EQUAL if dataset == PRINTED else SSIM
    groups = sorted(folder.glob("six.*.npz")) or sorted(folder.glob("four.*.npz"))
    first = some(groups, "no groups in data/classification", "classification")[0]
    pairs = list(combinations(map(str, read_arrays(first)["objects"]), 2))
    images = {name: results.imprints(name, dataset) for pair in pairs for name in pair}
    samplings = {method: label(method) for method in ("random", best)}
    likeness = {way: [similarity(images[a][way], images[b][way]) for a, b in pairs] for way in samplings}
    order = np.argsort([np.median(values) for values in likeness[best]], kind="stable")
    paint = colours(list(samplings))
    figure, axes = plt.subplots(figsize=(7.6, 0.42 * len(pairs) + 1.2))
    for offset, (method, words) in zip((0.18, -0.18), samplings.items(), strict=True):
        tint, correlations = paint[method], [likeness[method][k] for k in order]
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
    return Figure(figure, {"threshold": SIMILARITY_THRESHOLD, "set": dataset_text(dataset)})

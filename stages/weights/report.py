"""Channel weights and SVMs learned from people, beside the thesis's (T table 3.1, T3.2.3)."""

from contextlib import suppress
from typing import Any

import pandas as pd

from stages.charts.datasets import GABOR_3_2, MENDED_3_2, SECTION_3_2, dataset_text
from stages.charts.drawing import label
from stages.charts.items import Table
from stages.charts.results import NotRun, Results, require_rows
from stages.charts.tables import Ranking, everywhere, grouped, number, over_items, percent, records, with_interval
from stages.engine.statistics import interval

MEAN = ["mean", "low", "high"]
KINDS = {"guided_ssim": "SSIM", "guided_ed": "1 − ED", "guided_ssim+object": "SSIM, object"}
PRINTED = {"ssim": "guided_ssim", "one_minus_ed": "guided_ed"}  # columns of the thesis's weights
TRAINING = {"one_for_all": "one for all", "one_per_object": "one per object", "one_per_viewpoint": "one per viewpoint"}
VALIDATION = {"pixels": "random pixels", "views": "whole views", "objects": "whole objects"}
AREA = {"image": "whole image", "object": "the object"}
THESIS = {"one_svm_for_all_objects": "one_for_all", "one_svm_per_object": "one_per_object"}
KEYS = ["dataset", "area", "training", "validation"]
FIRST = {name: place for place, name in enumerate((SECTION_3_2, MENDED_3_2, GABOR_3_2, "gaze"))}
ORDER = {name: place for place, name in enumerate([*AREA, *TRAINING, *VALIDATION])}


def table_3_1(results: Results) -> Table:
    """How like each channel's map is to the ground truth's, and how near its brightest places are."""
    rows = _gaze_first(results, "weight", "no weights learned from ground truth")
    rows = require_rows(rows[rows["method"].isin(KINDS)], "no weights learned from ground truth", "weights")
    frame = pd.DataFrame([
        {"method": method, "channel": channel, **_over_objects(group), "dataset": dataset}
        for (dataset, method, channel), group in grouped(rows, ["dataset", "method", "channel"])
    ])  # fmt: skip
    thesis = results.thesis("table_3_1_channel_weights").set_index("channel").rename(columns=PRINTED)
    thesis = thesis[list(PRINTED.values())]
    frame = frame.merge(thesis.reset_index().melt("channel", var_name="method", value_name="thesis"), how="left")
    tops = ", ".join(f"{label(channel)} by {KINDS[str(method)]}" for method, channel in thesis.idxmax().items())
    table, heads = _wide(frame), [f"{kind}, ours" for kind in KINDS.values()]
    return Table(frame, table, {"tops": tops, "ranks": _ranks(frame)}, Ranking(heads), split="objects")


def _wide(frame: pd.DataFrame) -> pd.DataFrame:
    """A row a data set and channel, each likeness beside the thesis's."""
    parts = {}
    for method, kind in KINDS.items():
        rows = frame[frame["method"] == method].set_index(["dataset", "channel"])
        if rows["thesis"].notna().any():
            parts[f"{kind}, thesis"] = rows["thesis"].map(number)
        means = rows[MEAN].itertuples(index=False)
        parts[f"{kind}, ours"] = pd.Series([with_interval(*mean, places=2) for mean in means], rows.index)
    table, order = pd.DataFrame(parts).fillna("not run"), frame[["dataset", "channel"]].drop_duplicates()
    table = table.reindex(list(order.itertuples(index=False, name=None))).rename(label, level="channel")
    return table.rename(dataset_text, level="dataset").reset_index(names=["objects", "channel"])


def _gaze_first(results: Results, metric: str, missing: str) -> pd.DataFrame:
    """Measured rows of the weights of all sets that have them: the readings of T3.2, then on grey objects with gaze."""
    rows = pd.concat(everywhere(results, "weights", missing, metric=metric).values())
    return rows.sort_values("dataset", key=lambda names: names.map(FIRST).fillna(len(FIRST)), kind="stable")


def _over_objects(group: pd.DataFrame) -> dict[str, float]:
    """One learned weight from all objects, with its interval over the objects' own values."""
    parts = own_values(group)
    _, low, high = interval(parts)
    mean = group.loc[group["item"].isna(), "value"].iloc[0]
    return {"mean": mean, "low": low, "high": high, "objects": max(len(parts), 1)}


def own_values(group: pd.DataFrame) -> pd.Series:
    """(objects,) each object's part in one learned weight, the jackknife's pseudo-values: n m - (n - 1) m_without."""
    of_all = group["item"].isna()
    return pseudo_values(group.loc[of_all, "value"].iloc[0], group[~of_all].set_index("item")["value"])


def pseudo_values(whole: float, without: pd.Series) -> pd.Series:
    """(objects,) each object's part in a statistic, by its value of all objects and of all but one (Tukey 1958)."""
    return len(without) * whole - (len(without) - 1) * without


def _ranks(frame: pd.DataFrame) -> str:
    """How alike the channels' order is to the thesis's, in words."""
    ranks = []
    for (dataset, method), group in grouped(frame.dropna(subset=["thesis"]), ["dataset", "method"]):
        rank = group["mean"].corr(group["thesis"], method="spearman")
        ranks.append(f"{KINDS[method]}, {dataset_text(dataset)} {rank:.2f}")
    return "; ".join(ranks)


def section_3_2_3(results: Results) -> Table:
    """How often the SVM is right about a pixel, and what the background alone would give."""
    rows = _gaze_first(results, "accuracy", "no SVM was trained")
    frame = pd.DataFrame([
        dict(zip([*KEYS, "accuracy", "low", "high"], (*key, *interval(over_items(group))), strict=True))
        | {"svms": len(group), **group[["deviation", "background_alone"]].mean().to_dict()}
        for key, group in grouped(rows, KEYS)
    ])  # fmt: skip
    frame = frame.sort_values(KEYS[1:], key=lambda column: column.map(ORDER), kind="stable").reset_index(drop=True)
    thesis = results.thesis("section_3_2_3_svm_accuracy").replace({"training": THESIS})
    thesis = thesis.assign(area="image", validation="pixels").set_index(KEYS[1:])  # its way
    frame = frame.join(thesis[["accuracy", "std"]].add_prefix("thesis_"), on=KEYS[1:])
    findings = [
        f"{dataset_text(row.dataset)}, {TRAINING[row.training]}, the thesis's way: {100 * row.accuracy:.1f} %; the "
        f"background alone gives {100 * row.background_alone:.1f} %."
        for row in records(frame.dropna(subset=["thesis_accuracy"]))
    ]
    with suppress(NotRun):
        findings += _spread_of_gains(_gaze_first(results, "information_gain", "no information gain was measured"))
    text_table = pd.DataFrame(map(_shown, records(frame)))
    # no ranking: the ways to test differ, not the SVMs
    return Table(frame, text_table, {"findings": "\n".join(findings)}, split="truth")


def _spread_of_gains(rows: pd.DataFrame) -> list[str]:
    """A sentence for each data set: the spread of the information gain of symmetry over the objects."""
    sentences = []
    for dataset, part in rows[rows["area"] == "image"].groupby("dataset", sort=False):
        gains = part.pivot(index="item", columns="channel", values="value")
        shares = (gains.std() / gains.mean()).dropna()
        others = shares.drop("symmetry")
        sentences.append(
            f"{dataset_text(str(dataset))}: the information gain of symmetry deviates by "
            f"{percent(shares['symmetry'], 0)} % of its mean, that of other channels by {percent(others.min(), 0)} to "
            f"{percent(others.max(), 0)} %."
        )
    return sentences


def _shown(row: Any) -> dict[str, str | int]:
    """A row of the SVMs for a reader; the deviation is that over the folds of one SVM."""
    ours = with_interval(row.accuracy, row.low, row.high, 100, 1)
    deviations = [
        f"{percent(mean, 1)} ± {percent(deviation, 1)}" if mean == mean else "–"
        for mean, deviation in ((row.accuracy, row.deviation), (row.thesis_accuracy, row.thesis_std))
    ]
    return {
        "truth": dataset_text(row.dataset), "pixels of": AREA[row.area], "SVMs": TRAINING[row.training],
        "left out for testing": VALIDATION[row.validation], "ours, %": ours if row.low == row.low else deviations[0],
        "background alone, %": percent(row.background_alone, 1), "thesis, %": deviations[1], "number": row.svms,
    }  # fmt: skip


PAGE = "look"
TABLES = {
    "table_3_1": table_3_1,
    "section_3_2_3": section_3_2_3,
}
FIGURES = {}
CHARTS = {}

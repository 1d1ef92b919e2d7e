"""What was learned from the ground truth, beside the thesis: weights of channels (T table 3.1) and SVMs (T3.2.3)."""

from contextlib import suppress
from typing import Any

import numpy as np
import pandas as pd

from stages.kit.stats import interval
from stages.report.grid import grouped, percent
from stages.report.items import Table
from stages.report.markdown import number, with_interval
from stages.report.results import NotRun, Results

KINDS = {"guided_ssim": "SSIM", "guided_ed": "1 − ED", "guided_ssim_object": "SSIM, object"}
PRINTED = {"guided_ssim": "ssim", "guided_ed": "one_minus_ed"}  # columns of the thesis's weights
TRAINING = {"one_for_all": "one for all", "one_per_object": "one per object", "one_per_viewpoint": "one per viewpoint"}
VALIDATION = {"pixels": "random pixels", "views": "whole views", "objects": "whole objects"}
AREA = {"image": "whole image", "object": "the object"}
THESIS = {"one_svm_for_all_objects": "one_for_all", "one_svm_per_object": "one_per_object"}
KEYS = ["dataset", "area", "training", "validation"]
ORDER = {name: place for place, name in enumerate([*AREA, *TRAINING, *VALIDATION])}


def table_3_1(results: Results) -> Table:
    """How like each channel's map is to the ground truth's, and how near its brightest places are."""
    rows = _everywhere(results, "weight", "no weights learned from ground truth")
    found = [
        {"method": method, "channel": channel, **_over_objects(group), "dataset": dataset}
        for (dataset, method, channel), group in grouped(rows, ["dataset", "method", "channel"])
        if method in KINDS
    ]
    if not found:
        raise NotRun("no weights learned from ground truth", "weights")
    frame = pd.DataFrame(found)
    thesis = results.thesis("table_3_1_channel_weights").set_index("channel")
    printed = {(method, channel): value for method in PRINTED for channel, value in thesis[PRINTED[method]].items()}
    frame["thesis"] = [printed.get(key, np.nan) for key in zip(frame["method"], frame["channel"], strict=True)]
    cells = {
        (row["method"], row["channel"], row["dataset"]): with_interval(row["mean"], row["low"], row["high"], places=2)
        for row in frame.to_dict("records")
    }
    shown = pd.DataFrame({"channel": thesis.index})
    for method, kind in KINDS.items():
        if method in PRINTED:
            shown[f"{kind}: thesis"] = thesis[PRINTED[method]].map(number).to_list()
        for dataset in sorted(set(frame["dataset"])):
            objects = frame.loc[frame["dataset"] == dataset, "objects"].max()
            shown[f"{kind}: {dataset} ({objects})"] = [
                cells.get((method, channel, dataset), "not run") for channel in thesis.index
            ]
    tops = ", ".join(f"{thesis[column].idxmax()} in {KINDS[method]}" for method, column in PRINTED.items())
    return Table(frame, shown, {"tops": tops, "ranks": _ranks(frame)})


def _everywhere(results: Results, metric: str, missing: str) -> pd.DataFrame:
    """Measured rows of the weights of all sets that have them, those of the people's gaze first."""
    found = []
    for dataset in sorted(results.datasets("weights"), key=lambda name: name != "gaze"):
        with suppress(NotRun):
            found.append(results.measured("weights", dataset, metric=metric))
    if not found:
        raise NotRun(missing, "weights")
    return pd.concat(found)


def _over_objects(group: pd.DataFrame) -> dict[str, float]:
    """One learned weight from all objects, with its interval over the objects.

    A mean over n objects and the means without each of them tell each object's own value: n m - (n - 1) m_without.
    """
    mean = group.loc[group["item"].isna(), "value"].iloc[0]
    without = group.loc[group["item"].notna(), "value"].to_numpy()
    n = len(without)
    _, low, high = interval(n * mean - (n - 1) * without)
    return {"mean": mean, "low": low, "high": high, "objects": max(n, 1)}


def _ranks(frame: pd.DataFrame) -> str:
    """How alike the channels' order is to the thesis's, in words."""
    said = []
    for (dataset, method), group in grouped(frame.dropna(subset=["thesis"]), ["dataset", "method"]):
        rank = np.corrcoef(group["mean"].rank(), group["thesis"].rank())[0, 1]  # Spearman's
        best = group.sort_values("mean")["channel"].iloc[-1]
        said.append(f"{KINDS[method]}, {dataset}: {best} comes first, rank correlation {rank:.2f}")
    return "; ".join(said)


def section_3_2_3(results: Results) -> Table:
    """How often the SVM is right about a pixel, and what the background alone would give."""
    frame = pd.DataFrame([
        dict(zip([*KEYS, "accuracy", "low", "high"], (*key, *interval(group["value"])), strict=True))
        | {"svms": len(group), **group[["deviation", "background_alone"]].mean().to_dict()}
        for key, group in grouped(_everywhere(results, "accuracy", "no SVM was trained"), KEYS)
    ])  # fmt: skip
    frame = frame.sort_values(KEYS[1:], key=lambda column: column.map(ORDER), kind="stable").reset_index(drop=True)
    thesis = results.thesis("section_3_2_3_svm_accuracy").set_index("training").rename(index=THESIS)
    thesis = thesis[["accuracy", "std"]].add_prefix("thesis_")
    frame = frame.join(thesis, on="training")
    frame.loc[(frame["area"] != "image") | (frame["validation"] != "pixels"), list(thesis)] = np.nan
    said = [
        f"{row['dataset']}, {TRAINING[row['training']]}, the thesis's way: {100 * row['accuracy']:.1f} %; the "
        f"background alone gives {100 * row['background_alone']:.1f} %."
        for row in frame.dropna(subset=["thesis_accuracy"]).to_dict("records")
    ]
    return Table(frame, pd.DataFrame(map(_shown, frame.itertuples())), {"said": "\n".join(said)})


def _shown(row: Any) -> dict[str, str | int]:
    """A row of the SVMs for a reader; the deviation is that over the folds of one SVM."""
    ours = with_interval(row.accuracy, row.low, row.high, 100, 1)
    deviations = [
        f"{percent(mean, 1)} ± {percent(deviation, 1)}" if mean == mean else "–"
        for mean, deviation in ((row.accuracy, row.deviation), (row.thesis_accuracy, row.thesis_std))
    ]
    return {
        "truth": row.dataset, "pixels of": AREA[row.area], "SVMs": TRAINING[row.training],
        "left out for testing": VALIDATION[row.validation], "ours, %": ours if row.low == row.low else deviations[0],
        "background alone, %": percent(row.background_alone, 1), "thesis, %": deviations[1], "number": row.svms,
    }  # fmt: skip

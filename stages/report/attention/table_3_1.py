"""T table 3.1: how like each channel's map is to the ground truth's, and how near its brightest places are."""

from contextlib import suppress

import pandas as pd

from stages.kit.stats import interval
from stages.report.items import Table
from stages.report.markdown import number, with_interval
from stages.report.results import NotRun, Results

from .rows import gaze_first

KINDS = {"guided_ssim": "SSIM", "guided_ed": "1 − ED", "guided_ssim_object": "SSIM, object"}
THESIS = {"guided_ssim": "ssim", "guided_ed": "one_minus_ed"}
NOTES = [
    "SSIM: likeness of a channel's map to the ground truth's map, over the whole image as in T3.2.1.4, and over the "
    "object's pixels alone: black background is alike in all maps, and is most of what the first measures. 1 − ED: "
    "nearness of the brightest pixels to the ground truth points (T3.2.1.1). Mean [95 % interval over objects].",
    "Thesis: 43 models of the 3D interest point benchmark, points clicked by people. Gaze: meshes with the gaze of 32 "
    "people, whose peaks are the points. Other sets: their own ground truth, for the household objects marks by a "
    "vision model. Compare the order of the channels, not the digits.",
]


def build(results: Results) -> Table:
    rows = []
    for dataset in gaze_first(results.datasets("weights")):
        with suppress(NotRun):
            own = results.measured("weights", dataset, metric="weight")
            rows += [row | {"dataset": dataset} for row in _weights(own)]
    if not rows:
        raise NotRun("no weights learned from ground truth", "weights")
    frame = pd.DataFrame(rows)
    thesis = results.thesis("table_3_1_channel_weights").set_index("channel")
    frame["thesis"] = [thesis.loc[row.channel].get(THESIS.get(row.method), float("nan")) for row in frame.itertuples()]
    title = "Table 3.1: each channel's agreement with the ground truth, beside the thesis"
    return Table(title, frame, [*_order(frame), *NOTES], _wide(frame, thesis))


def _weights(table):
    """Rows of the learned weights from all objects, with intervals over the objects.

    A mean over n objects and the means without each of them tell each object's own value: n m - (n - 1) m_without.
    """
    rows = []
    for (method, channel), group in table[table["method"].isin(KINDS)].groupby(["method", "channel"], sort=False):
        mean = group.loc[group["item"].isna(), "value"].iloc[0]
        without = group.loc[group["item"].notna(), "value"].to_numpy()
        values = len(without) * mean - (len(without) - 1) * without if len(without) else [mean]
        _, low, high = interval(values)
        objects = max(len(without), 1)
        rows.append({"method": method, "channel": channel, "mean": mean, "low": low, "high": high, "objects": objects})
    if not rows:
        raise NotRun("no object has ground truth", "weights", runnable=False)
    return rows


def _order(frame):
    """How alike the channels' order is to the thesis's, in words."""
    said = []
    for (dataset, method), group in frame.dropna(subset=["thesis"]).groupby(["dataset", "method"], sort=False):
        rank = group["mean"].corr(group["thesis"], method="spearman")
        best = group.loc[group["mean"].idxmax(), "channel"]
        said.append(f"{KINDS[method]}, {dataset}: {best} comes first, rank correlation {rank:.2f}")
    tops = ", ".join(
        f"{frame.loc[frame[frame['method'] == m]['thesis'].idxmax(), 'channel']} in {KINDS[m]}" for m in THESIS
    )
    return [f"First in the thesis: {tops}. " + "; ".join(said) + "."]


def _wide(frame, thesis):
    cells = {(row.dataset, row.method, row.channel): with_interval(row.mean, row.low, row.high, places=2)
             for row in frame.itertuples()}  # fmt: skip
    objects = frame.groupby("dataset")["objects"].max()
    shown = pd.DataFrame({"channel": thesis.index})
    for method, kind in KINDS.items():
        if method in THESIS:
            shown[f"{kind}: thesis"] = [number(thesis.loc[channel, THESIS[method]]) for channel in thesis.index]
        for dataset in objects.index:
            name = f"{kind}: {dataset} ({objects[dataset]})"
            shown[name] = [cells.get((dataset, method, channel), "not run") for channel in thesis.index]
    return shown

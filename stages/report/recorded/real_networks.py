"""Networks for photographs on recorded touches: those at hand, and T tables 5.1, 5.2 and 5.5 of those that are not."""

from functools import partial
from typing import Any

import pandas as pd

from stages.kit.split import Split, shared_by
from stages.kit.stats import interval
from stages.report.grid import percent
from stages.report.items import Table
from stages.report.markdown import signed, with_interval
from stages.report.networks import MODES, PRINTED, STARTS, origin
from stages.report.results import Results
from stages.report.style import label

from .rows import CLASSICAL, DATA, OVER, SPLITS, measured, measured_lines

ABSENT = (
    "Not run: the data set is not at hand. Its reader is tested on files in its layout; "
    "`experiment=recorded_touches` says how to switch it on."
)


def build(results: Results) -> Table:
    """Accuracy of each network, start and mode on each recording and split, with its gains over the controls."""
    frame = measured_lines(results)
    return Table(frame, pd.DataFrame([_shown(row) for row in frame.itertuples()]))


def _shown(row: Any) -> dict[str, Any]:
    """A row of `measured_lines` for a reader."""
    return {
        "data": DATA.get(row.data, row.data),
        "split": SPLITS.get(row.split, row.split),
        "network": "features and kNN" if row.method == CLASSICAL[0] else label(row.method),
        "starts from": origin(row.weights, row.pretrained) if row.weights in STARTS else "–",
        "filters": f"{label(row.mode)}, {row.size} px" if row.mode else "–",
        "accuracy, %": with_interval(row.accuracy, row.low, row.high, 100, 1),
        "guessing, %": percent(row.guess, 1),
        "over features and kNN": _gain(row.over_features, row.over_features_low, row.over_features_high),
        "over random weights": _gain(row.over_random, row.over_random_low, row.over_random_high),
        "over": f"{row.values} {'objects' if row.split in OVER else 'splits'}",
    }


def _gain(*points: float) -> str:
    """Points gained [interval]; a dash where there is nothing to compare with."""
    return signed(*(100 * value for value in points), places=1) if points[0] == points[0] else "–"


def printed(data: str, thesis: str, results: Results) -> Table:
    """Networks on one of the thesis's data sets: its own table, and ours where the data were at hand."""
    figures = results.thesis(thesis).set_index("network")
    rows = measured(results, "accuracy")
    mine = rows[(rows["data"] == data) & (rows["split"] == Split.RANDOM) & (rows["weights"] == "imagenet")]
    frame = pd.DataFrame({"network": list(PRINTED)})
    shown = pd.DataFrame({"network": [label(network) for network in PRINTED]})
    for mode in MODES:
        own = {network: mine[(mine["method"] == network) & (mine["mode"] == mode)]["value"] for network in PRINTED}
        found = [interval(values, shared_by(Split.RANDOM)) for values in own.values()]
        frame[[mode, f"{mode}_low", f"{mode}_high"]] = found
        frame[f"{mode}_thesis"] = figures.loc[[*PRINTED.values()], f"acc_{mode}"].to_numpy()
        shown[f"{label(mode)}: ours, %"] = [with_interval(*ends, 100, 1) for ends in found]
        shown[f"{label(mode)}: thesis, %"] = frame[f"{mode}_thesis"].map(partial(percent, places=1))
    return Table(frame, shown, {"absent": "" if len(mine) else ABSENT})

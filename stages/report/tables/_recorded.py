"""What the tables of recorded touches read: rows of reports/transfer/recorded.csv."""

import pandas as pd

from stages.report.intervals import HOLD_OUT, interval
from stages.report.items import Table
from stages.report.markdown import with_interval
from stages.report.style import label, start

from ._transfer import HAD, PRINTED, STARTS

DATA = {
    "pressure": "pressure array, 22 objects",
    "grasps_object": "fingertips, which of 51 objects",
    "grasps_slip": "fingertips, slips or not",
    "vt60": "VT-60 (BathTip)",
    "vitac": "ViTac (GelSight)",
    "bigs": "BiGS (Barrett hand)",
}
SPLITS = {
    "random": "touches at random",
    "runs": "neighbouring touches together",
    "test_objects": "objects kept for the test",
    "objects": "unseen objects",
    "recordings": "recordings together",
}
OVER = {"test_objects": 0.0, "objects": 0.0}  # splits whose values are of independent objects
ABSENT = "Not run: the data set is not at hand. Its reader is tested on files in its layout; `make transfer` takes it."
NOTE = (
    "Accuracy in per cent, a quarter of the touches held out. Recorded touches that are at hand: table real_networks."
)


def printed_table(results, data, printed, title):
    """The Table of one of the thesis's data sets: its figures, and ours where the data were at hand."""
    thesis = results.thesis(printed).set_index("network")
    rows = results.transfer("recorded")
    mine = rows[(rows["data"] == data) & (rows["metric"] == "accuracy") & (rows["split"] == "random")]
    mine = mine.dropna(subset=["value"])
    frame = pd.DataFrame([_printed_line(mine, thesis, *pair) for pair in PRINTED.items()])
    return Table(title, frame, [NOTE] if len(mine) else [ABSENT, NOTE], _printed_shown(frame))


def _printed_line(mine, thesis, network, name):
    line = {"network": network}
    for mode in ("finetuned", "frozen"):
        own = mine[(mine["method"] == network) & (mine["mode"] == mode) & (mine["weights"] == "imagenet")]
        mean, low, high = interval(own["value"], HOLD_OUT)
        line |= {
            mode: mean,
            f"{mode}_low": low,
            f"{mode}_high": high,
            f"{mode}_thesis": thesis.loc[name, f"acc_{mode}"],
        }
    return line


def _printed_shown(frame):
    shown = pd.DataFrame({"network": frame["network"].map(label)})
    for mode in ("finetuned", "frozen"):
        triples = zip(frame[mode], frame[f"{mode}_low"], frame[f"{mode}_high"], strict=True)
        shown[f"{label(mode)}: ours, %"] = [with_interval(*triple, 100, 1) for triple in triples]
        shown[f"{label(mode)}: thesis, %"] = [f"{100 * value:.1f}" for value in frame[f"{mode}_thesis"]]
    return shown


def measured_lines(results):
    """A frame with a row a data set, split, network, start and mode that was measured, the classical features first."""
    rows = results.transfer("recorded")
    rows = rows[rows["metric"] == "accuracy"].dropna(subset=["value"])
    lines = []
    keys = ["data", "split", "method", "weights", "mode"]
    for key, part in rows.groupby(keys, sort=False, dropna=False):
        values = part["value"]
        if key[1] in OVER and "object" in part:  # objects are the units: a mean each, without that of all together
            values = part[part["object"] != "all"].groupby("object")["value"].mean()
        mean, low, high = interval(values, OVER.get(key[1], HOLD_OUT))
        had = next(iter(part["had"].dropna()), None) if "had" in part else None
        triple = {"accuracy": mean, "low": max(low, 0.0), "high": min(high, 1.0), "values": len(values), "had": had}
        lines.append(dict(zip(keys, key, strict=True)) | triple)
    return pd.DataFrame(lines)


def origin(weights, had):
    """What a row starts from, and which of ImageNet's weights it had."""
    if weights not in STARTS:
        return "–"
    said = HAD.get(had, "") if weights == "imagenet" else ""
    return f"{start(weights)} ({said})" if said else start(weights)

"""Real grasps by three BioTac SP fingertips: will the object slip, and which object is it."""

import pandas as pd

from stages.kit.split import Split, shared_by
from stages.kit.stats import interval
from stages.report.items import Table
from stages.report.markdown import with_interval
from stages.report.style import label

BY = ["task", "split", "palm", "scaled", "components"]
TASKS = {
    ("slip", Split.TEST_OBJECTS): "slips or not, ten objects kept for the test",
    ("slip", Split.OBJECTS): "slips or not, objects left out of training in turn",
    ("recognition", Split.RANDOM): "which of 51 objects, a random quarter held out",
    ("recognition", Split.BLOCKS): "which of 51 objects, a run of rows held out",
}
SCALED = {"training": "training part", "own": "each part by its own"}
NOTES = [
    "Accuracy in per cent [95 % interval]. Slip: the mean over the objects, the interval over objects: it carries to "
    "others of this kind. Recognition: over five repeated splits, widened for what they share. Majority: always the "
    "answer that is the more frequent in training.",
    "Data: BTS3 v2, 5,831 grasps of 51 objects by a Shadow hand, three fingertips of 24 electrodes, its palm down, at "
    "45 degrees or to the side (Garcia-Garcia, Zapata-Impata, Orts-Escolano, Gil and Garcia-Rodriguez, TactileGCN: a "
    "graph convolutional network for predicting grasp stability with tactile sensors, IJCNN 2019). 41 objects to "
    "learn from, ten never grasped before to be asked about, once.",
    "Readings of 72 electrodes, z-transformed, then the thesis's 12 principal components or the electrodes as they "
    "are; the five classifiers with the thesis's settings. The thesis has no such experiment.",
]


def build(results):
    rows = results.rows("recorded", "biotac_grasps")
    scores = rows[rows["metric"] == "accuracy"]
    found = []
    for key, group in scores.groupby([*BY, "classifier"], sort=False):
        shared = shared_by(Split.RANDOM) if group["item"].isna().all() else 0.0
        mean, low, high = interval(group["value"], shared)
        found.append(dict(zip([*BY, "classifier"], key, strict=True)) | {"accuracy": mean, "low": low, "high": high})
    frame = pd.DataFrame(found).astype({"components": int})
    return Table("Real grasps: slip and recognition", frame, [*NOTES, *_said(rows, frame)], _wide(frame))


def _said(rows, frame):
    moved = {kind: rows[rows["metric"] == kind].set_index("palm")["value"] for kind in ("drift", "drift_drawn")}
    told, usual = (", ".join(f"palm {palm} {value:.1f}" for palm, value in one.items()) for one in moved.values())
    yield (
        "Drift: from the training objects to the test objects the mean reading of an electrode moves, in standard "
        f"deviations of the training objects' own means, by {told}; to as many training objects, drawn at random, by "
        f"{usual} at most. What is beyond that hardly came with the objects, but between the recordings. "
        f"{_better(frame)}"
    )
    yield (
        "Rows of one object stand in the order of recording and neighbours are alike: held out at random, recognition "
        "is of the recording as much as of the object."
    )


def _better(frame):
    """How many classifiers are better than the majority on one palm direction, by the way they are scaled."""
    mine = frame[
        (frame["task"] == "slip") & (frame["split"] == Split.TEST_OBJECTS) & (frame["palm"] != "all")
    ].set_index(BY)
    common = mine.loc[mine["classifier"] == "majority", "accuracy"]
    others = mine[mine["classifier"] != "majority"]
    counts = (others["low"] > common.reindex(others.index)).groupby(["palm", "scaled"]).agg(["sum", "size"])
    told = [f"palm {palm}, {SCALED[way]} {one['sum']} of {one['size']}" for (palm, way), one in counts.iterrows()]
    return f"With their whole interval above the majority, by palm and scale: {'; '.join(told)}."


def _wide(frame):
    text = [
        with_interval(row.accuracy, max(row.low, 0.0), min(row.high, 1.0), 100, 0)
        if row.low == row.low else with_interval(row.accuracy, row.low, row.high, 100, 0)
        for row in frame.itertuples()
    ]  # fmt: skip
    order = list(dict.fromkeys(frame["classifier"]))
    wide = frame.assign(text=text).pivot(index=BY, columns="classifier", values="text")[order]
    keys = sorted(wide.index, key=lambda key: (list(TASKS).index(key[:2]), key[2] != "all", key[2:]))
    wide = wide.loc[keys].rename(columns=lambda name: f"{label(name)}, %").reset_index()
    shown = pd.DataFrame({"task": [TASKS[key[:2]] for key in keys], "palm": wide["palm"]})
    shown["scaled by"] = wide["scaled"].map(SCALED)
    shown["values"] = [f"{value} components" if value == 12 else "electrodes" for value in wide["components"]]
    return shown.join(wide.drop(columns=BY))

"""Grasps by a hand with pressure arrays over time, recognised by binned pressure, each grasp held out whole."""

import pandas as pd

from stages.engine.statistics import interval
from stages.report.drawing import label
from stages.report.items import Table
from stages.report.results import Results
from stages.report.tables import Ranking, grouped, records, signed, with_interval, within

SET, OURS = "schunk", "discriminant"
BEST = Ranking("grasps left out in turn, %")


def build(results: Results) -> Table:
    """Each method: all grasps left out in turn, with intervals over grasps, and the publisher's five test grasps."""
    rows = results.rows("recorded", SET, metric="accuracy")
    scores = {key: own.set_index("item")["value"] for key, own in grouped(rows, ["method", "part"])}
    lines = []
    for method in rows["method"].unique():
        own, listed = scores[method, "training"], scores[method, "test"]
        line = {"method": method, **dict(zip(("accuracy", "low", "high"), within(own), strict=True))}
        gain = dict(zip(("gain", "gain_low", "gain_high"), interval(scores[OURS, "training"] - own), strict=True))
        lines.append(line | gain | {"grasps": len(own), "listed": int(listed.sum()), "listed_of": len(listed)})
    frame = pd.DataFrame(lines)
    shown = pd.DataFrame({
        "method": frame["method"].map(label),
        "grasps left out in turn, %": [
            with_interval(row.accuracy, row.low, row.high, 100, 0) for row in records(frame)
        ],
        f"{label(OURS)} − it": [
            "–" if row.method == OURS else signed(100 * row.gain, 100 * row.gain_low, 100 * row.gain_high, places=0)
            for row in records(frame)
        ],
        "published test list": frame["listed"].astype(str) + " of " + frame["listed_of"].astype(str),
    })  # fmt: skip
    counts = rows[rows["part"] == "training"].drop_duplicates("item")["item"].str.split("/").str[0].value_counts()
    return Table(frame, shown, {"grasps": int(counts.sum()), "commonest": 100 * counts.max() / counts.sum()}, BEST)

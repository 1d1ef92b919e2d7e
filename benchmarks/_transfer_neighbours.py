"""The classifier of T4 on the recorded touches that networks are trained on, on the same splits."""

from pathlib import Path

import pandas as pd

from stages.kit.files import read_table

TOUCH = Path("reports/touch")
METHOD = "features_knn"  # the hand-made features of T4, or the electrodes, and the k nearest neighbours
SPLITS = {"accuracy_holdout": "random", "accuracy_blocked": "runs", "holdout": "random", "blocked": "runs"}


def nearest_neighbours():
    """Rows of the classifier of reports/touch: on the same splits, by the same numbers."""
    images, grasps = read_table(TOUCH / "real.csv"), read_table(TOUCH / "grasps.csv")
    images = images[(images["object"] == "all") & (images["method"] == "all") & (images["classifier"] == "knn")]
    grasps = grasps[(grasps["classifier"] == "knn") & (grasps["scaled"] == "training") & (grasps["palm"] == "all")]
    grasps = grasps[(grasps["metric"] == "accuracy") & (grasps["components"] == grasps["components"].max())]
    slips = grasps[(grasps["task"] == "slip") & (grasps["split"] == "unseen")]
    objects = grasps[grasps["task"] == "recognition"]
    images = images[images["metric"].isin(SPLITS)].assign(split=images["metric"])
    yield from _rows(images, "pressure_images", "pressure", "real.csv")
    yield from _rows(objects, "bts3", "grasps_object", "grasps.csv")
    yield from _rows(slips.assign(repetition=0), "bts3", "grasps_slip", "grasps.csv")
    whole = (slips["value"] * slips["count"]).sum() / slips["count"].sum()
    whole = pd.DataFrame([{"split": "unseen", "value": whole, "repetition": 0}])
    yield from _rows(whole, "bts3", "grasps_slip", "grasps.csv")


def _rows(frame, dataset, data, table):
    for row in frame.to_dict("records"):
        one = row.get("object") if data == "grasps_slip" else None
        yield {
            "dataset": dataset, "object": one or "all", "data": data, "method": METHOD,
            "split": SPLITS.get(row["split"], "test_objects"), "repetition": int(row["repetition"]),
            "metric": "accuracy", "value": row["value"], "seconds": row.get("seconds"),
            "note": f"reports/touch/{table}",
        }  # fmt: skip

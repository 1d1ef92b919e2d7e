"""What the trainings on recorded touches say: intervals, chance, and gains over the controls."""

from pathlib import Path

import pandas as pd

from stages.kit.files import read_table
from stages.kit.stats import bootstrap_interval

TOUCH = Path("reports/touch")
METHOD = "features_knn"  # the hand-made features of T4, or the electrodes, and the k nearest neighbours
SPLITS = {"accuracy_holdout": "random", "accuracy_blocked": "runs", "holdout": "random", "blocked": "runs"}
KEYS = ["data", "split", "method", "weights", "had", "mode", "size"]


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


def summary(frame):
    """One row a kind of training: accuracy with its interval, chance, and what it gains over two controls.

    The interval is over repetitions; where the test objects are fixed (test_objects), over these objects, each the mean
    of its repetitions. gain_over_random: over the same network from random weights; gain_over_knn: over the nearest
    neighbours; both differences on the same split, or object, with their own intervals.
    """
    rows, values = [], frame[(frame["metric"] == "accuracy") & frame["value"].notna()].copy()
    values[KEYS] = values[KEYS].astype(object).where(values[KEYS].notna(), "")
    chances = frame[frame["metric"] == "chance"].groupby("data")["value"].first()
    majority = frame[frame["metric"] == "majority"].groupby(["data", "split"])["value"].mean()
    kinds = {key: _units(part) for key, part in values.groupby(KEYS, sort=False)}
    for key, units in kinds.items():
        named = dict(zip(KEYS, key, strict=True))
        data, split = named["data"], named["split"]
        row = {**named, "over": "objects" if split == "test_objects" else "repetitions", "units": len(units)}
        row |= _interval("accuracy", units)
        row |= {"chance": chances.get(data), "majority": majority.get((data, split))}
        if named["weights"] == "imagenet":
            random = tuple((named | {"weights": "random", "had": "none"}).values())
            row |= _gain("gain_over_random", units, kinds.get(random))
        if named["method"] != METHOD:
            row |= _gain("gain_over_knn", units, kinds.get((data, split, METHOD, "", "", "", "")))
        rows.append(row)
    notes = frame[frame["note"].astype(str).str.startswith("not run")][["data", "method", "weights", "mode", "note"]]
    return pd.concat([pd.DataFrame(rows), notes], ignore_index=True)


def _units(part):
    """The accuracies that an interval is taken over: a repetition's, or an object's mean over the repetitions."""
    fixed = part["split"].iloc[0] == "test_objects"
    part = part[(part["object"] != "all") == fixed]
    return part.groupby("object" if fixed else "repetition")["value"].mean()


def _interval(name, values):
    mean, low, high = bootstrap_interval(values)
    return {name: mean, f"{name}_low": low, f"{name}_high": high}


def _gain(name, units, others):
    if others is None:
        return {}
    return _interval(name, (units - others).dropna())

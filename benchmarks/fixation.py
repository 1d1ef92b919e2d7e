"""Attention of networks beside human gaze: `python -m benchmarks.fixation FOLDER`

FOLDER: a working tree in which `dvc repro fixation` ran on meshes with human gaze (`make fixation` leaves one in
build/fixation). Writes reports/fixation: gaze.csv (the rows of reports/measurements/fixation.csv without dataset and
seed, values to four digits), tasks.csv and elbow.csv (the classes of the meshes and how their number was found),
summary.csv (method, task, metric, the mean over the meshes with its interval, seconds a mesh) and hours.csv (what
fine-tuning costs and gains: network, seconds of all meshes frozen and fine-tuned, agreement of either, difference with
its interval over the meshes).
"""

from pathlib import Path

import numpy as np
import pandas as pd

from benchmarks import arguments
from stages.fixation.judge import WHOLE
from stages.kit.files import read_table, whole_file
from stages.weights.agreement import mean_interval, paired

OUT = Path("reports/fixation")
MODEL = "ewigc"


def per_mesh(rows):
    """Series (method, task, metric, object) -> mean over the views; nss and auc are of all views together."""
    views = rows["view"].astype(str) != WHOLE
    own = rows[views | rows["metric"].isin(["nss", "auc", "pcc_tasks", "entropy"])].dropna(subset=["value", "object"])
    return own[own["task"].notna()].groupby(["method", "task", "metric", "object"])["value"].mean()


def summary(rows):
    """Frame of the means over the meshes with their intervals."""
    seconds = rows.dropna(subset=["task", "object"]).groupby(["method", "task"])["seconds"].median()
    found = []
    for (method, task, metric), values in per_mesh(rows).groupby(level=[0, 1, 2]):
        mean, low, high = mean_interval(values.to_numpy())
        found.append({"method": method, "task": task, "metric": metric, "meshes": len(values), "mean": mean,
                      "low": low, "high": high, "seconds": seconds.get((method, task), np.nan)})  # fmt: skip
    return pd.DataFrame(found)


def hours(rows):
    """Frame of networks that ran frozen and fine-tuned: seconds of the whole data set, agreement and its difference."""
    values, found = per_mesh(rows), []
    spent = rows[rows["metric"].isin(["views", "accuracy"])].dropna(subset=["seconds"])
    spent = spent.groupby("method")["seconds"].sum()
    for name in spent.index[spent.index.str.endswith("-finetuned")]:
        network, frozen = name.rpartition("-")[0], f"{name.rpartition('-')[0]}-frozen"
        if frozen not in spent:
            continue
        for metric in ("pcc", "nss", "auc", "distance"):
            own = {one: values.get((one, MODEL, metric), pd.Series(dtype=float)) for one in (frozen, name)}
            pair = pd.DataFrame(own).dropna()
            if pair.empty:
                continue
            mean, low, high = paired(pair[name].to_numpy(), pair[frozen].to_numpy())
            found.append({"network": network, "metric": metric, "frozen_seconds": spent[frozen],
                          "finetuned_seconds": spent[name], "frozen": pair[frozen].mean(),
                          "finetuned": pair[name].mean(), "difference": mean, "low": low, "high": high})  # fmt: skip
    columns = ["network", "metric", "frozen_seconds", "finetuned_seconds", "frozen", "finetuned", "difference", "low"]
    return pd.DataFrame(found, columns=[*columns, "high"])


def write(name, frame):
    """Writes a table with four significant digits."""
    with whole_file(OUT / f"{name}.csv") as part:
        frame.to_csv(part, index=False, float_format="%.4g")
    print(f"{OUT / name}.csv: {len(frame):,} rows", flush=True)


def main():
    """Writes the five tables."""
    folder = Path(arguments(__doc__, "folder").folder)
    rows = read_table(folder / "reports/measurements/fixation.csv")
    write("gaze", rows.drop(columns=["dataset", "seed"]))
    for name in ("tasks", "elbow"):
        write(name, read_table(folder / f"data/fixation/{name}.csv"))
    write("summary", summary(rows))
    write("hours", hours(rows))


if __name__ == "__main__":
    main()

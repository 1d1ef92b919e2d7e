"""Networks trained on imprints (chapter 5): their accuracies by data set, and confusion matrices, for several topics.

`measured` and `everywhere` select accuracies by number of passes, `both` tests a claim on touches at random and on
objects left out. A confusion matrix is in per cent of the true class.
"""

from typing import Any

import pandas as pd

from haptic_glance.know.split import shared_by
from stages.charts import tables
from stages.charts.drawing import label, start
from stages.charts.results import NotRun, Results

# As the thesis calls them, in its order.
PRINTED = {name: label(name) for name in ("alexnet", "googlenet", "vgg16", "resnet50", "mobilenet_v2")}
FINE, COARSE = "imprints128", "imprints16"
THESIS = {FINE: "table_5_4_simulated_fsr_128x128", COARSE: "table_5_3_fsr_16x16"}  # its tables of them
SPLITS = {"random": "touches at random", "objects": "unseen objects"}
THEIRS = "princeton_six"  # the set of the thesis's classes
OF_CLASS = {THEIRS: 5}  # objects of each class; of the other sets three
STARTS, MODES = ("imagenet", "random", "random_initial"), ("finetuned", "frozen")
PASSES = {  # of the trainings, over the touches
    "printed": "10, as printed", "converged": "until nothing improves", "printed_rate": "10, at the printed rate",
}  # fmt: skip
PRETRAINED = {"complete": "", "convolutions": "its convolutions", "converted": "converted from Keras"}
NETWORK = "mobilenet_v2"


def measured(results: Results, dataset: str | None = None, passes: str = "printed", **where: object) -> pd.DataFrame:
    """Accuracies on one set after as many passes as `passes` says; NotRun where there is none."""
    rows = of_passes(results.measured("transfer", dataset, metric="accuracy", **where), passes)
    if rows.empty:
        raise NotRun(f"no training with passes {passes}", "transfer", runnable=False)
    return rows


def everywhere(results: Results, *passes: str, metric: str = "accuracy", **where: Any) -> dict[str, pd.DataFrame]:
    """{set: accuracies}: of all sets that have them; NotRun where none has. passes: printed without any."""
    by_set = tables.everywhere(results, "transfer", metric=metric, **where)
    by_dataset = {source: accuracies for source, rows in by_set.items() if len(accuracies := of_passes(rows, *passes))}
    if not by_dataset:
        raise NotRun(f"no training with passes {' or '.join(passes)}", "transfer", runnable=False)
    return by_dataset


def of_passes(rows: pd.DataFrame, *passes: str) -> pd.DataFrame:
    """The rows of trainings with some of PASSES, printed without any; rows that do not say theirs are printed.

    Splits that no fine-tuned training as printed has are left out where there is one, else those that no training as
    printed has, so that tables and charts compare all on the same splits.
    """
    padded_rows = rows.reindex(columns=[*rows.columns.drop("passes", errors="ignore"), "passes"])
    padded_rows["passes"] = padded_rows["passes"].fillna("printed")
    splits = pd.MultiIndex.from_frame(padded_rows[["dataset", "split", "repetition"]])
    kinds, is_printed = splits.droplevel("repetition"), padded_rows["passes"] == "printed"
    is_tuned = is_printed & (padded_rows["mode"] == "finetuned")
    is_leading = is_tuned | (is_printed & ~kinds.isin(kinds[is_tuned]))
    comparable = splits.isin(splits[is_leading]) | ~kinds.isin(kinds[is_leading]) | padded_rows["mode"].isna()
    return padded_rows[padded_rows["passes"].isin(passes or ("printed",)) & comparable]


def shared(split: str, dataset: str | None = None) -> float:
    """Test over training share of a split of a data set: of each class one object is left out."""
    return shared_by(split, OF_CLASS.get(dataset or "", 3))


def mean(values: pd.Series, split: str, dataset: str | None = None) -> tuple[float, float, float]:
    """(mean, low, high) of shares over the repetitions: splits of the same items, or folds of objects left out."""
    return tables.within(list(values), shared(split, dataset))


def accuracy(rows: pd.DataFrame, split: str) -> dict[str, float]:
    """{accuracy, low, high, values} of the rows of one setting on one set."""
    trials = rows[rows["split"] == split]
    ends = mean(trials["value"], split, next(iter(trials["dataset"]), None))
    return dict(zip(("accuracy", "low", "high", "values"), (*ends, len(trials)), strict=True))


def seen(rows: pd.DataFrame) -> str:
    """The touches that the networks of some rows saw, in words; empty for rows that do not say it."""
    kinds = rows.reindex(columns=["touches", "size"]).drop_duplicates().dropna().astype(int)
    return " or ".join(f"{touches} touches an object at {size} px" for touches, size in kinds.itertuples(index=False))


def origin(weights: str, pretrained: str | None) -> str:
    """The weights that a network starts from, and the part of ImageNet's weights that they have."""
    part = PRETRAINED.get(pretrained or "", "") if weights == "imagenet" else ""
    return f"{start(weights)} ({part})" if part else start(weights)

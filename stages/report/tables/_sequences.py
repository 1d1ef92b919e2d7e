"""What table 4.9, figure 4.19, their chart and their claims read: accuracies of whole sequences."""

from stages.report.intervals import interval
from stages.report.results import NotRun

SPLITS = {"sequences": "sequences drawn at random", "objects": "unseen objects"}
CLASSIFIERS = {
    "cnn": "CNNs",
    "cnn_images": "CNN, images alone",
    "cnn_normals": "CNN, normals alone",
    "knn": "kNN",
    "svm": "SVM",
    "knn_no_som": "kNN, without the map",
    "svm_no_som": "SVM, without the map",
}
PRINTED = ("cnn", "knn", "svm")  # those of T table 4.9
BLIND, GUIDED = "random", "thesis_ssim"  # the two columns of T table 4.9
RANDOM_SPLIT = 0.2 / 0.8  # test over training share of the random splits, T4.4.10


def whole(rows):
    """The rows of sequences with all their frames and cells."""
    return rows[(rows["frames"] == rows["frames"].max()) & (rows["cells"] == rows["cells"].max())]


def measured(results):
    """The rows of this run with whole sequences; NotRun where there is none."""
    return whole(results.measured("sequences", metric=["accuracy", "accuracy_object"]))


def on_princeton(results):
    """The rows on the thesis's own data set with whole sequences; NotRun where they were not measured."""
    return whole(results.touch("sequences_princeton").dropna(subset=["value"]))


def everywhere(results):
    """{where the objects come from: rows with whole sequences}: this run's, and Princeton's where it was measured."""
    found = {}
    try:
        rows = measured(results)
        found[rows["object"].iloc[0]] = rows
    except NotRun as missing:
        absent = missing
    try:
        found |= {f"{name}, as in the thesis": own for name, own in on_princeton(results).groupby("object")}
    except NotRun:
        if not found:
            raise absent from None
    return found


def accuracy(rows, split):
    """(mean, low, high, values): over random splits of the same sequences, or over the objects that were left out.

    rows: of one strategy, classifier and size.
    """
    rows = rows[rows["split"] == split]
    metric, shared = ("accuracy_object", 0.0) if split == "objects" else ("accuracy", RANDOM_SPLIT)
    values = rows.loc[rows["metric"] == metric, "value"]
    mean, low, high = interval(values, shared)
    return mean, max(low, 0.0), min(high, 1.0), len(values)

"""What table 4.9, figure 4.19, their chart and their claims read: accuracies of whole sequences."""

from stages.kit.split import Split
from stages.kit.stats import interval

SPLITS = {Split.RANDOM: "sequences drawn at random", Split.OBJECTS: "unseen objects"}
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
STAGE, THESIS_SET = "sequences", "princeton_eight"  # the latter is of the thesis's size


def whole(rows):
    """The rows of sequences with all their frames and cells."""
    return rows[(rows["frames"] == rows["frames"].max()) & (rows["cells"] == rows["cells"].max())]


def measured(results):
    """The accuracies of whole sequences, on the first set that has any; NotRun where there is none."""
    return whole(results.measured(STAGE, metric=["accuracy", "accuracy_object"]))


def on_princeton(results):
    """The rows on the thesis's own data set with whole sequences; NotRun where they were not measured."""
    return whole(results.measured(STAGE, THESIS_SET))


def everywhere(results):
    """{data set: rows with whole sequences}; NotRun where no set has any."""
    names, where = results.datasets(STAGE), {"metric": ["accuracy", "accuracy_object"]}
    return {name: whole(results.measured(STAGE, name, **where)) for name in names} or measured(results)


def accuracy(rows, split):
    """(mean, low, high, values): over random splits of the same sequences, or over the objects that were left out.

    rows: of one strategy, classifier and size.
    """
    rows = rows[rows["split"] == split]
    metric, shared = ("accuracy_object", 0.0) if split == Split.OBJECTS else ("accuracy", RANDOM_SPLIT)
    values = rows.loc[rows["metric"] == metric, "value"]
    mean, low, high = interval(values, shared)
    return mean, max(low, 0.0), min(high, 1.0), len(values)

"""Claims of T4.4: what a whole contour tells, guided or blind, to networks and to conventional classifiers."""

from stages.kit.split import Split
from stages.report.results import NotRun
from stages.report.verdict import FunctionClaim as Claim

from .rows import BLIND, GUIDED, PRINTED, RANDOM_SPLIT, measured, on_princeton

POINTS = "points of accuracy"
OVER = {Split.OBJECTS: (["group", "repetition"], "accuracy_object"), Split.RANDOM: (["repetition"], "accuracy")}


def scores(rows, split, classifiers, method):
    """Series of accuracies in per cent, an object left out or a random split; of several classifiers the mean."""
    over, metric = OVER[split]
    for column, wanted in (("split", [split]), ("metric", [metric]), ("method", [method]), ("classifier", classifiers)):
        rows = rows[rows[column].isin(wanted)]
        if not set(wanted) <= set(rows[column]):
            raise NotRun(
                f"{column} {' or '.join(wanted)} is not among those that sequences measured", "sequences", False
            )
    return 100 * rows.groupby(over)["value"].mean()


def between(split, read, first, second):
    """differences(results): accuracy of `first` minus of `second`, each (classifiers, strategy)."""

    def differences(results):
        one, other = (scores(read(results), split, *side) for side in (first, second))
        return (one - other).dropna().to_numpy()

    return differences


def best_rival(split, read):
    """differences(results): the networks minus the better of kNN and SVM (by mean accuracy), guided."""

    def differences(results):
        networks, *rivals = (scores(read(results), split, [name], GUIDED) for name in PRINTED)
        best = max(rivals, key=lambda rival: rival.mean())
        return (networks - best).dropna().to_numpy()

    return differences


def flattered(results):
    """Mean accuracy at random splits minus that on each object left out, networks, guided."""
    rows = measured(results)
    return (
        scores(rows, Split.RANDOM, ["cnn"], GUIDED).mean() - scores(rows, Split.OBJECTS, ["cnn"], GUIDED)
    ).to_numpy()


def both(key, section, sentence, tested_on, differences, read=measured):
    """The claim with sequences drawn at random, as in the thesis, and with unseen objects. read: rows of Results."""
    unseen = f"{sentence[:-1]}, on objects never touched too."
    return [
        Claim(f"{key}_random", section, sentence, f"{tested_on}, sequences drawn at random", POINTS, "repetitions",
              differences(Split.RANDOM, read), RANDOM_SPLIT),
        Claim(f"{key}_unseen", section, unseen, f"{tested_on}, unseen objects", POINTS, "objects",
              differences(Split.OBJECTS, read)),
    ]  # fmt: skip


def compared(first, second):
    """(split, read) -> differences(results) of two (classifiers, strategy)."""
    return lambda split, read: between(split, read, first, second)


def at_full_size(key, sentence, tested_on, differences):
    """The claim on the thesis's own data set and number of sequences."""
    sentence = f"{sentence[:-1]}, with 22,800 sequences."
    return both(f"{key}_princeton", "T4.4.10", sentence, f"psb, {tested_on}", differences, on_princeton)


CLAIMS = [
    *both(
        "contours_guided", "T4.4.10", "Contours through visually interesting points are better than blind ones.",
        "CNNs, enhanced minus blind", compared((["cnn"], GUIDED), (["cnn"], BLIND)),
    ),
    *both(
        "contours_guided_all", "T4.4.10", "Guided contours are better, averaged over the classifiers.",
        "mean of CNNs, kNN and SVM, enhanced minus blind", compared((list(PRINTED), GUIDED), (list(PRINTED), BLIND)),
    ),
    *both(
        "contours_ours", "ours", "Contours through points of our model of gaze are better than blind ones.",
        "CNNs, ours minus blind", compared((["cnn"], "enhanced"), (["cnn"], BLIND)),
    ),
    *both(
        "contours_cnn_best", "T4.4.10", "Networks lead on sequences.",
        "enhanced, CNNs minus the better of kNN and SVM", best_rival,
    ),
    *both(
        "contours_both_over_images", "T4.4.8", "Images and normals together beat the images alone.",
        "enhanced, both networks minus that of the images", compared((["cnn"], GUIDED), (["cnn_images"], GUIDED)),
    ),
    *both(
        "contours_both_over_normals", "T4.4.8", "Images and normals together beat the normals alone.",
        "enhanced, both networks minus that of the normals", compared((["cnn"], GUIDED), (["cnn_normals"], GUIDED)),
    ),
    *both(
        "contours_map_helps", "T4.4.9", "Reducing the features by a self-organising map helps.",
        "enhanced, mean of kNN and SVM with the map minus without",
        compared((["knn", "svm"], GUIDED), (["knn_no_som", "svm_no_som"], GUIDED)),
    ),
    *at_full_size(
        "contours_guided", "Contours through visually interesting points are better than blind ones.",
        "CNNs, enhanced minus blind", compared((["cnn"], GUIDED), (["cnn"], BLIND)),
    ),
    *at_full_size(
        "contours_guided_all", "Guided contours are better, averaged over the classifiers.",
        "mean of CNNs, kNN and SVM, enhanced minus blind", compared((list(PRINTED), GUIDED), (list(PRINTED), BLIND)),
    ),
    *at_full_size(
        "contours_cnn_best", "Networks lead on sequences.",
        "enhanced, CNNs minus the better of kNN and SVM", best_rival,
    ),
    Claim(
        "contours_random_flatters", "ours", "Drawing test sequences at random flatters: the same objects are known.",
        "enhanced, CNNs, sequences drawn at random minus unseen objects", POINTS, "objects", flattered,
    ),
]  # fmt: skip

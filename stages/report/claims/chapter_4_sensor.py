"""Claims of T4.3.2: what the pressure array's size and its sensels' distance do to recognition."""

from stages.report.results import NotRun
from stages.report.verdict import Claim, paired

POINTS = "points of accuracy"
FINE, COARSE, SMALL, LARGE = 0.002, 0.01, 16, 32  # the arrays of T figure 4.9


def arrays(first, second, classifier=None):
    """differences(results): accuracy with the array `first` minus with `second`, an object left out each."""

    def differences(results):
        where = {"metric": "accuracy"} | ({"classifier": classifier} if classifier else {})
        return 100 * paired(results, "sensor_size", ["tested"], first, second, **where).to_numpy()

    return differences


def gain_of_cells(results):
    """What 32 x 32 cells add to 16 x 16 where sensels are large, minus what they add where they are small."""
    gains = [
        paired(results, "sensor_size", ["tested"], array(LARGE, pitch), array(SMALL, pitch), metric="accuracy")
        for pitch in (COARSE, FINE)
    ]
    return 100 * (gains[0] - gains[1]).dropna().to_numpy()


def array(cells, pitch):
    """The rows of one array."""
    return {"cells": cells, "pitch": pitch}


def knn_over_the_best_other(results):
    """kNN minus the best of the other classifiers (by mean accuracy), the thesis's best array."""
    where = array(LARGE, COARSE) | {"metric": "accuracy"}
    means = results.measured("sensor_size", **where).groupby("classifier")["value"].mean()
    others = means.drop("knn", errors="ignore")
    if others.empty or "knn" not in means:
        raise NotRun("kNN and another classifier are needed", "sensor_size", runnable=False)
    sides = {"classifier": "knn"}, {"classifier": others.idxmax()}
    return 100 * paired(results, "sensor_size", ["tested"], *sides, **where).to_numpy()


def known_over_unseen(results):
    """Accuracy on other touches of known objects minus on the same objects left out, the thesis's best array."""
    sides = {"metric": "accuracy_holdout"}, {"metric": "accuracy"}
    return 100 * paired(results, "sensor_size", ["tested"], *sides, **array(LARGE, COARSE)).to_numpy()


def sensor_claim(key, sentence, tested_on, differences, section="T4.3.2"):
    """A claim on the accuracy of touches of objects that were left out; its pairs are these objects."""
    return Claim(key, section, sentence, tested_on, POINTS, "objects", differences)


CLAIMS = [
    sensor_claim(
        "larger_pitch_helps_16", "At equal cells a sensor with larger sensels is better (16 x 16).",
        "mean of all classifiers, unseen objects, 0.01 minus 0.002", arrays(array(SMALL, COARSE), array(SMALL, FINE)),
    ),
    sensor_claim(
        "larger_pitch_helps_32", "At equal cells a sensor with larger sensels is better (32 x 32).",
        "mean of all classifiers, unseen objects, 0.01 minus 0.002", arrays(array(LARGE, COARSE), array(LARGE, FINE)),
    ),
    sensor_claim(
        "more_cells_help", "At equal sensel size a larger sensor is better.",
        "mean of all classifiers, unseen objects, 0.01 apart, 32 x 32 minus 16 x 16",
        arrays(array(LARGE, COARSE), array(SMALL, COARSE)),
    ),
    sensor_claim(
        "more_cells_help_all", "At equal sensel size a larger sensor is better, whatever the size.",
        "mean of all classifiers and all distances of sensels, unseen objects, 32 x 32 minus 16 x 16",
        arrays({"cells": LARGE}, {"cells": SMALL}), section="ours",
    ),
    sensor_claim(
        "cells_matter_less_when_fine", "With small sensels, more of them change less than with large ones.",
        "mean of all classifiers, unseen objects, gain by 32 x 32 over 16 x 16 at 0.01 minus the same gain at 0.002",
        gain_of_cells,
    ),
    sensor_claim(
        "knn_best_sensor", "kNN is the best classifier of single touches of unseen objects.",
        "32 x 32, 0.01 apart, kNN minus the best of the others", knn_over_the_best_other,
    ),
    sensor_claim(
        "finer_sensor_enough", "Half the cells at twice the distance are as good: the width counts, not the cells.",
        "mean of all classifiers, unseen objects, 16 x 16 at 0.02 minus 32 x 32 at 0.01",
        arrays(array(SMALL, 2 * COARSE), array(LARGE, COARSE)), section="ours",
    ),
    sensor_claim(
        "known_objects_easier", "Touches of known objects flatter: their class is named more often than unseen ones'.",
        "mean of all classifiers, 32 x 32, 0.01 apart, a random quarter of the touches minus objects left out",
        known_over_unseen, section="ours",
    ),
]  # fmt: skip

"""Claims of T4.2.4 on the real sensor (table 4.4), on the touches that others recorded; and ours on simulation."""

import numpy as np

from stages.kit.split import Split, shared_by
from stages.report.claims import POINTS
from stages.report.results import NotRun
from stages.report.verdict import FunctionClaim as Claim

METRIC = "accuracy"
SIMULATED = "resting_skin"  # the simulation that was meant to be the closest, before any result was seen


def _scores(results, over="repetition", split=Split.RANDOM, **where):
    """Series of the accuracies of recorded pressure images, indexed by `over`; NotRun without any."""
    rows = results.rows("recorded", "pressure_images", split=split)
    for column, wanted in where.items():
        rows = rows[rows[column] == wanted]
    found = rows.dropna(subset=["value"]).groupby(over)["value"].mean()
    if found.empty:
        raise NotRun(f"recorded holds no {' '.join(map(str, where.values()))}", "recorded", runnable=False)
    return found


def selection(name, method="selected", metric=METRIC, classifier=None):
    """differences(results): accuracy with the selection minus without, one classifier or the mean of all."""

    def differences(results):
        where = {"group": name, "metric": metric} | ({"classifier": classifier} if classifier else {})
        gain = _scores(results, method=method, **where) - _scores(results, method="all", **where)
        return 100 * gain.dropna().to_numpy()

    return differences


def knn_best(name):
    """differences(results): kNN minus the best of the others by their means, without selection."""

    def differences(results):
        where = {"group": name, "metric": METRIC, "method": "all"}
        means = _scores(results, "classifier", **where).drop("knn", errors="ignore")
        if means.empty:
            raise NotRun("only one classifier measured", "recorded", runnable=False)
        best = _scores(results, classifier=means.idxmax(), **where)
        return 100 * (_scores(results, classifier="knn", **where) - best).dropna().to_numpy()

    return differences


def blocked_below(results):
    """Random hold-out minus hold-out of neighbouring numbers, kNN, all classes."""
    where = {"group": "all", "classifier": "knn", "method": "all"}
    gap = _scores(results, metric=METRIC, **where) - _scores(results, split=Split.BLOCKS, metric=METRIC, **where)
    return 100 * gap.dropna().to_numpy()


def simulation_helps(touches):
    """differences(results): kNN with simulated imprints besides `touches` real ones a class, minus the latter alone."""

    def differences(results):
        rows = results.rows("simulated_to_real")
        rows = rows[(rows["group"] == "all") & (rows["classifier"] == "knn") & (rows["touches"] == touches)]
        aligned = rows["aligned"].fillna(False).astype(bool)
        both = rows[(rows["training"] == "both") & (rows["simulation"] == SIMULATED) & ~aligned]
        alone = rows[rows["training"] == "real"]
        gain = both.set_index("repetition")["value"] - alone.set_index("repetition")["value"]
        if gain.dropna().empty:
            raise NotRun(f"no {SIMULATED} with {touches} real touches", "recorded", runnable=False)
        return 100 * np.asarray(gain.dropna())

    return differences


AT_RANDOM = shared_by("random")


def _claim(key, section, sentence, tested_on, differences, over="repetitions", shared=AT_RANDOM):
    return Claim(key, section, sentence, tested_on, POINTS, over, differences, shared)


CLAIMS = [
    *(
        _claim(
            f"real_selection_{name}", "T4.2.4", "The selection of dissimilar imprints helps with real touches too.",
            f"real touches, mean of the five classifiers, {text}, selected before the split as in the thesis",
            selection(name),
            **({"over": "sets of classes", "shared": 0.0} if name.endswith("drawn") else {}),
        )
        for name, text in (
            ("four_drawn", "four classes at random"), ("six_drawn", "six classes at random"),
            ("four_alike", "the four most alike"), ("six_alike", "the six most alike"), ("all", "all 22 classes"),
        )
    ),
    _claim(
        "real_selection_training", "T4.2.4", "The selection helps with the test touches left as they are.",
        "real touches, mean of the five classifiers, the six most alike, selected in the training part alone",
        selection("six_alike", "selected_training"),
    ),
    _claim(
        "real_knn_best_six", "T4.2.4", "kNN is the best classifier with real touches.",
        "real touches, six classes at random, kNN minus the best of the others", knn_best("six_drawn"),
        "sets of classes", 0.0,
    ),
    _claim(
        "real_knn_best_all", "T4.2.4", "kNN is the best classifier with real touches.",
        "real touches, all 22 classes, kNN minus the best of the others", knn_best("all"),
    ),
    _claim(
        "real_blocked", "ours", "A random hold-out of real touches flatters.",
        "real touches, all 22 classes, kNN, random quarter minus a run of neighbouring numbers", blocked_below,
    ),
    *(
        _claim(
            f"simulation_helps_{touches}", "ours", "Simulated imprints help to recognise real touches.",
            f"kNN, ten classes, {touches} real of each class, resting imprints with skin added minus without",
            simulation_helps(touches),
        )
        for touches in (1, 5, 20)
    ),
]  # fmt: skip

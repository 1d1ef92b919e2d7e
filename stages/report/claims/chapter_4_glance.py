"""Claims of T4.2 beyond the sampling: regions not touched before, selection, positions, several touches."""

import numpy as np

from stages.report.intervals import REGION_OUT, shared_by
from stages.report.verdict import Claim, paired

from .chapter_4 import ENHANCED, METRIC, sampling, touch_claim

NEAR = 95  # per cent: what "up to 100 % accuracy" is held to
SIDE = "accuracy_side"
BLIND_AND_CLASSICAL = (("itti", "the classical model"), ("random", "blind touch"))


def variants(first, second, classifier="knn", metric=METRIC, objects="six", second_metric=None):
    """differences(results): accuracy of one variant minus of another at enhanced points, a repetition."""

    def differences(results):
        where = {"object": objects, "method": ENHANCED} | ({"classifier": classifier} if classifier else {})
        sides = {
            "first": {"variant": first, "metric": metric},
            "second": {"variant": second, "metric": second_metric or metric},
        }
        return 100 * paired(results, "classification", ["repetition"], **sides, **where).to_numpy()

    return differences


def near_certain(classifier):
    """differences(results): accuracy at five touches minus 95 per cent."""

    def differences(results):
        where = {"object": "six", "method": ENHANCED, "classifier": classifier, "variant": "touches_5"}
        found = results.measured("classification", **where, metric=METRIC)
        return 100 * found.set_index("repetition")["value"].sort_index().to_numpy() - NEAR

    return differences


def shares(rival, variant):
    """differences(results): share of imprints that another object has too, `rival` minus enhanced, an object."""

    def differences(results):
        sides = {"first": {"method": rival}, "second": {"method": ENHANCED}}
        where = {"object": "six", "metric": "similar_share", "variant": variant}
        found = paired(results, "classification", ["of"], **sides, **where)
        return 100 * np.asarray(found.drop("all"))

    return differences


def _dissimilar(rival, label, variant, key, words):
    return Claim(
        f"dissimilar_{rival}{key}", "T4.2.4", f"Enhanced attention gives fewer imprints that others have than {label}.",
        f"{{six}}, {words}, share with a correlation of 0.85 or more, {rival} minus enhanced", "points of the share",
        "objects", shares(rival, variant),
    )  # fmt: skip


def _guided(first, second, sentence, key, where, **how):
    tested_on = f"kNN, {{six}}, {first} minus {second}, {where}"
    first, second = (ENHANCED if name == "enhanced" else name for name in (first, second))
    shared = shared_by("apart" if "metric" in how else "anywhere")
    return touch_claim(key, "T4.2.4", sentence, tested_on, sampling(first, second, **how), shared)


FIFTEEN = "the first 15 imprints of each object, as the thesis had"
REGIONS = "regions that no training touch overlaps"

CLAIMS = [
    _guided(
        "enhanced", "itti", "Touch guided by the enhanced model is better than by the classical one, on new regions.",
        "enhanced_over_itti_apart", REGIONS, metric="accuracy_apart",
    ),
    _guided(
        "itti", "random", "Touch guided by the classical model is better than blind touch, on new regions.",
        "itti_over_blind_apart", REGIONS, metric="accuracy_apart",
    ),
    _guided(
        "enhanced", "itti", "Enhanced beats classical attention with few imprints.",
        "enhanced_over_itti_first_15", FIFTEEN, variant="first_15",
    ),
    _guided(
        "enhanced", "random", "Enhanced attention beats blind touch with few imprints.",
        "enhanced_over_blind_first_15", FIFTEEN, variant="first_15",
    ),
    touch_claim(
        "ours_over_blind_apart", "ours", "Touch guided by our model of gaze beats blind touch, on new regions.",
        f"kNN, {{six}}, ours minus blind touch, {REGIONS}", sampling("enhanced", "random", metric="accuracy_apart"),
        REGION_OUT,
    ),
    touch_claim(
        "ours_over_blind_first_15", "ours", "Our model of gaze beats blind touch with few imprints.",
        f"kNN, {{six}}, ours minus blind touch, {FIFTEEN}", sampling("enhanced", "random", variant="first_15"),
    ),
    *(
        _dissimilar(rival, label, variant, key, words)
        for variant, key, words in (("plain", "", "all imprints"), ("first_15", "_first_15", FIFTEEN))
        for rival, label in BLIND_AND_CLASSICAL
    ),
    touch_claim(
        "selection_helps", "T4.2.4", "Removing imprints that other objects have enhances recognition.",
        "kNN, {six}, enhanced, selected minus all, the test part selected too", variants("selected", "plain"),
    ),
    touch_claim(
        "selection_helps_all", "T4.2.4", "Selection enhances recognition by all classifiers.",
        "mean of all classifiers, {six}, enhanced, selected minus all, the mean of the objects' rates",
        variants("selected", "plain", None, "recall_holdout", second_metric=METRIC),
    ),
    touch_claim(
        "selection_helps_train", "T4.2.4", "Selection enhances recognition where the test part is whole.",
        "kNN, {six}, enhanced, selected in training alone minus all", variants("selected_train", "plain"),
    ),
    touch_claim(
        "locations_help", "T4.2.4", "Adding the position of the touch enhances recognition.",
        "kNN, {six}, enhanced, with minus without positions", variants("locations", "plain"),
    ),
    touch_claim(
        "locations_help_side", "T4.2.4", "Adding the position enhances recognition on a side not touched before.",
        "kNN, {six}, enhanced, with minus without positions, one side of all objects held out",
        variants("locations", "plain", metric=SIDE),
    ),
    touch_claim(
        "locations_help_turned", "ours", "Adding the position still helps when the objects have been turned.",
        "kNN, {six}, enhanced, with minus without positions, tested on objects turned about the vertical",
        variants("locations_turned", "plain"),
    ),
    touch_claim(
        "more_touches", "T4.2.4", "Five touches joined into one sample are better than one.",
        "kNN, {six}, enhanced, five touches minus one", variants("touches_5", "touches_1"),
    ),
    touch_claim(
        "more_touches_all", "T4.2.4", "Five joined touches are better than one over all classifiers.",
        "mean of all classifiers, {six}, enhanced, five touches minus one", variants("touches_5", "touches_1", None),
    ),
    touch_claim(
        "more_touches_bayes", "T4.2.4", "Five joined touches are better than one for naive Bayes.",
        "naive Bayes, {six}, enhanced, five touches minus one", variants("touches_5", "touches_1", "naive_bayes"),
    ),
    touch_claim(
        "more_touches_many", "T4.2.4", "Five joined touches are better than one with many combinations to train on.",
        "kNN, {six}, enhanced, five touches minus one, five times as many combinations",
        variants("touches_5_many", "touches_1_many"),
    ),
    touch_claim(
        "certain_at_five", "T4.2.4", "Recognition is near certain with five touches.",
        f"kNN, {{six}}, enhanced, accuracy at five touches minus {NEAR} per cent", near_certain("knn"),
    ),
    touch_claim(
        "mixed_flatters", "ours", "Combinations drawn before the split flatter.",
        "kNN, {six}, enhanced, five touches, drawn before minus after the split",
        variants("touches_5_mixed", "touches_5"),
    ),
    touch_claim(
        "network_dips", "T4.2.4", "The network does worse with five touches than with three.",
        "deep learning, {six}, enhanced, three touches minus five, equally many samples",
        variants("touches_3", "touches_5", "deep_learning"),
    ),
    touch_claim(
        "network_dips_disjoint", "T4.2.4", "The network does worse with five touches where samples get fewer.",
        "deep learning, {six}, enhanced, three touches minus five, each imprint in one combination",
        variants("touches_3_disjoint", "touches_5_disjoint", "deep_learning"),
    ),
]  # fmt: skip

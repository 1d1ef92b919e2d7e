"""Claims of chapter 4: which points, classifiers and sets of objects make touch recognisable."""

import numpy as np

from stages.report.intervals import HOLD_OUT, REGION_OUT
from stages.report.results import NotRun
from stages.report.verdict import Claim, paired

METRIC = "accuracy_holdout"
POINTS = "points of accuracy"
ENHANCED = "thesis_ssim"  # the thesis's own: the average weighted with its SSIM weights


def sampling(first, second, objects="six", classifier="knn", metric=METRIC, variant="plain"):
    """differences(results): accuracy of touch at points of `first` minus of `second`, a repetition."""

    def differences(results):
        sides = {"first": {"method": first}, "second": {"method": second}}
        where = {"object": objects, "metric": metric, "variant": variant} | (
            {"classifier": classifier} if classifier else {}
        )
        return 100 * paired(results, "classification", ["repetition"], **sides, **where).to_numpy()

    return differences


def best_classifier(results):
    """kNN minus the best of the other classifiers (by mean accuracy), enhanced points, the set six."""
    where = {"object": "six", "method": ENHANCED, "metric": METRIC, "variant": "plain"}
    means = results.measured("classification", **where).groupby("classifier")["value"].mean()
    others = means.drop("knn", errors="ignore")
    if others.empty:
        raise NotRun("only one classifier measured", "classification", runnable=False)
    sides = {"first": {"classifier": "knn"}, "second": {"classifier": others.idxmax()}}
    return 100 * paired(results, "classification", ["repetition"], **sides, **where).to_numpy()


def knn_over_network(results):
    """kNN minus the small network, enhanced points, the set six."""
    sides = {"first": {"classifier": "knn"}, "second": {"classifier": "deep_learning"}}
    where = {"object": "six", "method": ENHANCED, "metric": METRIC, "variant": "plain"}
    return 100 * paired(results, "classification", ["repetition"], **sides, **where).to_numpy()


def fewer_objects(beyond_chance):
    """differences(results): set four minus set six, kNN and enhanced; beyond_chance scales guessing to 0, all to 1."""

    def differences(results):
        scores = {}
        for name in ("six", "four"):
            where = {"object": name, "method": ENHANCED, "classifier": "knn", "metric": METRIC, "variant": "plain"}
            scores[name] = results.measured("classification", **where).groupby("repetition")["value"].mean()
            if beyond_chance:
                classes = results.classes(name)
                scores[name] = (scores[name] - 1 / classes) / (1 - 1 / classes)
        return 100 * np.asarray((scores["four"] - scores["six"]).dropna())

    return differences


def touch_claim(key, section, sentence, tested_on, differences, shared=HOLD_OUT):
    """A claim on hold-out accuracy; its pairs are repeated splits of the same imprints. {six}: see Claim."""
    return Claim(key, section, sentence, tested_on, POINTS, "repetitions", differences, shared)


CLAIMS = [
    touch_claim(
        "enhanced_over_itti", "T4.2.4", "Touch guided by the enhanced model is better than by the classical one.",
        "kNN, {six}, enhanced minus itti", sampling(ENHANCED, "itti"),
    ),
    touch_claim(
        "itti_over_blind", "T4.2.4", "Touch guided by the classical model is better than blind touch.",
        "kNN, {six}, itti minus blind touch", sampling("itti", "random"),
    ),
    touch_claim(
        "enhanced_over_blind", "T4.2.4", "Touch guided by the enhanced model is better than blind touch.",
        "kNN, {six}, enhanced minus blind touch", sampling(ENHANCED, "random"),
    ),
    touch_claim(
        "enhanced_over_blind_four", "T4.2.4", "Enhanced beats blind touch with four objects too.",
        "kNN, {four}, enhanced minus blind touch", sampling(ENHANCED, "random", objects="four"),
    ),
    touch_claim(
        "enhanced_over_blind_all", "T4.2.4", "Enhanced beats blind touch over all classifiers.",
        "mean of all classifiers, {six}, enhanced minus blind touch",
        sampling(ENHANCED, "random", classifier=None),
    ),
    touch_claim(
        "enhanced_over_blind_apart", "T4.2.4", "Enhanced beats blind touch where no training touch overlaps.",
        "kNN, {six}, enhanced minus blind touch, test touches a sensor's width from all training touches",
        sampling(ENHANCED, "random", metric="accuracy_apart"), REGION_OUT,
    ),
    *(
        touch_claim(
            f"enhanced_over_{rival}", "T4.2.4", f"Touch guided by the enhanced model is better than by {label}.",
            f"kNN, {{six}}, enhanced minus {rival}", sampling(ENHANCED, rival),
        )
        for rival, label in (
            ("heat_kernel", "heat kernel signatures"), ("salient_points", "salient points"),
            ("mesh_saliency", "mesh saliency"),
        )
    ),
    touch_claim(
        "ours_over_blind", "ours", "Touch guided by our model of gaze is better than blind touch.",
        "kNN, {six}, ours minus blind touch", sampling("enhanced", "random"),
    ),
    touch_claim(
        "ours_over_enhanced", "ours", "Touch guided by our model of gaze is better than by the enhanced model.",
        "kNN, {six}, ours minus enhanced", sampling("enhanced", ENHANCED),
    ),
    touch_claim(
        "knn_best", "T4.2.4", "kNN is the best classifier.",
        "{six}, enhanced, kNN minus the best of the others", best_classifier,
    ),
    touch_claim(
        "network_poor", "T4.2.4", "The small network does worse than kNN, having few imprints to learn from.",
        "{six}, enhanced, kNN minus deep learning", knn_over_network,
    ),
    touch_claim(
        "four_easier", "T4.2.4", "Four objects are easier than six.",
        "kNN, enhanced, {four} minus {six}", fewer_objects(beyond_chance=False),
    ),
    touch_claim(
        "four_easier_beyond_chance", "T4.2.4",
        "Similar objects degrade the performance: four are easier even beyond chance.",
        "kNN, enhanced, {four} minus {six}, guessing scaled to 0 and certainty to 100",
        fewer_objects(beyond_chance=True),
    ),
]  # fmt: skip

"""Claims of chapter 3: where people look, and what keeping those places does to a simplified mesh."""

from contextlib import suppress

import pandas as pd

from stages.report.judged import CLASSICAL, OURS, best_rival, difference
from stages.report.results import NotRun
from stages.report.style import label
from stages.report.verdict import Claim, paired

ENHANCED = "thesis_ssim"  # the thesis's own: the average weighted with its SSIM weights
# T2.2.3's detectors but the heat kernel signature, which T3.1.5 takes out of the claim ("except HKS approach").
RIVALS = ["salient_points", "mesh_saliency", "sift", "harris", "corners"]
COMBINATIONS = ["itti", "VisAttCurv", "VisAttSym", "VisAttCurvSym", "VisAttCurvSymCon", "VisAttEnt", "VisAttAll"]
CELL = ["object", "target"]
PERCENT = "% of the error"
POINTS = "points of accuracy"


def higher_error(worse, better, metric):
    """differences(results): how much larger the error of `worse` is, in per cent of the two errors' mean, an object.

    Targets weigh the same whatever the size of their errors; two errors of zero are equal.
    """

    def differences(results):
        sides = {"first": {"method": worse}, "second": {"method": better}}
        gap = paired(results, "lod", CELL, **sides, metric=metric)
        errors = results.measurements("lod", metric=metric, method=[worse, better])
        size = errors.groupby(CELL)["value"].mean().reindex(gap.index)
        return (100 * gap / size.where(size > 0, 1.0)).groupby("object").mean()

    return differences


def rivals_higher_error(rivals, better, metric):
    """As higher_error, averaged over those of the rivals that were run, over the objects that all of them reach."""

    def differences(results):
        found = []
        for rival in rivals:
            with suppress(NotRun):
                found.append(higher_error(rival, better, metric)(results))
        if not found:
            raise NotRun(f"no lod rows of {better} beside one of {', '.join(rivals)}", "lod", runnable=False)
        return pd.concat(found, axis=1, join="inner").mean(axis=1)

    return differences


def coarse_minus_fine(results):
    """Error at the fewest faces minus error at the most, of the enhanced model, in per cent of the diagonal."""
    rows = results.measurements("lod", metric="metro_mean", method=ENHANCED).sort_values("faces")
    per_object = rows.dropna(subset="value").groupby("object")["value"]
    return 100 * (per_object.first() - per_object.last())


def closer_to_gaze(first, second):
    """differences(results): how much higher the NSS of `first` is than that of `second`, a mesh with human gaze."""

    def differences(results):
        return difference(results.attention("gaze"), "nss", first, second)

    return differences


def ours_over_best_rival(results):
    """As closer_to_gaze, of our model over the best of all others by mean NSS that have not seen the mesh."""
    rows = results.attention("gaze")
    return difference(rows, "nss", OURS, best_rival(rows))


def svm_per_object(area, own, others):
    """differences(results): accuracy of an object's own SVM minus that of the one for all, in points, an object.

    own, others: how each of the two was validated.
    """

    def differences(results):
        rows = results.attention("svm")
        rows = rows[(rows["metric"] == "accuracy") & (rows["area"] == area)]
        ways = (("one_per_object", own), ("one_for_all", others))
        sides = [rows[(rows["training"] == training) & (rows["validation"] == way)] for training, way in ways]
        if min(map(len, sides)) == 0:
            raise NotRun("no accuracies of both kinds of SVM", "weights", runnable=False)
        return 100 * (sides[0].set_index("object")["value"] - sides[1]["value"].mean())

    return differences


def gaze_claim(key, section, sentence, tested, differences, unit="NSS"):
    """A claim on the meshes with human gaze."""
    return Claim(key, section, sentence, f"meshes with human gaze, {tested}", unit, "objects", differences)


def lod_claim(key, section, sentence, worse, better, metric):
    """A claim that the method `better` has the lower error of the two."""
    what = {"metro_mean": "Metro mean error", "ssim_error": "SSIM error"}[metric]
    tested = f"{what}, {label(worse)} minus {label(better)}, mean over the face counts"
    return Claim(key, section, sentence, tested, PERCENT, "objects", higher_error(worse, better, metric))


CLAIMS = [
    gaze_claim(
        "equal_over_itti_gaze", "T3.2.2", "All channels with equal weights (VisAttAll) beat the classical model.",
        "NSS, VisAttAll minus visual attention", closer_to_gaze("VisAttAll", CLASSICAL),
    ),
    gaze_claim(
        "guided_ed_gaze", "T3.2.2", "Weights learned by Euclidean distance predict attention better than equal ones.",
        "NSS, guided by ED minus equal weights", closer_to_gaze("guided_ed", "equal"),
    ),
    gaze_claim(
        "guided_ssim_gaze", "T3.2.2", "Weights learned by similarity predict attention better than equal ones.",
        "NSS, guided by SSIM minus equal weights", closer_to_gaze("guided_ssim", "equal"),
    ),
    gaze_claim(
        "svm_gaze", "T3.2.3", "An SVM on the channels predicts attention better than equal weights.",
        "NSS, SVM of the other objects minus equal weights", closer_to_gaze("svm", "equal"),
    ),
    gaze_claim(
        "svm_per_object", "T3.2.3", "One SVM for each object is more accurate than one for all.",
        "accuracy on random pixels of the whole image, the thesis's way",
        svm_per_object("image", "pixels", "pixels"), POINTS,
    ),
    gaze_claim(
        "svm_per_object_unseen", "T3.2.3", "One SVM for each object is more accurate on what it has not seen, too.",
        "accuracy on the object's pixels, own SVM on whole views left out, one for all on whole objects left out",
        svm_per_object("object", "views", "objects"), POINTS,
    ),
    gaze_claim(
        "ours_over_best_gaze", "ours", "Our model of gaze predicts where people look better than its best rival.",
        "NSS, ours minus the best other method that has not seen the mesh", ours_over_best_rival,
    ),
    gaze_claim(
        "ours_over_enhanced_gaze", "ours", "Our model predicts where people look better than the enhanced model.",
        "NSS, ours minus enhanced attention (SSIM)", closer_to_gaze(OURS, ENHANCED),
    ),
    lod_claim(
        "keep_metro", "T3.1", "Keeping what draws the eye gives a better simplified model than plain QEM (distance).",
        "qem", ENHANCED, "metro_mean",
    ),
    lod_claim(
        "keep_ssim", "T3.1", "Keeping what draws the eye gives a better simplified model than plain QEM (as seen).",
        "qem", ENHANCED, "ssim_error",
    ),
    lod_claim(
        "blind_metro", "T3.1.5", "Attention places the kept points better than chance does (distance).",
        "random", ENHANCED, "metro_mean",
    ),
    lod_claim(
        "blind_ssim", "T3.1.5", "Attention places the kept points better than chance does (as seen).",
        "random", ENHANCED, "ssim_error",
    ),
    lod_claim(
        "ours_keep_metro", "ours", "Keeping what our model finds gives a better mesh than plain QEM (distance).",
        "qem", OURS, "metro_mean",
    ),
    lod_claim(
        "ours_keep_ssim", "ours", "Keeping what our model finds gives a better mesh than plain QEM (as seen).",
        "qem", OURS, "ssim_error",
    ),
    lod_claim(
        "ours_blind_ssim", "ours", "Our model of gaze places the kept points better than chance does (as seen).",
        "random", OURS, "ssim_error",
    ),
    Claim(
        "rivals_metro", "T3.2.9.1", "Attention distorts less than the detectors of the literature do.",
        "Metro mean error, mean of the literature's detectors minus enhanced attention (SSIM)", PERCENT, "objects",
        rivals_higher_error(RIVALS, ENHANCED, "metro_mean"),
    ),
    Claim(
        "more_faces", "T3.1.5", "The error falls with more faces.",
        "Metro mean error at the fewest faces minus at the most, enhanced attention (SSIM)", "% of the diagonal",
        "objects",
        coarse_minus_fine,
    ),
    Claim(
        "contrast", "T3.1.5", "Adding contrast (VisAttCon) gives the best quality of the combinations of channels.",
        "Metro mean error, mean of the other combinations minus VisAttCon", PERCENT, "objects",
        rivals_higher_error(COMBINATIONS, "VisAttCon", "metro_mean"),
    ),
    lod_claim(
        "curvature_ssim", "T3.1.5", "Curvature in the map is slightly better as seen (VisAttCurv).",
        "itti", "VisAttCurv", "ssim_error",
    ),
    lod_claim(
        "entropy", "T3.1.5", "Entropy makes the error higher on objects without texture (VisAttEnt).",
        "VisAttEnt", "itti", "metro_mean",
    ),
    lod_claim(
        "all_channels", "T3.1.5", "All channels with equal weights are slightly worse (VisAttAll).",
        "VisAttAll", "itti", "metro_mean",
    ),
    lod_claim(
        "learned_weights", "T3.2.9.2", "Weights learned from ground truth beat equal weights.",
        "VisAttAll", ENHANCED, "ssim_error",
    ),
]  # fmt: skip

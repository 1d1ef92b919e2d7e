"""Claims of chapter 3 on where people look: weights, SVMs and models against human gaze."""

from stages.report.judged import CLASSICAL, OURS, best_rival, difference
from stages.report.results import NotRun
from stages.report.verdict import Claim

ENHANCED = "thesis_ssim"  # the thesis's own: the average weighted with its SSIM weights
POINTS = "points of accuracy"


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
]  # fmt: skip

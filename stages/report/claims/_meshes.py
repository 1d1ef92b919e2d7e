"""What the claims on simplified meshes share: groups of methods, and how a claim is written."""

from dataclasses import replace

from stages.report.lod_cells import by_gaze
from stages.report.style import label
from stages.report.tables.table_3_1_5_combinations import COMBINATIONS
from stages.report.verdict import Claim

from ._errors import higher

ENHANCED = "thesis_ssim"  # the thesis's own: the average weighted with its SSIM weights
CLASSICAL = "itti"
HKS = "heat_kernel"
# T2.2.3's detectors but the heat kernel signature, which T3.1.5 takes out of the claim ("except HKS approach").
RIVALS = ["salient_points", "mesh_saliency", "sift", "harris", "corners"]
MANY_POINTS = ["corners", "harris"]  # T3.1.5: SDC, 3DH
SYMMETRIES = ["SymLat", "SymRad", "2Sym"]
LEADING = ["VisAttCurvSymCon", "VisAttCon"]
REST = [name for name in COMBINATIONS if name not in LEADING]
PROPOSED = ["guided_ed", "guided_ssim", "svm"]  # T3.2.9: ED, SSIM, SVM
ADAPTIVE = [f"{name}-adaptive" for name in PROPOSED]
ERROR_NAMES = {
    "metro_mean": "Metro mean error", "metro_max": "Metro max", "ssim_error": "SSIM error", "dlap": "DLap",
    "dnor": "Dnor", "salient_error": "error weighted by our own model of looks",
    "gaze_error": "error weighted by human gaze",
}  # fmt: skip
GROUPS = {  # in words
    tuple(RIVALS): "mean of the literature's detectors but HKS",
    tuple(COMBINATIONS): "mean of the combinations",
    tuple(REST): "mean of the other combinations",
}
PERCENT, DIAGONAL, RANKS = "% of the error", "% of the diagonal", "rank correlation"
ALL_COUNTS = "mean over the face counts"


def claim(key, section, sentence, tested, differences, unit=PERCENT):
    """A claim whose pairs are objects."""
    return Claim(key, section, sentence, tested, unit, "objects", differences)


def lod_claim(key, section, sentence, worse, better, metric, targets=None):
    """A claim that `better` has the lower error of the two; each a method or a list of methods."""
    where = f"at {' and '.join(f'{int(target):,}' for target in targets)} faces" if targets else ALL_COUNTS
    tested = f"{ERROR_NAMES[metric]}, {_named(worse)} minus {_named(better)}, {where}"
    return claim(key, section, sentence, tested, higher(worse, better, metric, targets))


def gaze_claim(key, section, sentence, worse, better):
    """As lod_claim, of the error weighted by human gaze: on the meshes that have it, whichever this run's are."""
    asked = lod_claim(key, section, sentence, worse, better, "gaze_error")

    def differences(results, source=None):
        return asked.differences(results, source or by_gaze(results))

    return replace(asked, tested_on=f"meshes with human gaze, {asked.tested_on}", differences=differences)


def _named(side):
    if isinstance(side, str):
        return label(side)
    return GROUPS.get(tuple(side)) or "mean of " + ", ".join(map(label, side))

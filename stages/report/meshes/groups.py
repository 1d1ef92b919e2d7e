"""What the claims on simplified meshes share: groups of methods, and how a claim is written."""

from functools import partial

from stages.report.claims import Claim, Pick

from .rows import STAGE
from .table_3_1_5_combinations import COMBINATIONS as LISTED

COMBINATIONS = tuple(LISTED)
ENHANCED = "thesis_ssim"  # the thesis's own: the average weighted with its SSIM weights
CLASSICAL = "itti"
HKS = "heat_kernel"
# T2.2.3's detectors but the heat kernel signature, which T3.1.5 takes out of the claim ("except HKS approach").
RIVALS = ("salient_points", "mesh_saliency", "sift", "harris", "corners")
MANY_POINTS = ("corners", "harris")  # T3.1.5: SDC, 3DH
SYMMETRIES = ("SymLat", "SymRad", "2Sym")
LEADING = ("VisAttCurvSymCon", "VisAttCon")
REST = tuple(name for name in COMBINATIONS if name not in LEADING)
PROPOSED = ("guided_ed", "guided_ssim", "svm")  # T3.2.9: ED, SSIM, SVM
ADAPTIVE = tuple(f"{name}-adaptive" for name in PROPOSED)
LOW, HIGH = "1500", "3000"  # the thesis's two face counts
BOTH = {"target": (LOW, HIGH)}
FEW_MINUS_MANY = ({"target": LOW}, {"target": HIGH})
PERCENT, DIAGONAL, RANKS = "% of the error", "% of the diagonal", "rank correlation"
ALL_COUNTS = "mean over the face counts"
PHRASES = {
    ("metric", "metro_mean"): "Metro mean error", ("metric", "metro_max"): "Metro max",
    ("metric", "ssim_error"): "SSIM error", ("metric", "dlap"): "DLap", ("metric", "dnor"): "Dnor",
    ("metric", "salient_error"): "error weighted by our own model of gaze",
    ("metric", "gaze_error"): "error weighted by human gaze",
    ("metric", ("ssim_error", "dlap", "dnor")): "SSIM error, DLap and Dnor",
    ("method", RIVALS): "mean of the literature's detectors but HKS",
    ("method", COMBINATIONS): "mean of the combinations",
    ("method", REST): "mean of the other combinations",
    ("target", LOW): "1,500 faces", ("target", HIGH): "3,000 faces", ("target", (LOW, HIGH)): "1,500 and 3,000 faces",
}  # fmt: skip
claim = partial(Claim, stage=STAGE, over=("item",), scale=1.0, phrases=PHRASES)
Methods = str | tuple[str, ...] | Pick


def lod_claim(
    key: str, section: str, sentence: str, worse: Methods, better: Methods, metric: str, target: str | None = None,
    dataset: str | None = None,
) -> Claim:  # fmt: skip
    """A claim that `better` has the lower error, in % of the mean of the two: small and large errors weigh the same."""
    where = {"metric": metric} | ({"target": target} if target else {})
    return claim(
        key=key, section=section, sentence=sentence, where=where, first={"method": worse}, second={"method": better},
        dataset=dataset, within=("target",), relative=True, scale=100.0, unit=PERCENT,
        note="" if target else ALL_COUNTS,
    )  # fmt: skip

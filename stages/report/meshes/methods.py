"""Whose points the simplified meshes keep: the methods' groups, short names and order."""

from collections.abc import Iterable

from haptic_glance.look.weights.weights import GLANCE
from stages.report.style import WAYS, label

PLAIN, QSLIM, OURS = "qem", "qslim", GLANCE  # QSLIM: plain QEM without the fit of ours, the thesis's
CLASSICAL = "itti"  # the classical model, VisAtt in the thesis
WEIGHTED = "thesis_ssim"  # the thesis's own: the average weighted with its SSIM weights
HKS = "heat_kernel"
COMBINATIONS = (  # of channels, as the stages call them, in the order of T3.1.5
    CLASSICAL, "VisAttCurvP", "VisAttCurv", "Curv", "VisAttSymP", "VisAttSym", "SymLat", "SymRad", "2Sym",
    "VisAttCurvSym", "VisAttCon", "VisAttCurvSymCon", "VisAttEnt", "VisAttAll",
)  # fmt: skip
BY_AREA = (CLASSICAL, "VisAttCon", "VisAttCurvSymCon", "VisAttAll")  # whose neighbourhoods go by area, too (T3.1.3)
SYMMETRIES = ("SymLat", "SymRad", "2Sym")
# T2.2.3's detectors but the heat kernel signature, which T3.1.5 takes out of the claim ("except HKS approach").
RIVALS = ("salient_points", "mesh_saliency", "sift", "harris", "corners")
PROPOSED = ("guided_ed", "guided_ssim", "svm")  # T3.2.9: ED, SSIM, SVM, learned from other objects than the simplified
PRINTED = ("guided_ed_seen", "guided_ssim_seen", "svm_object")  # the same, learned from that object too, as printed
ADAPTIVE = tuple(f"{name}-adaptive" for name in PROPOSED)
PRINTED_ADAPTIVE = tuple(f"{name}-adaptive" for name in PRINTED)
UNSEEN = dict(zip(PRINTED + PRINTED_ADAPTIVE, PROPOSED + ADAPTIVE, strict=True))
OF_T3_2 = (*PROPOSED, OURS)  # by which the sets of T3.2 are known
FIXED_ADAPTIVE = tuple(name for pair in zip(PROPOSED, ADAPTIVE, strict=True) for name in pair)
NAMES = {  # short, the thesis's, in the order of its figure 3.6; then those of later sections, ours and chance
    "harris": "3DH", "mesh_saliency": "MS", "salient_points": "SP", "corners": "SDC", "sift": "3DS",
    "VisAttCurvP": "VisAttCurvP", "VisAttAll": "VisAttAll", "VisAttSymP": "VisAttSymP", "VisAttEnt": "VisAttEnt",
    "Curv": "Curv", "VisAttCurv": "VisAttCurv", "VisAttCurvSym": "VisAttCurvSym", "VisAttSym": "VisAttSym",
    "VisAttCurvSymCon": "VisAttCurvSymCon", CLASSICAL: "VisAtt", "VisAttCon": "VisAttCon", "2Sym": "2Sym",
    "SymLat": "SymLat", HKS: "HKS", "SymRad": "SymRad", "guided_ed": "ED", "guided_ssim": "SSIM",
    WEIGHTED: label(WEIGHTED), "thesis_ed": label("thesis_ed"), "svm": "SVM", OURS: label(OURS), "random": "blind",
}  # fmt: skip


def fixed(method: str) -> bool:
    """Whether a method keeps neighbourhoods of fixed size: no way of keeping them stands behind its name."""
    return method.rpartition("-")[2] not in WAYS


def short(method: str) -> str:
    """The thesis's short name of a method."""
    base, _, way = method.rpartition("-")
    return NAMES.get(method, label(method)) if fixed(method) else f"{short(base)}, {way}"


def ordered(methods: Iterable[str]) -> list[str]:
    """The methods in the thesis's order (figure 3.6), then those with a way behind their name, QEM last."""
    order = [*NAMES, *(f"{name}-{way}" for name in NAMES for way in WAYS)]
    plain = [PLAIN, QSLIM]
    return sorted(methods, key=lambda name: (name in plain, order.index(name) if name in order else len(order), name))

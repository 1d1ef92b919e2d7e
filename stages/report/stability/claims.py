"""Claims on a denoising autoencoder before recognition by touch (T6.3), and on the stability of attention."""

from haptic_glance.know.split import Split
from stages.report.claims import Claim, reading
from stages.stability.uses import PLAIN as NOTHING_KEPT

from .score import BENCHMARK, KINDS
from .score import STAGE as ATTENTION
from .touch import DENOISED, PLAIN, STAGE

LEARNED, FILTERED = f"{PLAIN}_autoencoder", f"{PLAIN}_median"
PHRASES = {
    ("features", PLAIN): "touches as they are", ("features", LEARNED): "after the autoencoder",
    ("features", FILTERED): "after the median filter", ("perturbation", "noise"): "noise",
    ("perturbation", "dead_cells"): "dead cells", ("perturbation", "blur"): "blur",
    ("perturbation", "none"): "undisturbed touches",
}  # fmt: skip
SENTENCES = {  # (perturbation, first, second): what is claimed
    **{
        (fault, LEARNED, PLAIN): f"A denoising autoencoder makes recognition by touch more accurate under {words}."
        for fault, words in (("noise", "noise"), ("dead_cells", "dead cells"), ("blur", "blur"))
    },
    **{
        (fault, LEARNED, FILTERED): f"Under {words} a denoising autoencoder is better than a median filter."
        for fault, words in (("noise", "noise"), ("dead_cells", "dead cells"), ("blur", "blur"))
    },
    ("none", LEARNED, PLAIN): "On touches without noise a denoising autoencoder does no harm.",
}
SCORED = tuple(name for names in KINDS.values() for name in names)
MOVES = "noise", "decimation", "remeshing", "missing_faces", "scan", "tilt"  # what moves the points of a glance
SURFACE = reading("the surface alone disturbed", where={"perturbation": MOVES})  # a geometric method sees no light
SHARE = "% of the points"
WORDS = {
    ("metric", "repeatability"): "points found again", ("metric", "recognised"): "recognition by touch",
    ("metric", "lod_salient"): "error weighted by saliency", ("perturbation", SCORED): "all disturbances",
    ("perturbation", MOVES): "noise, other triangles, holes, scans and tilts", ("perturbation", "none"): "undisturbed",
    ("perturbation", NOTHING_KEPT): "plain simplification",
}  # fmt: skip


def _more_stable(key: str, sentence: str, first: str, second: str, perturbation: str | tuple[str, ...]) -> Claim:
    """A claim that one method finds more of its points again than another."""
    return Claim(
        key=key, section="ours", sentence=sentence, stage=ATTENTION, dataset=BENCHMARK, over=("item",),
        first={"method": first}, second={"method": second}, within=("perturbation", "severity"),
        where={"perturbation": perturbation, "metric": "repeatability"}, unit=SHARE, phrases=WORDS,
        readings=() if perturbation == "tilt" else (SURFACE,),
    )  # fmt: skip


STABILITY = [
    _more_stable(
        "glance_stable_itti", "The gaze model finds more of its points again than Itti's attention.",
        "glance", "itti", SCORED,
    ),
    _more_stable(
        "glance_stable_mesh_saliency", "The gaze model finds more of its points again than mesh saliency.",
        "glance", "mesh_saliency", SCORED,
    ),
    _more_stable(
        "any_pose_stable_tilt", "Learned from any pose, the gaze model finds more of its points again when tilted.",
        "glance_any_pose", "glance", "tilt",
    ),
    Claim(
        key="disturbed_touch", section="ours", stage=ATTENTION, dataset=BENCHMARK, over=("item",), phrases=WORDS,
        sentence="Places that a disturbance has moved are recognised by touch less often than the learned places.",
        first={"perturbation": "none"}, second={"perturbation": MOVES},
        where={"method": "glance", "metric": "recognised"},
    ),
    Claim(
        key="disturbed_lod", section="ours", stage=ATTENTION, dataset=BENCHMARK, over=("item",), phrases=WORDS,
        sentence="Points of a disturbed object still spare what the gaze model finds salient.", relative=True,
        first={"perturbation": NOTHING_KEPT}, second={"perturbation": MOVES},
        where={"method": "glance", "metric": "lod_salient"}, unit="% of the mean of both errors",
    ),
]  # fmt: skip

CLAIMS = [
    Claim(
        key=f"{first.removeprefix(f'{PLAIN}_')}_over_{'none' if second == PLAIN else 'median'}_{fault}",
        section="T6.3" if second == PLAIN else "ours", sentence=sentence, stage=STAGE, dataset=DENOISED,
        first={"features": first}, second={"features": second},
        where={"perturbation": fault, "split": Split.RANDOM, "classifier": "knn", "metric": "accuracy"},
        within=("severity",), phrases=PHRASES,
    )
    for (fault, first, second), sentence in SENTENCES.items()
] + STABILITY  # fmt: skip

"""The registry of methods, and the contract that each of them keeps. CONTRIBUTING.md says how to add one.

A method has `channels`, the maps that it uses (none: it gets no view maps); `required_weights`, the name of the weights
without which it cannot run, or None; and `find(mesh, view_maps, options, count=None) -> Detection`. All but those that
place points (random, farthest) have `saliency(mesh, view_maps, options) -> (n,)` too.

The mesh is normalised and z up. tests/look/test_detector_contract.py runs every entry:

- Points are distinct vertices that lie in a face. With a count there are as many as asked for, where the mesh has them.
- Saliency has one finite value per vertex, 0 to 1, with 1 at the maximum. No shape at all has no saliency.
- The same mesh gives the same answer. The order of vertices and faces changes nothing (but the draws of `random`).
- A method without channels does not change with a turn about the vertical. A published one does not change with unit,
  place and winding either.
- Flat, tiny, doubled, torn and empty meshes give finite values. Only a method that looks or draws may refuse them, by a
  ValueError with the reason.
"""

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import replace
from difflib import get_close_matches

from haptic_glance.base.gone import went
from haptic_glance.base.timing import Stopwatch
from haptic_glance.mesh.mesh import Mesh

from ..channels import CHANNELS, ViewMaps
from ..rivals import corners, harris, heat_kernel, leifman, mesh_saliency, salient_points, sift, song, tasse
from ..weights import LearnedWeights
from ..weights.weights import DEEP, GLANCE, GLANCES
from .detectors import (
    SURFACE,
    FarthestPoints,
    FusedDetector,
    MergedDetector,
    RandomPoints,
    SummedDetector,
    SurfaceDetector,
    SvmDetector,
    WeightedDetector,
)
from .fuse import CLASSICAL, COMBINATIONS, WITHOUT_COLOUR
from .glance import GlanceDetector, deep_features
from .options import Detection, Detector, Options
from .recurring_imprints import TouchDetector

PLUS = "+"  # between the name of a method and its option
SUMS = "sums"  # the option: with the sums of T eq. 3.1 to 3.6, in place of means
SYMMETRIES = {"SymLat": "symmetry_lateral", "SymRad": "symmetry_radial", "2Sym": "symmetry"}  # T3.1.5
WEIGHTED = ("equal", "thesis_ssim", "thesis_ed", "guided_ssim", "guided_ed")
PUBLISHED = {
    "mesh_saliency": mesh_saliency, "salient_points": salient_points, "sift": sift, "harris": harris,
    "corners": corners, "heat_kernel": heat_kernel, "leifman": leifman, "song": song, "tasse": tasse,
}  # fmt: skip
MAPS = COMBINATIONS | WITHOUT_COLOUR

METHODS: dict[str, Detector] = {
    **{name: GlanceDetector(name) for name in GLANCES},
    **{name: GlanceDetector(name, deep_features) for name in DEEP},
    "itti": FusedDetector(COMBINATIONS["VisAtt"]),
    "random": RandomPoints(),
    **{name: FusedDetector(channels) for name, channels in MAPS.items()},
    "VisAttCurvP": MergedDetector(FusedDetector(CLASSICAL), FusedDetector(COMBINATIONS["Curv"])),
    "VisAttSymP": MergedDetector(FusedDetector(CLASSICAL), FusedDetector(["symmetry"])),
    **{name: FusedDetector([channel]) for name, channel in SYMMETRIES.items()},
    **{name: WeightedDetector(name, CHANNELS) for name in WEIGHTED},
    "svm": SvmDetector("svm", CHANNELS),
    **{name: SurfaceDetector(paper.saliency, paper.points) for name, paper in PUBLISHED.items()},
    "spectral_residual": FusedDetector(["spectral_residual"]),
    "fine_grained": FusedDetector(["fine_grained"]),
    "farthest": FarthestPoints(),
    "touch": TouchDetector(),
    **{name: SurfaceDetector(values) for name, values in SURFACE.items()},
}

# Options of methods, by name: another draw of random points; sums of maps (a single channel has the same points); and
# what weights were learned from: the object's own pixels, all objects with the judged one, the nearest, or each view.
OPTIONS: dict[str, dict[str, Detector]] = {
    "random": {str(draw): RandomPoints(draw) for draw in range(2, 6)},
    **{name: {SUMS: SummedDetector(channels)} for name, channels in MAPS.items() if name != "Curv"},
    "VisAttCurvP": {SUMS: MergedDetector(SummedDetector(CLASSICAL), FusedDetector(COMBINATIONS["Curv"]))},
    "VisAttSymP": {SUMS: MergedDetector(SummedDetector(CLASSICAL), FusedDetector(["symmetry"]))},
    **{
        name: {option: WeightedDetector(f"{name}{PLUS}{option}", CHANNELS) for option in options}
        for name, options in (("guided_ssim", ("object", "seen")), ("guided_ed", ("seen",)))
    },
    "svm": {
        option: SvmDetector(f"svm{PLUS}{option}", CHANNELS) for option in ("nearest", "seen", "object", "viewpoint")
    },  # T3.2.3
}

PURPOSES = {"look": GLANCE, "touch": "touch"}  # what places are for: the method that finds them

MAIN = ("glance", "glance_any_pose", "thesis_ssim", "itti", "mesh_saliency")  # named where none is near
MEANT = {  # in other words, and in the thesis's
    "ours": "glance", "gaze": "glance", "default": "glance", "any_pose": "glance_any_pose", "deep": "glance_deep",
    "thesis": "thesis_ssim", "enhanced_attention": "thesis_ssim", "enhanced_visual_attention": "thesis_ssim",
    "ssim": "thesis_ssim", "ed": "thesis_ed", "visual_attention": "itti", "attention": "itti", "classical": "itti",
    "enhanced": "thesis_ssim", "lee": "mesh_saliency", "hks": "heat_kernel",
}  # fmt: skip


def method_named(method: str) -> Detector:
    """The entry of METHODS, or of OPTIONS for a name with an option, such as `VisAttAll+sums` or `random+2`.

    Raises ValueError with the nearest name for an unknown one.
    """
    name, plus, option = str(method).partition(PLUS)
    if name not in METHODS:
        hint = meant(name.lower(), list(METHODS))
        raise ValueError(f"unknown method {method!r}{hint or ': choose one of ' + ', '.join(MAIN)}")
    options = OPTIONS.get(name, {})
    if plus and option not in options:
        raise ValueError(f"{name} has no option {option!r}: it has {', '.join(options) or 'none'}")
    return options[option] if plus else METHODS[name]


def is_method(method: str) -> bool:
    """Whether `method_named` knows a name."""
    name, plus, option = method.partition(PLUS)
    return name in METHODS and (not plus or option in OPTIONS.get(name, {}))


def method_for(purpose: str, method: str | None = None) -> str:
    """The name of the method, None for the one of the purpose; ValueError for an unknown purpose, or for both."""
    if purpose not in PURPOSES:
        raise ValueError(f"unknown purpose {purpose!r}: choose one of {', '.join(PURPOSES)}")
    if method is not None and purpose != "look":
        raise ValueError(f"the purpose {purpose!r} chooses the method: leave out method {method!r}")
    return PURPOSES[purpose] if method is None else method


def meant(spelling: str, usable: Sequence[str]) -> str:
    """ " (did you mean NAME?)" for a name in other words or mistyped, what to use for one that went; else empty."""
    if hint := went(spelling):
        return f": {hint}"
    lower = {name.lower(): name for name in usable}
    close = get_close_matches(spelling, [*MEANT, *lower], 1)
    match = MEANT.get(close[0], lower.get(close[0])) if close else None
    return f" (did you mean {match}?)" if match in usable else ""


def split_runnable(methods: Iterable[str], learned: LearnedWeights) -> tuple[list[str], list[str]]:
    """(methods whose weights are at hand, the others): without ground truth, `learned` lacks some weights.

    Raises ValueError for an unknown name.
    """
    methods, available = list(methods), {None, *learned.weights, *learned.svms}
    runnable = [method for method in methods if method_named(method).required_weights in available]
    return runnable, [method for method in methods if method not in runnable]


def find_all(
    mesh: Mesh, view_maps: ViewMaps | None, methods: Iterable[str], options: Options, count: int | None,
    earlier: Mapping[str, Detection] | None = None,
) -> tuple[dict[str, Detection], dict[str, float]]:  # fmt: skip
    """Runs methods on one object: (dict method -> Detection, dict method -> seconds).

    earlier: the Detections of methods that have run on it before.

    A method without a threshold of its own (random, farthest) gets as many strong points as the first one that has one,
    so that what the LOD keeps for either differs in place alone.
    """
    detections, seconds = {}, {}
    for method in methods:
        with Stopwatch() as watch:
            detections[method] = (earlier or {}).get(method) or method_named(method).find(
                mesh, view_maps, options, count
            )
        seconds[method] = watch.seconds
    strong = next((result.strong for result in detections.values() if result.strong is not None), count)
    for method, result in detections.items():
        if result.strong is None:
            detections[method] = replace(
                result, strong=len(result.points) if strong is None else min(strong, len(result.points))
            )
    return detections, seconds

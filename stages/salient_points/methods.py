"""The registry of methods. To add one, add an entry.

A method has `channels`, the maps that it looks at (none: it is given no Sight); `learned`, the name of the weights that
it cannot do without, or None; and `find(mesh, sight, options, count=None) -> Found`. All but those that choose by place
alone (random, farthest) have `saliency(mesh, sight, options) -> (n,)` too.
"""

from dataclasses import replace

from stages.conspicuity import CHANNELS
from stages.kit import Stopwatch
from stages.weights.features import SEEN
from stages.weights.published import ENHANCED

from .chance import BlindTouch
from .farthest import FarthestPoints
from .fuse import COMBINATIONS
from .fused import Fused, Machine, Merged, Weighted
from .positions import centre_distance, facing_viewer, height
from .rivals import corners, harris, heat_kernel, mesh_saliency, salient_points, sift
from .surface import Fixations, OnSurface

SYMMETRIES = {"SymLat": "symmetry_lateral", "SymRad": "symmetry_radial", "2Sym": "symmetry"}  # T3.1.5
WEIGHTED = (
    "equal",
    "thesis_ssim",
    "thesis_ed",
    "guided_ssim",
    "guided_ed",
    "guided_ssim_object",
    "guided_ssim_seen",
    "guided_ed_seen",
)
MACHINES = ("svm", "svm_nearest", "svm_seen", "svm_object", "svm_viewpoint")  # T3.2.3
PAPERS = {
    "mesh_saliency": mesh_saliency, "salient_points": salient_points, "sift": sift, "harris": harris,
    "corners": corners, "heat_kernel": heat_kernel,
}  # fmt: skip

METHODS = {
    ENHANCED: Fixations(ENHANCED, SEEN),
    "itti": Fused(COMBINATIONS["VisAtt"]),
    "random": BlindTouch(),
    **{name: Fused(channels) for name, channels in COMBINATIONS.items()},
    "VisAttCurvP": Merged(Fused(COMBINATIONS["VisAtt"]), Fused(COMBINATIONS["Curv"])),
    "VisAttSymP": Merged(Fused(COMBINATIONS["VisAtt"]), Fused(["symmetry"])),
    **{name: Fused([channel]) for name, channel in SYMMETRIES.items()},
    **{name: Weighted(name, CHANNELS) for name in WEIGHTED},
    **{name: Machine(name, CHANNELS) for name in MACHINES},
    "fixations_seen": Fixations("fixations_seen", SEEN),
    **{name: OnSurface(paper.saliency, paper.points) for name, paper in PAPERS.items()},
    "spectral_residual": Fused(["spectral_residual"]),
    "fine_grained": Fused(["fine_grained"]),
    "farthest": FarthestPoints(),
    "height": OnSurface(height),
    "centre_distance": OnSurface(centre_distance),
    "facing_viewer": OnSurface(facing_viewer),
}


def method_named(method):
    """The entry of METHODS; ValueError that lists them for an unknown name."""
    if method not in METHODS:
        raise ValueError(f"unknown method {method!r}: choose one of {', '.join(METHODS)}")
    return METHODS[method]


def teachable(methods, learned):
    """(those of the methods that can run with what was learned, the others): a Learned without ground truth lacks some.

    Raises ValueError for an unknown name.
    """
    known = {None, *learned.weights, *learned.svms}
    runs = [method for method in methods if method_named(method).learned in known]
    return runs, [method for method in methods if method not in runs]


def find_all(mesh, sight, methods, options, count):
    """Runs methods on one object: (dict method -> Found, dict method -> seconds).

    A method without a threshold of its own (random, farthest) gets as many strong points as the first one that has one,
    so that what the LOD keeps for either differs in place alone.
    """
    found, seconds = {}, {}
    for method in methods:
        with Stopwatch() as watch:
            found[method] = method_named(method).find(mesh, sight, options, count)
        seconds[method] = watch.seconds
    strong = next((result.strong for result in found.values() if result.strong is not None), count)
    for method, result in found.items():
        if result.strong is None:
            found[method] = replace(result, strong=min(strong, len(result.points)))
    return found, seconds

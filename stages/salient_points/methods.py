"""The registry of methods. To add one, add an entry.

A method has `channels`, the maps that it looks at (none: it is given no Sight), and
`find(mesh, sight, options, count=None) -> Found`. One with channels also has `saliency(sight, options) -> (n,)`.
"""

from dataclasses import replace

from stages.kit import Stopwatch
from stages.weights import weights as weights_of

from .chance import BlindTouch
from .fuse import COMBINATIONS
from .fused import Fused, Merged

METHODS = {
    "enhanced": Fused(weights_of("equal"), weighted=True),  # all nine channels
    "itti": Fused(COMBINATIONS["VisAtt"]),
    "random": BlindTouch(),
    **{name: Fused(channels) for name, channels in COMBINATIONS.items()},
    "VisAttCurvP": Merged(Fused(COMBINATIONS["VisAtt"]), Fused(COMBINATIONS["Curv"])),
    "VisAttSymP": Merged(Fused(COMBINATIONS["VisAtt"]), Fused(["symmetry"])),
}


def method_named(method):
    """The entry of METHODS; ValueError that lists them for an unknown name."""
    if method not in METHODS:
        raise ValueError(f"unknown method {method!r}: choose one of {', '.join(METHODS)}")
    return METHODS[method]


def find_all(mesh, sight, methods, options, count):
    """Runs methods on one object: (dict method -> Found, dict method -> seconds).

    A method without a threshold of its own (random) gets as many strong points as the first one that has one, so
    that what the LOD keeps for either differs in place alone.
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

"""One saliency map out of many conspicuity maps (T eq. 3.8 and 3.9), and the thesis's combinations by name."""

from collections.abc import Mapping

import numpy as np

CLASSICAL = ("color", "intensity", "orientation")  # Itti, Koch and Niebur 1998, T [41]

# T3.1.5. `VisAttAll` has the eight channels of T3.2.2; edge is added only in eq. 3.9 (methods `thesis_*`).
COMBINATIONS = {
    "VisAtt": CLASSICAL,
    "VisAttCon": (*CLASSICAL, "contrast"),
    "VisAttCurv": (*CLASSICAL, "curvature"),
    "VisAttSym": (*CLASSICAL, "symmetry"),
    "VisAttCurvSym": (*CLASSICAL, "curvature", "symmetry"),
    "VisAttCurvSymCon": (*CLASSICAL, "curvature", "symmetry", "contrast"),
    "VisAttEnt": (*CLASSICAL, "entropy"),
    "VisAttAll": (*CLASSICAL, "contrast", "curvature", "dkl", "entropy", "symmetry"),
    "Curv": ("curvature",),
}
WITHOUT_COLOUR = {  # T figure 3.3a
    f"{name}NoColour": tuple(channel for channel in COMBINATIONS[name] if channel not in ("color", "dkl"))
    for name in ("VisAtt", "VisAttAll")
}


def fuse(maps: Mapping[str, np.ndarray], weights: Mapping[str, float] | None = None) -> np.ndarray:
    """The weighted average of conspicuity maps: an array of their shape, in 0..1 where they are.

    maps: dict channel -> array, all of one shape. weights: dict channel -> weight of at least zero (T eq. 3.9); None
    gives all maps the same weight (T eq. 3.8). Maps without a weight are left out. Raises ValueError for no maps,
    unequal shapes, a negative or NaN weight, weights of an unknown channel, or weights that are all zero.
    """
    weights = dict.fromkeys(maps, 1.0) if weights is None else weights
    _check(maps, weights)
    total = sum(weights.values())
    parts = [np.asarray(maps[channel], dtype=np.float64) * (weight / total) for channel, weight in weights.items()]
    return np.asarray(sum(parts))


def _check(maps, weights):
    if not maps:
        raise ValueError("no conspicuity maps to fuse: give at least one channel")
    shapes = {channel: np.shape(values) for channel, values in maps.items()}
    if len(set(shapes.values())) > 1:
        raise ValueError(f"conspicuity maps must have one shape, got {shapes}")
    unknown = [channel for channel in weights if channel not in maps]
    if unknown:
        raise ValueError(f"weights name channels without a map: {', '.join(unknown)}; maps: {', '.join(maps)}")
    bad = {channel: weight for channel, weight in weights.items() if not weight >= 0 or not np.isfinite(weight)}
    if bad:
        raise ValueError(f"weights must be finite and not negative, got {bad}")
    if sum(weights.values()) == 0:
        raise ValueError("all weights are zero: give at least one channel a positive weight")

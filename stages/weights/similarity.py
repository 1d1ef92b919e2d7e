"""Channel weights from the similarity of conspicuity maps to the ground truth saliency map (T3.2.1.2 to T3.2.1.4)."""

from collections.abc import Iterable, Mapping

import numpy as np

from stages.kit.similarity import WINDOW, local_moments, ssim_map

from .euclidean import average, checked_maps


def view_similarities(
    maps: Mapping[str, np.ndarray], gts: np.ndarray, mask: np.ndarray | None = None
) -> dict[str, float]:
    """SSIM of each channel's map with the ground truth saliency map in one view: dict channel -> SSIM in -1..1.

    maps: dict channel -> (h, w) in 0..1; gts (h, w) in 0..1, the ground truth saliency map (T3.2.1.3), both zero off
    the object. SSIM is that of Wang et al. 2004 with their Gaussian window, T [63].

    mask None, as in the thesis: the mean over the whole image. Black background then has an SSIM of 1, and dark maps
    resemble the dark part of the ground truth: over 36 views of six objects, noise on the object got 0.82, and a map
    with one bright pixel 0.98. mask (h, w) boolean, the object: the mean over its pixels alone. This excludes the
    background (noise gets 0.01), but still rewards darkness on the object (one bright pixel gets 0.86). A flat map gets
    0 whatever its SSIM, since it has no information and would get the highest weight.

    A view without ground truth (gts zero everywhere) gives {}. Raises ValueError for maps that checked_maps refuses,
    with values outside 0..1 or smaller than the window, and for a ground truth or mask that checked_ground_truth
    refuses.
    """
    maps, shape = checked_maps(maps)
    gts, mask = checked_ground_truth(gts, mask, shape)
    if min(shape) < WINDOW:
        raise ValueError(f"maps of {shape[0]} x {shape[1]} pixels are smaller than SSIM's window of {WINDOW}")
    if any(values.min() < 0 or values.max() > 1 for values in maps.values()):
        raise ValueError("maps must lie in 0..1")
    if not gts.any():
        return {}
    moments = local_moments(gts)
    return {channel: _ssim(values, gts, moments, mask) for channel, values in maps.items()}


def _ssim(values, gts, moments, mask):
    if np.ptp(values) == 0:
        return 0.0
    found, edge = ssim_map(gts, values, moments, white=1), WINDOW // 2
    inside = found[edge:-edge, edge:-edge] if mask is None else found[mask]  # whole windows alone, as in MATLAB's ssim
    return float(inside.mean())


def similarity_weights(views: Iterable[Mapping[str, float]]) -> dict[str, float]:
    """The SSIM averaged over views, at least zero: dict channel -> weight in 0..1 (T table 3.1, second column).

    views: the dicts of view_similarities, weighted equally; empty ones are left out. A channel that is negatively
    related to the ground truth gets 0, since T eq. 3.9 does not allow negative weights. For several objects `average`
    the weights of the objects (stages.weights.euclidean).

    Raises ValueError when no view has a ground truth, or the views name different channels.
    """
    return {channel: max(value, 0.0) for channel, value in average(views).items()}


def checked_ground_truth(
    gts: np.ndarray, mask: np.ndarray | None, shape: tuple[int, int]
) -> tuple[np.ndarray, np.ndarray | None]:
    """(gts (h, w) f8, mask (h, w) boolean or None); ValueError for a shape unlike the maps', or gts outside 0..1."""
    gts = np.asarray(gts, dtype=np.float64)
    mask = None if mask is None else np.asarray(mask, dtype=bool)
    if gts.shape != shape or (mask is not None and mask.shape != shape):
        raise ValueError(
            f"maps are {shape}, ground truth {gts.shape}, mask {None if mask is None else mask.shape}: they must agree"
        )
    if not (gts.min() >= 0 and gts.max() <= 1):
        raise ValueError(f"the ground truth must lie in 0..1, got {gts.min():g} to {gts.max():g}")
    if mask is not None and not mask.any():
        raise ValueError("the mask holds no pixel of the object")
    return gts, mask

"""Learns weights of the channels from human attention (T3.2.1).

Weights come from the similarity of conspicuity maps to the ground truth map (T3.2.1.2 to T3.2.1.4), from the distance
of a map's brightest pixels to the ground truth points (T3.2.1.1), or from a log-linear density of fixations over the
surface, fitted by maximum likelihood. The distance follows the thesis, with these consequences:

- "Average pairwise" is the mean over all pairs of the n brightest pixels and the n points, not over nearest pairs. It
  is smallest between the points, not on them: one blob in the middle of four points scores better than four peaks
  exactly on the points.
- The n brightest pixels are neighbours on one peak, so only the position of the highest peak of a map matters.
- The distances are normalised over the channels of each view, so that the farthest channel of a view gets 0 and the
  nearest 1, however little they differ.
"""

import functools
from collections.abc import Iterable, Mapping, Sequence

import numpy as np

from haptic_glance.base.similarity import WINDOW, local_moments, ssim_map


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
    index, edge = ssim_map(gts, values, moments, white=1), WINDOW // 2
    inside = index[edge:-edge, edge:-edge] if mask is None else index[mask]  # whole windows alone, as in MATLAB's ssim
    return float(inside.mean())


def similarity_weights(views: Iterable[Mapping[str, float]]) -> dict[str, float]:
    """The SSIM averaged over views, at least zero: dict channel -> weight in 0..1 (T table 3.1, second column).

    views: the dicts of view_similarities, weighted equally; empty ones are left out. A channel that is negatively
    related to the ground truth gets 0, since T eq. 3.9 does not allow negative weights. For several objects `average`
    the weights of the objects (haptic_glance.look.weights.attention).

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


def view_distances(maps: Mapping[str, np.ndarray], rows: np.ndarray, columns: np.ndarray) -> dict[str, float]:
    """The distance of each channel's brightest pixels to the points of one view: dict channel -> mean, in pixels.

    maps: dict channel -> (h, w), all of one shape; rows, columns (n,): the ground truth points visible in this view,
    in pixels of the maps, fractions allowed. The mean is over all pairs of the n brightest pixels of the map and the n
    points (T3.2.1.1; MATLAB's `mean(pdist2(a, b), 'all')`). Pixels that tie for the last of the n places count equally,
    so that a flat map gets the mean distance of all pixels.

    A view without points gives {}. Raises ValueError for no maps, maps of unequal shapes, with NaN or not
    2D, and for points that are not finite or off the map.
    """
    maps, shape = checked_maps(maps)
    points = _checked_points(rows, columns, shape)
    if not len(points):
        return {}
    return {channel: _distance(values, points) for channel, values in maps.items()}


def _distance(image, points):
    """Mean distance of the brightest pixels to the points; as many pixels as points."""
    count = min(len(points), image.size)
    cut = np.sort(image, axis=None)[image.size - count]  # partition takes five times as long on a map of many zeros
    above, tied = image > cut, image == cut
    places = count - above.sum()
    near = _to_points(above, points).sum() + places * _to_points(tied, points).mean()
    return float(near / count)


def _to_points(chosen, points):
    """(k,) the mean distance to the points of each of the chosen pixels (h, w) boolean."""
    pixels = np.nonzero(chosen)
    total = np.zeros(len(pixels[0]))
    for row, column in points:  # one point at a time: on a flat map, a million pixels are chosen
        total += np.hypot(pixels[0] - row, pixels[1] - column)
    return total / len(points)


def euclidean_weights(views: Iterable[Mapping[str, float]]) -> dict[str, float]:
    """One minus the distance, normalised over the channels of each view, averaged: dict channel -> weight in 0..1.

    views: the dicts of view_distances, weighted equally; empty ones (no visible point) are left out. If all channels of
    a view are equally far, all get 1. For several objects, `average` the weights of the objects, so that an object with
    more views does not count more. T3.2.1.1, T table 3.1, third column.

    Raises ValueError when no view has a point, or the views name different channels.
    """
    return average([_nearness(view) for view in views])


def _nearness(distances):
    if not distances:
        return {}
    values = np.array(list(distances.values()), dtype=np.float64)
    if not np.isfinite(values).all() or values.min() < 0:
        raise ValueError(f"distances must be finite and not negative, got {distances}")
    span = np.ptp(values)
    relative = (values - values.min()) / span if span > 0 else np.zeros_like(values)
    return dict(zip(distances, (1 - relative).tolist(), strict=True))


def average(tables: Iterable[Mapping[str, float]]) -> dict[str, float]:
    """The mean of dicts channel -> value, in the order of the channels; empty dicts are left out.

    Raises ValueError when none is left, or when they name different channels.
    """
    tables = [table for table in tables if table]
    if not tables:
        raise ValueError("no view shows a ground truth point: weights need at least one")
    channels = list(tables[0])
    for table in tables:
        if set(table) != set(channels):
            raise ValueError(f"views name different channels: {', '.join(channels)} and {', '.join(table)}")
    return {channel: float(np.mean([table[channel] for table in tables])) for channel in channels}


def checked_maps(maps: Mapping[str, np.ndarray]) -> tuple[dict[str, np.ndarray], tuple[int, int]]:
    """(dict channel -> (h, w) f8, shape); ValueError for no maps, NaN, unequal shapes or maps that are not 2D."""
    if not maps:
        raise ValueError("no conspicuity maps: give at least one channel")
    maps = {channel: np.asarray(values, dtype=np.float64) for channel, values in maps.items()}
    shapes = {values.shape for values in maps.values()}
    shape = shapes.pop()
    if shapes or len(shape) != 2 or 0 in shape:
        raise ValueError(f"conspicuity maps must have one shape (h, w), got {[v.shape for v in maps.values()]}")
    bad = [channel for channel, values in maps.items() if not np.isfinite(values).all()]
    if bad:
        raise ValueError(f"conspicuity maps hold NaN or infinite values: {', '.join(bad)}")
    return maps, shape


def _checked_points(rows, columns, shape):
    rows, columns = np.asarray(rows, dtype=np.float64), np.asarray(columns, dtype=np.float64)
    if rows.ndim != 1 or rows.shape != columns.shape:
        raise ValueError(f"rows and columns must be two arrays (n,), got {rows.shape} and {columns.shape}")
    points = np.column_stack([rows, columns])
    stray = ~((points >= -0.5) & (points <= np.array(shape) - 0.5)).all(axis=1)
    if stray.any():
        raise ValueError(f"points off the map of {shape[0]} x {shape[1]} pixels: {points[stray][:5].round(1).tolist()}")
    return points


RIDGE = 0.05  # penalty on the squared weights, per mean log-likelihood of a fixation; chosen leave-one-object-out


def fit_fixations(
    features: Sequence[np.ndarray], amounts: Sequence[np.ndarray], areas: Sequence[np.ndarray], ridge: float = RIDGE
) -> np.ndarray:
    """The weight of each feature, (d,) f8, that makes the fixations of all objects most likely.

    Per object: features (n, d), amounts (n,) of fixations (seconds, or marks), areas (n,) of the vertices. A fixation
    lands on vertex i with probability p_i = A_i exp(w f_i) / sum_j A_j exp(w f_j): an inhomogeneous Poisson process
    given the number of fixations, the standard model (Barthelme, Trukenbrod, Engbert and Wichmann, Modeling fixation
    locations using spatial point processes, Journal of Vision 13(12), 2013). Objects are weighted equally, whatever
    their number of fixations. The problem is convex, so the result does not depend on the initial value. Raises
    ValueError without objects, or for an object without fixations.
    """
    if not len(features):
        raise ValueError("no object to fit the model to: give at least one with fixations")
    if any(not amount.sum() > 0 for amount in amounts):
        raise ValueError("the model cannot be fitted to an object without fixations: leave it out")
    objects = [
        (f, a / a.sum(), np.log(np.maximum(area, 1e-300))) for f, a, area in zip(features, amounts, areas, strict=True)
    ]

    def loss(weights):
        value, slope = ridge * weights @ weights, 2 * ridge * weights
        for f, share, log_area in objects:
            score = f @ weights + log_area
            likely = score - np.logaddexp.reduce(score)
            value -= (share * (likely - log_area)).sum() / len(objects)
            slope -= (share - np.exp(likely)) @ f / len(objects)
        return value, slope

    from scipy.optimize import minimize  # takes a tenth of a second to import, and only a fit needs it

    optimum = minimize(loss, np.zeros(features[0].shape[1]), jac=True, method="L-BFGS-B", options={"maxiter": 500})
    return optimum.x


def fixation_density(features: Mapping[str, np.ndarray], weights: Mapping[str, float]) -> np.ndarray:
    """(n,) f8 in 0..1: exp(sum of weight times feature) over its maximum.

    features: dict name -> (n,); weights: dict name -> weight. Raises ValueError when a feature of the weights is
    missing, or there are no weights.
    """
    missing = [name for name in weights if name not in features]
    if missing or not weights:
        raise ValueError(f"no feature {', '.join(missing) or 'at all'} to weigh: there are {', '.join(features)}")
    if not np.isfinite(list(weights.values())).all():
        raise ValueError(f"weights must be finite, got {weights}")
    score = functools.reduce(np.add, (weight * features[name] for name, weight in weights.items()))
    return np.exp(score - score.max())


def standardise(values: np.ndarray, areas: np.ndarray) -> np.ndarray:
    """values (n,) minus their area-weighted mean, over their deviation.

    Zeros if the values are constant, and at vertices without area.
    """
    total = areas.sum()
    if not total > 0:
        return np.zeros(len(values))
    centred = np.where(areas > 0, values - (values * areas).sum() / total, 0)
    deviation = np.sqrt((centred**2 * areas).sum() / total)
    level = np.abs(values[areas > 0]).max()
    return centred / deviation if deviation > 1e-9 * max(level, 1e-30) else np.zeros(len(values))

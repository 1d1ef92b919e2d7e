"""The features of the glance: height, visibility, relief, thickness, symmetry, and the place of a point on the object.

Relief and thickness are measured at several scales on a graph of neighbouring points. People look along the upright
planes in which a surface is symmetric.
"""

import numpy as np
from scipy import ndimage

from .cells import visibility
from .samples import Samples

RADII = 0.12, 0.24  # of fullness, in units of the bounding sphere's diameter
# name -> its standard deviation on a typical object: the median over 33 objects with human gaze, of the last two over
# those with a clear mirror plane. A feature that varies by less than half of this is not scaled up to deviation 1, so
# that noise on a sphere is not amplified.
FEATURES = {
    "rank": 0.29, "middle": 0.31, "upward": 0.53, "upward_high": 0.098, "seen": 0.11, "above": 0.16,
    "above_high": 0.047, "below": 0.15, "log_below": 1.0, "log_side": 0.7, "convexity": 0.12, "detail": 0.055,
    "relief": 0.065, "fullness_0.12": 0.23, "fullness_0.24": 0.27, "distance": 0.096, "distance_squared": 0.054,
    "outward": 0.49, "off_plane": 0.03, "on_plane": 0.2,
}  # fmt: skip
LEVELS, BLUR = 256, 4.0  # of height, and the deviation of the Gaussian over them that a rank is read from
MARGIN = 20  # levels below and above, which the Gaussian reaches
LIMIT = 4.0  # standard deviations; what lies farther out counts as this


def features(samples: Samples) -> dict[str, np.ndarray]:
    """dict name -> (s,) f8: the features, not yet standardised."""
    visible_share, side, above, below = visibility(samples)
    convexity, detail, around = relief(samples)
    off_plane, on_plane = symmetry(samples)
    positions, upward = samples.local, samples.normals[:, 2]
    height, distance = positions[:, 2], np.linalg.norm(positions, axis=1)
    rank = _rank(height, samples.shares)
    return {
        "rank": rank, "middle": np.sin(np.pi * rank), "upward": upward, "upward_high": height * upward,
        "seen": visible_share, "above": above, "above_high": above * height, "below": below,
        "log_below": np.log(below + 0.02), "log_side": np.log(side + 0.01),
        "convexity": convexity, "detail": detail, "relief": around,
        **{f"fullness_{radius}": fullness(samples, radius) for radius in RADII},
        "distance": distance, "distance_squared": distance**2,
        "outward": np.einsum("ij,ij->i", samples.normals @ samples.axes.T, positions) / np.maximum(distance, 1e-9),
        "off_plane": off_plane, "on_plane": on_plane,
    }  # fmt: skip


def _rank(height, shares):
    """(s,) the share of the surface that lies below each height, over which a flat top is spread evenly."""
    low, span = height.min(), max(float(np.ptp(height)), 1e-9)
    level = (height - low) / span * LEVELS + MARGIN
    amounts = np.bincount(np.rint(level).astype(np.int64), shares, minlength=LEVELS + 2 * MARGIN + 1)
    amounts = ndimage.gaussian_filter1d(amounts, BLUR, mode="constant")
    below = np.cumsum(amounts) - amounts / 2
    return np.interp(level, np.arange(len(below)), below)


def standardised(samples: Samples) -> dict[str, np.ndarray]:
    """dict name -> (s,) f8: the features with mean 0 and deviation 1, or less where one hardly varies."""
    columns = {}
    for name, values in features(samples).items():
        centred = values - samples.shares @ values
        deviation = float(np.sqrt(samples.shares @ centred**2))
        columns[name] = (centred / max(deviation, FEATURES[name] / 2)).clip(-LIMIT, LIMIT)
    return columns


FINE, COARSE = 1, 6  # steps over the graph of the finest relief, and of a coarser one
AROUND = 18  # steps over which relief is averaged: how rich in relief the neighbourhood is
VOXELS = 48  # in a unit of length, in which the surface around a point is counted
CUT = 3.0  # deviations at which the Gaussian of that count ends
MOST_VOXELS = 2**24  # above which the samples farther out than CLIP, of stray faces, are counted there
CLIP = 2.0  # units of length


def relief(samples: Samples) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """(convexity, detail, relief around) of each point, each (s,).

    Convexity: how far a point stands out of the mean of its neighbours along its normal, over their distance (the mean
    curvature times a length). Detail: how much this differs between two scales (centre and surround, as in Lee 2005).
    A rough surface leaves noise in a point's height. There the mean is taken with how far the point lies below its
    neighbours' tangent planes, which is as much on a curved surface, and the noise of the point cancels.
    """
    heights = np.einsum("ij,ij->i", samples.normals, samples.points)
    mean, planes, stands_out = samples.points, np.column_stack([samples.normals, heights]), {}
    for step in range(1, COARSE + 1):
        mean = samples.average @ mean
        planes = samples.average @ planes if samples.rough else planes
        if step in (FINE, COARSE):
            out = np.einsum("ij,ij->i", samples.normals, samples.points - mean)
            if samples.rough:
                below = planes[:, 3] - np.einsum("ij,ij->i", planes[:, :3], samples.points)
                out = (out + below) / 2
            stands_out[step] = out / (np.sqrt(step) * samples.spacing)
    around = np.abs(stands_out[COARSE])
    for _ in range(AROUND):
        around = samples.average @ around
    return stands_out[FINE], np.abs(stands_out[FINE] - stands_out[COARSE]), around


def fullness(samples: Samples, radius: float) -> np.ndarray:
    """(s,) log of the share of the surface around each point over that of a disc of the size of the object.

    The surface is weighted by a Gaussian with the second moment of a ball of this radius. High where a part is thin or
    folded, low at a tip: an integral invariant, which noise does not move (Pottmann et al., Integral invariants for
    robust geometry processing, CAGD 2009).
    """
    deviation = radius / np.sqrt(5)
    local = samples.local
    if np.prod(2 * VOXELS * np.abs(local).max(axis=0) + 1) > MOST_VOXELS:
        local = local.clip(-CLIP, CLIP)
    reach = np.ceil(np.abs(local).max(axis=0) * VOXELS).astype(np.int64)
    places, shape = local * VOXELS + reach, 2 * reach + 1
    voxels = np.ravel_multi_index(np.rint(places).astype(np.int64).T, shape)
    amounts = np.bincount(voxels, samples.shares, minlength=shape.prod()).reshape(shape).astype(np.float32)
    around = ndimage.gaussian_filter(amounts, deviation * VOXELS, mode="constant", truncate=CUT)
    density = ndimage.map_coordinates(around, places.T, order=1) * (np.sqrt(2 * np.pi) * deviation * VOXELS) ** 3
    return np.log(np.maximum(density / radius**2, 1e-6))


TURNS, RINGS, HEIGHTS = 120, 12, 24  # bins around the axis, across it and along it
BIN_BLUR = 1.0  # deviation of the Gaussian over the bins
EQUAL = 0.1  # lack of correlation at which a plane counts 1 / e as much as a perfect one
LEAST = 0.1  # of the share of the best plane, below which one is left out
NARROW = 0.05  # distance from the plane, in units of the size, at which its effect has fallen to 1 / e
WALL, DIGITS = 1e-9, 12  # radians from a wall between two bins of turn, and digits of a length: less is rounding


def symmetry(samples: Samples) -> tuple[np.ndarray, np.ndarray]:
    """(distance from the mirror plane, nearness to it) of each point, each (s,), both 0 without a symmetry.

    The planes go through the z axis of the points' mean. A plane counts by how well the surface, in bins of turn,
    radius and height, correlates with its mirror image; the correlations at all planes are one Fourier transform. Both
    values are means over the planes, times how much better these fit than a plane does on average, so that a body of
    revolution, which has no plane of its own, has 0.
    """
    x, y, z = samples.local.T
    amounts = _amounts(np.arctan2(y, x), np.hypot(x, y).round(DIGITS), z.round(DIGITS), samples.shares)
    amounts = ndimage.gaussian_filter1d(amounts, BIN_BLUR, axis=0, mode="wrap")
    amounts = ndimage.gaussian_filter(amounts, (0, BIN_BLUR, BIN_BLUR))
    waves = np.fft.rfft(amounts, axis=0)
    correlation = np.fft.irfft((waves**2).sum(axis=(1, 2)), TURNS) / (amounts**2).sum()
    fits = np.exp((correlation - 1) / EQUAL)
    share = fits / fits.sum()
    score = max(float(share @ fits - fits.mean()), 0.0)
    peaks = np.flatnonzero(share > LEAST * share.max())
    angles = np.pi * (peaks + 1) / TURNS - np.pi  # bin k of one image lies over bin j of the other: half of their sum
    distances = np.abs(np.outer(x, np.sin(angles)) - np.outer(y, np.cos(angles)))
    share = share[peaks] / share[peaks].sum()
    return score * (distances @ share), score * (np.exp(-((distances / NARROW) ** 2)) @ share)


def _amounts(turn, radius, z, shares):
    """(TURNS, RINGS, HEIGHTS) the share of the surface in each bin.

    A point on the wall between two bins of turn counts half in both. Rounding would put it into either, and a symmetric
    surface would no longer be its own mirror image.
    """
    bins, amounts = (TURNS, RINGS, HEIGHTS), np.zeros((TURNS, RINGS, HEIGHTS))
    ranges = (-np.pi, np.pi), (0, max(radius.max(), 1e-9)), (z.min() - 1e-9, z.max() + 1e-9)
    for side in (-WALL, WALL):
        places = np.stack([(turn + side + np.pi) % (2 * np.pi) - np.pi, radius, z], axis=1)
        amounts += np.histogramdd(places, bins, ranges, weights=shares / 2)[0]
    return amounts

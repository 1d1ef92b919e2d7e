"""Fuses conspicuity maps (T eq. 3.8, 3.9), selects pixels in the fused maps, and merges the points of all views.

Pixels are selected by threshold and centroid (T3.1.2) or by suppression (T3.2.5).
"""

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from haptic_glance.base.jit import cached_njit
from haptic_glance.base.lazy import cv2
from haptic_glance.mesh.mesh import Mesh

kernel = cached_njit()
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
# How many maps the sums of T eq. 3.1 to 3.6 have; the channels are their means, which eq. 3.8 weights otherwise.
TERMS = {"intensity": 6, "orientation": 4, "color": 12, "dkl": 18}
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


SUPPRESSION_THRESHOLD = 0.9  # of the map's maximum; T3.2.5
REGION_SHARE = 0.3  # of the object's pixels, the most salient ones; T3.1.1


@dataclass(frozen=True)
class SelectedPixels:
    """Pixels of one map, most salient first: rows, columns (k,) i8, values (k,) f8.

    strong: how many leading ones pass the thesis's threshold; the others only fill up the count.
    """

    rows: np.ndarray
    columns: np.ndarray
    values: np.ndarray
    strong: int


def select_by_suppression(
    image: np.ndarray, radius: float, count: int | None = None, threshold: float = SUPPRESSION_THRESHOLD
) -> SelectedPixels:
    """Takes the largest value, sets its neighbourhood to zero, and repeats down to `threshold` of the maximum (T3.2.5).

    image (h, w), zero off the object; radius in pixels: all points are farther apart. count: how many, going on below
    the threshold where needed, as long as there are pixels above zero; None stops at the threshold. A map of zeros
    gives no points. Raises ValueError for a map that is empty, not 2D, negative or NaN, and for a negative radius or
    count.
    """
    image = check_map(image)
    remaining = image.copy()
    if radius < 0 or (count is not None and count < 0):
        raise ValueError(f"radius and count must not be negative, got {radius} and {count}")
    floor = threshold * remaining.max()
    pixels = suppress(remaining, radius, remaining.size if count is None else count, floor if count is None else 0.0)
    rows, columns = np.unravel_index(pixels, remaining.shape)
    values = image[rows, columns]
    return SelectedPixels(rows, columns, values, int((values > floor).sum()))


def select_by_centroid(image: np.ndarray, count: int | None = None, share: float = REGION_SHARE) -> SelectedPixels:
    """Centroids of the connected regions among the `share` of highest saliency values (T3.1.1, T3.1.2).

    image (h, w), zero off the object: the share is of the pixels above zero. Pixels that touch at a corner are
    connected. The centroid of a concave region may lie outside it, so the region's pixel nearest to it is taken.
    Ordered by the region's highest value. Every centroid is strong; count keeps the first ones. Raises ValueError as
    select_by_suppression does, and for a share outside 0..1.
    """
    image = check_map(image)
    if not 0 < share <= 1:
        raise ValueError(f"share must be above 0 and at most 1, got {share}")
    if not image.any():
        no_pixels = np.zeros(0, dtype=np.int64)
        return SelectedPixels(no_pixels, no_pixels, np.zeros(0), 0)
    region = (image > 0) & (image >= np.quantile(image[image > 0], 1 - share))
    labels = cv2.connectedComponents(region.astype(np.uint8), connectivity=8)[1]
    rows, columns = np.nonzero(region)
    label = labels[rows, columns]
    order = np.argsort(label, kind="stable")
    members = np.split(order, np.flatnonzero(np.diff(label[order])) + 1)
    centres = np.array([_central_member(rows[ids], columns[ids]) for ids in members])
    peaks = np.array([image[rows[ids], columns[ids]].max() for ids in members])
    first = np.argsort(-peaks, kind="stable")[:count]
    return SelectedPixels(centres[first, 0], centres[first, 1], peaks[first], len(first))


def _central_member(rows, columns):
    distance = (rows - rows.mean()) ** 2 + (columns - columns.mean()) ** 2
    nearest = distance.argmin()
    return rows[nearest], columns[nearest]


def check_map(image: np.ndarray) -> np.ndarray:
    """The map as (h, w) f8; raises ValueError when it is empty, not 2D, negative or not finite."""
    image = np.asarray(image, dtype=np.float64)
    if image.ndim != 2 or image.size == 0:
        raise ValueError(f"a saliency map must have shape (h, w) and at least one pixel, got {image.shape}")
    if not np.isfinite(image).all() or image.min() < 0:
        raise ValueError("a saliency map must be finite and not negative")
    return image


SAME_PLACE = 1e-6  # of the diagonal: below this spacing, points coincide


def merge_views(
    mesh: Mesh, vertices: np.ndarray, values: np.ndarray, strong: np.ndarray, radius: float
) -> tuple[np.ndarray, int]:
    """Candidates of many views without duplicates: (vertices (k,) i8, how many leading ones are strong).

    vertices, values, strong (c,): vertex, saliency and threshold mark of each candidate. Strong ones come first, then
    by saliency. A candidate within `radius` (units) of one already taken is the same feature seen from another view:
    two points of one view are never that near, since projection only shortens distances. Keeping both would count one
    feature as often as it is seen.
    """
    order = np.lexsort((-values, ~strong))
    spaced_ids = spaced(mesh.vertices[vertices[order]], radius, 0, len(order))
    return vertices[order][spaced_ids], int(strong[order][spaced_ids].sum())


def continue_on_surface(mesh: Mesh, points: np.ndarray, saliency: np.ndarray, radius: float, count: int) -> np.ndarray:
    """Points (k,) continued to `count` vertices by the saliency (n,), or to all vertices in a face where fewer.

    The spacing starts at `radius` and halves as the surface fills up. Ties of saliency go by position, never by vertex
    number, so that the order of the vertices plays no role.
    """
    if len(points) >= count:
        return points[:count]
    vertex_ids = np.flatnonzero(mesh.vertex_normals.any(axis=1))
    x, y, z = mesh.vertices[vertex_ids].round(9).T
    ranked = vertex_ids[np.lexsort((z, y, x, -saliency[vertex_ids]))]
    while len(points) < min(count, len(vertex_ids)):
        queue = np.r_[points, ranked[~np.isin(ranked, points)]]
        if radius < SAME_PLACE * mesh.diagonal:  # only coincident vertices are left
            return queue[:count]
        points = queue[spaced(mesh.vertices[queue], radius, len(points), count)]
        radius /= 2
    return points[:count]


@kernel
def spaced(positions: np.ndarray, radius: float, first: int, limit: int) -> np.ndarray:
    """Indices of positions (k, 3), in order, each farther than radius from all before it; the `first` ones stay.

    limit: stop at so many.
    """
    kept, count = np.empty(len(positions), np.int64), 0
    for i in range(len(positions)):
        if count >= max(limit, first):
            break
        if i < first or _apart(positions, i, kept[:count], radius):
            kept[count] = i
            count += 1
    return kept[:count]


@kernel
def _apart(positions, i, earlier, radius):
    for k in earlier:
        square = 0.0
        for axis in range(3):
            square += (positions[k, axis] - positions[i, axis]) ** 2
        if square <= radius**2:
            return False
    return True


@kernel
def suppress(image: np.ndarray, radius: float, limit: int, floor: float) -> np.ndarray:
    """(k,) i8 flat ids of at most `limit` maxima above `floor`, each outside the discs around those before it.

    image (h, w) f8 is set to zero within `radius` pixels of each. Of equal pixels the first one is taken.
    """
    height, width = image.shape
    extent, maxima = int(radius), []
    tops, firsts = np.empty(height), np.empty(height, np.int64)  # largest value of each row, and its column
    for r in range(height):
        firsts[r] = image[r].argmax()
        tops[r] = image[r, firsts[r]]
    while len(maxima) < limit:
        row = tops.argmax()
        if tops[row] <= floor:
            break
        column = firsts[row]
        maxima.append(row * width + column)
        for r in range(max(row - extent, 0), min(row + extent + 1, height)):
            for c in range(max(column - extent, 0), min(column + extent + 1, width)):
                if (r - row) ** 2 + (c - column) ** 2 <= radius**2:
                    image[r, c] = 0.0
            firsts[r] = image[r].argmax()
            tops[r] = image[r, firsts[r]]
    return np.array(maxima, dtype=np.int64)

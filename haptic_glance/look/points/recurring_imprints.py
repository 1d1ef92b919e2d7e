"""The method `touch`: places whose imprint recurs on the object, so that one touch there tells the object.

A classifier names the object that has the nearest imprints. An imprint that recurs on the object (on the other side, on
another leg, all along a rim) has been met before, wherever the object was learned.
"""

import math
from dataclasses import replace

import numpy as np

from haptic_glance.base.jit import cached_njit
from haptic_glance.mesh.mesh import Mesh
from haptic_glance.mesh.sampling import along_curve
from haptic_glance.touch.surface import sensor_axes

from ..glance import Samples, samples_of_mesh
from .glance import SampledDetector, nearest_vertices
from .options import Options

kernel = cached_njit()
WIDTH = 0.16  # of the array, in units of the normalised mesh: 16 cells of 0.01 (T4.3.1)
CELLS = 8  # along a side of the array that compares places
PLACES = 2000  # places compared with each other
SHARE = 0.03  # of the surface that must feel alike for a place to recur
ALIKE = 0.06  # root mean square difference of two imprints in 0..1 at which they are 1 / e alike
FLAT = 1e-3  # relief below which an imprint is flat, in units: samples are no finer
DISC = 1.1  # radius of a disc over the square root of the area that its sample stands for: discs leave no holes
ROUNDING = 1e-6  # smaller differences of skewness, steps and shares are rounding


class TouchDetector(SampledDetector):
    """Finds places by the surface and the axis that points up, which an array is held by."""

    def _values(self, mesh: Mesh, options: Options) -> tuple[Samples, np.ndarray]:
        samples = samples_of_mesh(mesh)
        places = spread(samples, PLACES)
        axes = sensor_axes(samples.normals[places])
        radii = DISC * np.sqrt(samples.areas)
        depths = pressed(samples.points, samples.normals, radii, axes, places, CELLS, WIDTH)
        values = recurrence(imprints(depths), samples.points[places])
        area = samples.areas.sum() / len(places)
        place_samples = replace(
            samples, points=samples.points[places], normals=samples.normals[places], areas=np.full(len(places), area)
        )
        return place_samples, values

    def _vertices(self, mesh: Mesh, samples: Samples, ids: np.ndarray) -> np.ndarray:
        """Near the place and on its side: one across the edge or on the back of a sheet feels otherwise."""
        candidates = np.hstack([mesh.vertices, samples.spacing * mesh.vertex_normals])[mesh.used]
        targets = np.hstack([samples.points[ids], samples.spacing * samples.normals[ids]])
        return nearest_vertices(mesh, candidates, targets)


def spread(samples: Samples, count: int) -> np.ndarray:
    """(k,) i8 ids of at most `count` samples, each for the same share of the surface.

    They follow one another at equal areas along a curve that fills space. Two sides of a sheet get as many each.
    """
    skew = samples.shares @ samples.local**3
    inside = samples.local * np.where(skew * [1, 1, 0] < -ROUNDING, -1, 1)  # either way of a horizontal axis
    has_side = np.flatnonzero(samples.normals.any(axis=1))
    order = has_side[np.argsort(along_curve(inside)[has_side], kind="stable")]
    cumulative_shares = np.cumsum(samples.shares[order])
    ranks = np.searchsorted(cumulative_shares, (np.arange(count) + 0.5) / count * cumulative_shares[-1] - ROUNDING)
    return order[np.unique(ranks.clip(max=len(order) - 1))]


def imprints(depths: np.ndarray) -> np.ndarray:
    """(k, cells) f8: imprints in 0..1 of distances (k, rows, cols), 0 where the array meets the surface first."""
    above = depths.reshape(len(depths), -1)
    above = above - above.min(axis=1, keepdims=True)
    relief = above.max(axis=1, keepdims=True)
    return np.where(relief > FLAT, above / np.maximum(relief, FLAT), 0)


def recurrence(imprints: np.ndarray, points: np.ndarray) -> np.ndarray:
    """(k,) f8 in 0..1: how alike the imprints (k, c) are at the places, of points (k, 3), that are most alike.

    Only places farther than the array's width count, since nearer ones feel the same surface, and of these the share of
    the surface SHARE. 1: it feels the same there.
    """
    square = (imprints**2).sum(axis=1)
    imprint_distances = square[:, None] + square - 2 * imprints @ imprints.T
    imprint_distances = np.sqrt(np.maximum(imprint_distances, 0) / imprints.shape[1])
    square = (points**2).sum(axis=1)
    is_near = square[:, None] + square - 2 * points @ points.T <= WIDTH**2
    imprint_distances[is_near] = 1
    count = max(round(SHARE * len(points)), 1)
    nearest = np.partition(imprint_distances, min(count, len(points)) - 1, axis=1)[:, :count]
    return np.exp(-nearest.mean(axis=1).round(6) / ALIKE)


EDGE_ON = 0.02  # cosine between the normals of a disc and of an array below which the array does not meet the disc


@kernel
def pressed(
    points: np.ndarray, normals: np.ndarray, radii: np.ndarray, axes: np.ndarray, at: np.ndarray, cells: int,
    width: float,
) -> np.ndarray:  # fmt: skip
    """(k, cells, cells) distances below arrays of a width at points `at` (k,), whose axes (k, 3, 3) are their own.

    Each of the points (s, 3) stands for a disc of its radius, perpendicular to its normal. Of the discs that a cell
    meets from outside, the nearest one counts; a cell that meets none within the width reports the width.
    """
    step, half = width / cells, width / 2
    depths = np.full((len(at), cells, cells), width)
    for i in range(len(at)):
        right, up, out = axes[i, 0], axes[i, 1], axes[i, 2]
        for j in range(len(points)):
            x, y, z = points[j, 0] - points[at[i], 0], points[j, 1] - points[at[i], 1], points[j, 2] - points[at[i], 2]
            reach = radii[j]
            height = out[0] * x + out[1] * y + out[2] * z
            if abs(height) > width + reach:
                continue
            u = right[0] * x + right[1] * y + right[2] * z
            if abs(u) > half + reach:
                continue
            v = up[0] * x + up[1] * y + up[2] * z
            if abs(v) > half + reach:
                continue
            x, y, z = normals[j, 0], normals[j, 1], normals[j, 2]
            facing = out[0] * x + out[1] * y + out[2] * z
            if facing <= EDGE_ON:
                continue
            slope_u = (right[0] * x + right[1] * y + right[2] * z) / facing
            slope_v = (up[0] * x + up[1] * y + up[2] * z) / facing
            left = max(int(math.ceil((u - reach + half) / step - 0.5)), 0)
            end = min(int(math.floor((u + reach + half) / step - 0.5)), cells - 1)
            top = max(int(math.ceil((half - v - reach) / step - 0.5)), 0)
            bottom = min(int(math.floor((half - v + reach) / step - 0.5)), cells - 1)
            for column in range(left, end + 1):
                du = (column + 0.5) * step - half - u
                for row in range(top, bottom + 1):
                    dv = half - (row + 0.5) * step - v
                    rise = -(slope_u * du + slope_v * dv)
                    below = -(height + rise)
                    if du * du + dv * dv + rise * rise <= reach * reach and abs(below) < abs(depths[i, row, column]):
                        depths[i, row, column] = below
    return depths

"""How much a result changes under a disturbance (repeatability, drift), and maps under other conditions.

Conditions are the light, the background and the image size.
"""

from collections.abc import Sequence

import numpy as np
from scipy.spatial import KDTree

from haptic_glance.disturb.perturbed import Conditions, Perturbed
from haptic_glance.look import camera
from haptic_glance.look.channels import ViewMaps, conspicuity
from haptic_glance.look.channels.channels import REDUCTION, mask_at_size
from haptic_glance.look.points.detectors import random_vertices
from haptic_glance.look.views import TWELVE, View, render
from haptic_glance.look.views.shading import corner_groups, shade
from haptic_glance.look.weights.attention import standardise
from haptic_glance.mesh.mesh import Mesh
from haptic_glance.mesh.rays import barycentric

TOLERANCE = 0.02  # of the diagonal: a point this close to an original one counts as the same
DRAWS = 10  # of random points; their mean repeatability is the chance level


def repeatability(before: np.ndarray, after: np.ndarray, tolerance: float) -> float:
    """The share of the points of both sets that have a point of the other set within the tolerance, 0..1.

    before (k, 3), after (k', 3) and tolerance are in one frame and unit. 1 for equal sets, 0 when one of them is empty,
    NaN when both are. Source: Schmid, Mohr and Bauckhage, Evaluation of interest point detectors, IJCV 37(2), 2000,
    made symmetric, so that neither many nor few points have an advantage. Raises ValueError for a negative tolerance.
    """
    if not tolerance >= 0:
        raise ValueError(f"tolerance must not be negative, got {tolerance}")
    before, after = (np.asarray(points, dtype=np.float64).reshape(-1, 3) for points in (before, after))
    if len(before) == 0 and len(after) == 0:
        return np.nan
    if len(before) == 0 or len(after) == 0:
        return 0.0
    matches = (KDTree(after).query(before)[0] <= tolerance).sum() + (KDTree(before).query(after)[0] <= tolerance).sum()
    return float(matches / (len(before) + len(after)))


def chance_repeatability(
    before: np.ndarray, perturbed: Perturbed, count: int, generator: np.random.Generator, tolerance: float
) -> float:
    """The repeatability of `count` random vertices, drawn by area, against `before`: the mean of DRAWS draws."""
    draws = [perturbed.original_positions[random_vertices(perturbed.mesh, count, generator)] for _ in range(DRAWS)]
    return float(np.mean([repeatability(before, points, tolerance) for points in draws]))


def at_original_vertices(mesh: Mesh, perturbed: Perturbed, saliency: np.ndarray) -> np.ndarray:
    """(n,): saliency on the vertices of a Perturbed, read at the vertices of the original mesh.

    Taken from the nearest vertex by position, since decimation and remeshing change the ids. Vertices that no face uses
    are ignored.
    """
    vertex_ids = np.unique(perturbed.mesh.faces)
    return saliency[vertex_ids[KDTree(perturbed.original_positions[vertex_ids]).query(mesh.vertices)[1]]]


def drift(before: np.ndarray, after: np.ndarray, areas: np.ndarray) -> float:
    """One minus Pearson's correlation of two maps (n,) on one surface, each vertex weighted by its area: 0..2.

    0 for maps that are equal up to scale, 1 for unrelated ones. Two constant maps have a drift of 0, a constant map and
    any other a drift of 1.
    """
    first, second = standardise(before, areas), standardise(after, areas)
    if not first.any() and not second.any():
        return 0.0
    return float(max(1 - (areas * first * second).sum() / areas.sum(), 0.0))  # rounding may make it negative


LEAST_SIDE = 9  # rows and columns of the smallest image


def maps_under_conditions(
    mesh: Mesh, channels: Sequence[str], conditions: Conditions, size: Sequence[int]
) -> ViewMaps | None:
    """The conspicuity maps of a normalised mesh from the twelve viewpoints under `conditions`; None without channels.

    size: (rows, columns) of the views when conditions.rows is 1; maps have a quarter of them. The renderer
    `raster` gives the same bytes on every machine.
    """
    if not channels:
        return None
    size = tuple(max(round(conditions.rows * side), LEAST_SIDE) for side in size)
    share = max(size[0] // REDUCTION, 1), max(size[1] // REDUCTION, 1)
    normals = corner_normals(mesh) if conditions.light else np.zeros((0, 3, 3))
    by_view, masks = [], []
    for viewpoint in TWELVE:
        view = render(mesh, viewpoint, size, "raster")
        if conditions.light:
            view = relit(mesh, view, conditions.light, normals)
        if conditions.background:  # rendered black
            view.rgb[~view.mask] = round(255 * conditions.background)
        by_view.append(conspicuity(mesh, view, channels, share, conditions.filled))
        masks.append(mask_at_size(view.mask, share))
    maps = {channel: np.stack([maps[channel] for maps in by_view]) for channel in channels}
    return ViewMaps(mesh, TWELVE, maps, np.stack(masks))


def corner_normals(mesh: Mesh) -> np.ndarray:
    """(m, 3, 3): the shading normal at each corner of each face."""
    groups, normals = corner_groups(mesh)
    return normals[groups]


def relit(mesh: Mesh, view: View, degrees: float, normals: np.ndarray) -> View:
    """The view with its light `degrees` off the camera, up and to the left, without cast shadows.

    The renderers have a head light alone, so the pixels are shaded again by the renderers' own `shade`. normals:
    corner_normals(mesh). At 0 degrees the colours are as rendered.
    """
    right, up, back = view.viewpoint.axes
    angle = np.radians(degrees)
    light = np.cos(angle) * back + np.sin(angle) * (up - right) / np.sqrt(2)
    rows, columns = np.nonzero(view.mask)
    origins, directions = camera.pixel_rays(rows, columns, view.viewpoint, view.mask.shape)
    faces = view.face[rows, columns].astype(np.int64)
    points = origins + view.depth[rows, columns, None].astype(np.float64) * directions
    weights = barycentric(mesh, faces, points).clip(0, 1)
    facing = np.where((mesh.face_crosses @ back < 0)[:, None], -light, light)
    rgb = view.rgb.copy()
    rgb[rows, columns] = shade(mesh, normals, facing, faces, weights)
    return View(rgb, view.depth, view.face, view.viewpoint)

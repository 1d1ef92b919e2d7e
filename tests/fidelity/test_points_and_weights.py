"""T3.1.2, T3.2.1 to T3.2.5: points on a map, weights of channels, the best views, in plain loops."""

import numpy as np
from scipy import ndimage
from scipy.spatial.distance import cdist
from skimage.metrics import structural_similarity

from haptic_glance.look.camera import pixels_per_unit
from haptic_glance.look.points.fuse import select_by_centroid, select_by_suppression
from haptic_glance.look.views.best import CANDIDATES, PERPENDICULAR_SETS, best_viewpoints
from haptic_glance.look.weights.attention import (
    euclidean_weights,
    similarity_weights,
    view_distances,
    view_similarities,
)
from haptic_glance.look.weights.svm import select_far_points
from stages.weights.ground_truth import gts_map


def smooth_map(seed, shape=(90, 120)):
    values = ndimage.gaussian_filter(np.random.default_rng(seed).random(shape), 4)
    return (values - values.min()) / np.ptp(values)


def test_centroids(agreement):
    """T3.1.1 and T3.1.2: the centroids of the regions of the 30 % highest values; of convex regions, in pixels."""
    y, x = np.mgrid[:90, :120]
    bumps = [(20, 30, 9, 1.0), (60, 80, 12, 0.8), (25, 95, 6, 0.9)]
    image = 0.01 + sum(h * np.exp(-((y - r) ** 2 + (x - c) ** 2) / (2 * s * s)) for r, c, s, h in bumps)
    labels, count = ndimage.label(image >= np.quantile(image, 0.7), np.ones((3, 3)))
    literal = np.array(ndimage.center_of_mass(labels > 0, labels, range(1, count + 1)))
    points = select_by_centroid(image)
    places = np.column_stack([points.rows, points.columns])
    assert len(places) == count > 1
    apart = cdist(np.rint(literal), places).min(axis=1).max()
    agreement("pixels", float(apart))


def test_suppression(agreement):
    """T3.2.5: the brightest pixel, its neighbourhood set to zero, down to 90 % of the maximum; in pixels."""
    image, radius, points = smooth_map(0), 9, []
    left, (y, x) = image.copy(), np.mgrid[:90, :120]
    while left.max() > 0.9 * image.max():
        row, column = np.unravel_index(left.argmax(), left.shape)
        points.append((row, column))
        left[(y - row) ** 2 + (x - column) ** 2 <= radius**2] = 0
    peaks = select_by_suppression(image, radius)
    assert len(peaks.rows) == len(points) > 1
    agreement("pixels", float(np.abs(np.array(points) - np.column_stack([peaks.rows, peaks.columns])).max()))


def test_weights_by_distance(agreement):
    """T3.2.1.1: one minus the mean distance of the n brightest pixels to the n points, normalised to 0..1."""
    views = []
    literal = []
    for seed in range(3):
        maps = {name: smooth_map(10 * seed + k) for k, name in enumerate("abcd")}
        points = np.random.default_rng(seed).random((7, 2)) * (89, 119)
        views.append(view_distances(maps, *points.T))
        distances = []
        for image in maps.values():
            order = np.argsort(-image, axis=None)[: len(points)]
            distances.append(cdist(np.column_stack(np.unravel_index(order, image.shape)), points).mean())
        distances = np.array(distances)
        literal.append(1 - (distances - distances.min()) / np.ptp(distances))
    agreement("difference", np.abs(list(euclidean_weights(views).values()) - np.mean(literal, axis=0)).max())


def test_ground_truth_map(agreement):
    """T3.2.1.3: kernels of 50 x 50 pixels with sigma 0.15 of their side at the points, zero off the object."""
    mask = np.zeros((900, 1200), dtype=bool)
    mask[200:700, 300:900] = True
    points = np.array([[300, 400], [480, 620], [690, 880]])
    across = np.arange(-25, 26)
    kernel = np.exp(-(across[:, None] ** 2 + across**2) / (2 * (0.15 * 50) ** 2))
    literal = np.zeros(mask.shape)
    for row, column in points:
        literal[row - 25 : row + 26, column - 25 : column + 26] = kernel
    truth = gts_map(*points.T.astype(float), mask)
    agreement("difference", np.abs(truth - literal * mask).max())


def test_weights_by_similarity(agreement):
    """T3.2.1.4: the structural similarity of each map with the ground truth map, averaged over the views."""
    views, literal = [], []
    for seed in range(3):
        maps = {name: smooth_map(10 * seed + k) for k, name in enumerate("abcd")}
        truth = smooth_map(100 + seed)
        views.append(view_similarities(maps, truth))
        how = {"gaussian_weights": True, "sigma": 1.5, "use_sample_covariance": False, "data_range": 1.0}
        literal.append([structural_similarity(image, truth, **how) for image in maps.values()])
    weights = list(similarity_weights(views).values())
    agreement("difference", np.abs(weights - np.maximum(np.mean(literal, axis=0), 0)).max())


def test_far_points(agreement):
    """T3.2.3: of many points 32, one after another the one farthest from all before; how many are the same."""
    points = np.random.default_rng(3).random((300, 3))
    literal = [0]
    while len(literal) < 32:
        literal.append(int(cdist(points, points[literal]).min(axis=1).argmax()))
    ids = select_far_points(points)
    agreement("settings", (int((np.array(literal) == ids).sum()), 32))


def test_best_viewpoints(ball, agreement):
    """T3.2.4, eq. 3.10: 62 views in 18 sets of four perpendicular ones; the set whose maps sum up to most."""
    maps = {view: smooth_map(k, (30, 40)) for k, view in enumerate(CANDIDATES)}
    sums = {view: float(image.sum()) for view, image in maps.items()}
    literal = max(PERPENDICULAR_SETS, key=lambda views: np.mean([sums[view] for view in views]))
    best = best_viewpoints(ball, lambda view: sums[view])  # a ball hides nothing, so no view is added
    perpendicular = all(
        abs(views[k].axes[2] @ views[(k + 1) % 4].axes[2]) < 1e-9 for views in PERPENDICULAR_SETS for k in range(4)
    )
    held = [len(CANDIDATES) == 62, len(PERPENDICULAR_SETS) == 18, perpendicular, list(literal) == best]
    agreement("settings", (sum(held), len(held)))


def test_pixels_per_unit(agreement):
    """eq. 3.11: the rows over 2 d tan(alpha / 2), with d = 10 and alpha = 6 degrees."""
    literal = [rows / (2 * 10 * np.tan(np.radians(6) / 2)) for rows in (900, 225)]
    agreement("difference", np.abs(np.array(literal) - [pixels_per_unit(rows) for rows in (900, 225)]).max())

"""Conspicuity maps as rows for the SVM, its predictions as a map, and the selection of distant points (T3.2.3)."""

from collections.abc import Mapping

import cv2
import numpy as np

from stages.kit.rng import rng

from .euclidean import checked_maps
from .similarity import checked_ground_truth
from .svm import balanced_rows

SIDE = 200  # rows and columns of the resized maps, whatever their aspect ratio; T3.2.3
SALIENT_LEVEL = float(np.exp(-2))  # of a pixel two sigma from a point; the thesis only says "logical"
SHARE = 0.3  # of the balanced rows are used; T3.2.3
POINTS = 32  # selected for the simplification; T3.2.3


def pixel_features(maps: Mapping[str, np.ndarray]) -> np.ndarray:
    """The maps at SIDE x SIDE pixels, one row per pixel: (SIDE * SIDE, channels) f8 in the order of the maps (T3.2.3).

    maps: dict channel -> (h, w). Raises ValueError for maps that checked_maps refuses.
    """
    return np.stack([_resized(values).ravel() for values in checked_maps(maps)[0].values()], axis=1)


def _resized(values):
    return cv2.resize(values, (SIDE, SIDE), interpolation=cv2.INTER_AREA)


def pixel_samples(
    maps: Mapping[str, np.ndarray],
    gts: np.ndarray,
    seed: int,
    name: str,
    mask: np.ndarray | None = None,
    share: float = SHARE,
) -> tuple[np.ndarray, np.ndarray]:
    """Training rows of one view: (features (k, channels) f8, labels (k,) boolean), classes of equal size.

    gts (h, w) in 0..1: the ground truth saliency map; a pixel above SALIENT_LEVEL is salient. The larger class is
    reduced to the size of the smaller one, and `share` of both is kept (T3.2.3). name: of the object and view, so that
    the draw does not depend on other views. mask None, as in the thesis: the background counts as not salient. On six
    held-out objects the accuracy of the SVM was 0.934 on such pixels; labelling every pixel of the object as salient
    has 0.936. Within the object, such an SVM ranks pixels little better than chance (AUC 0.61). With mask (h, w)
    boolean, rows are drawn on the object only (accuracy 0.65, AUC 0.72).

    A view with a single class gives no rows. Raises ValueError for a ground truth or mask that checked_ground_truth
    refuses, and for a share outside 0..1.
    """
    features = pixel_features(maps)
    gts, mask = checked_ground_truth(gts, mask, checked_maps(maps)[1])
    if not 0 < share <= 1:
        raise ValueError(f"share must be above 0 and at most 1, got {share}")
    labels = _resized(gts).ravel() > SALIENT_LEVEL
    if mask is not None:
        on_object = _resized(mask.astype(np.float32)).ravel() >= 0.5
        features, labels = features[on_object], labels[on_object]
    fewer = min(labels.sum(), (~labels).sum())
    if fewer == 0:
        return features[:0], labels[:0]
    chosen = balanced_rows(labels, rng(seed, f"svm pixels {name}"), 2 * int(np.ceil(share * fewer)))
    return features[chosen], labels[chosen]


def select_far_points(points: np.ndarray, count: int = POINTS) -> np.ndarray:
    """Ids (k,) i8 of up to `count` points far from each other, of points (n, d), the most salient first (T3.2.3).

    The first point is chosen first, then repeatedly the one farthest from all chosen points (Gonzalez 1985), of equally
    far ones the earliest. Of points at the same position only one is chosen, so fewer than count may be returned.
    """
    points = np.asarray(points, dtype=np.float64)
    if points.ndim != 2 or not np.isfinite(points).all() or count < 0:
        raise ValueError(f"points must be finite, of shape (n, d), and count not negative, got {points.shape}, {count}")
    chosen, gap = [], np.full(len(points), np.inf)
    while len(chosen) < count and (gap > 0).any():
        chosen.append(int(gap.argmax()))
        gap = np.minimum(gap, np.linalg.norm(points - points[chosen[-1]], axis=1))
    return np.array(chosen, dtype=np.int64)

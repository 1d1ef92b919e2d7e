"""Conspicuity maps as rows for the SVM, its answer as a map, and few of its many points (T3.2.3)."""

import cv2
import numpy as np

from stages.kit.rng import rng

from .euclidean import checked_maps
from .similarity import checked_truth
from .svm import balanced_rows

SIDE = 200  # rows and columns that every map is resized to, whatever its aspect; T3.2.3
LEVEL = float(np.exp(-2))  # a pixel is salient within two sigma of a point; the thesis says only "logical"
SHARE = 0.3  # of the balanced rows are used; T3.2.3
FAR = 32  # points are kept for the simplification; T3.2.3


def pixel_features(maps):
    """The maps at SIDE x SIDE pixels, one row a pixel: (SIDE * SIDE, channels) f8 in the order of the maps (T3.2.3).

    maps: dict channel -> (h, w). Raises ValueError for maps that stages.weights.euclidean refuses.
    """
    return np.stack([_resized(values).ravel() for values in checked_maps(maps)[0].values()], axis=1)


def _resized(values):
    return cv2.resize(values, (SIDE, SIDE), interpolation=cv2.INTER_AREA)


def pixel_samples(maps, gts, seed, name, mask=None, share=SHARE):
    """Rows of one view to learn from: (features (k, channels) f8, labels (k,) boolean), classes of equal size.

    gts (h, w) in 0..1: the ground truth saliency map; salient is a pixel above LEVEL. Of the larger class as many are
    drawn as the smaller has, and `share` of both is kept (T3.2.3). name: of the object and view, so that the draw does
    not depend on others. mask None is the thesis's way: the background counts as not salient. On six objects left out
    in turn the SVM was right for 0.934 of such pixels, and so is who only asks whether the pixel is on the object,
    0.936; within the object such an SVM orders pixels little better than chance (AUC 0.61). With mask (h, w) boolean
    rows are drawn on the object alone (accuracy 0.65, AUC 0.72).

    A view without salient pixels, or with nothing else, gives no rows. Raises ValueError for a ground truth or
    mask that stages.weights.similarity refuses, and for a share outside 0..1.
    """
    features = pixel_features(maps)
    gts, mask = checked_truth(gts, mask, checked_maps(maps)[1])
    if not 0 < share <= 1:
        raise ValueError(f"share must be above 0 and at most 1, got {share}")
    labels = _resized(gts).ravel() > LEVEL
    if mask is not None:
        on_object = _resized(mask.astype(np.float32)).ravel() >= 0.5
        features, labels = features[on_object], labels[on_object]
    fewer = min(labels.sum(), (~labels).sum())
    if fewer == 0:
        return features[:0], labels[:0]
    chosen = balanced_rows(labels, rng(seed, f"svm pixels {name}"), 2 * int(np.ceil(share * fewer)))
    return features[chosen], labels[chosen]


def predicted_map(model, maps, mask):
    """What a trained model makes of the maps of one view: (h, w) f8 in 0..1, zero off the object (T3.2.3).

    Predicted at SIDE x SIDE and resized back; above 0.5 lies the binary map of T figure 3.13. maps as pixel_features
    takes them, in the order of the training; mask (h, w) boolean: the object.
    """
    features, (h, w) = pixel_features(maps), checked_maps(maps)[1]
    if np.shape(mask) != (h, w):
        raise ValueError(f"maps are {(h, w)}, mask {np.shape(mask)}: they must agree")
    touched = (_resized(np.asarray(mask, dtype=np.float32)) > 0).astype(np.uint8)
    needed = cv2.dilate(touched, np.ones((3, 3), dtype=np.uint8)).ravel() > 0  # the ones that resizing looks at
    small = np.zeros(SIDE * SIDE)
    small[needed] = model.predict(features[needed])
    return cv2.resize(small.reshape(SIDE, SIDE), (w, h), interpolation=cv2.INTER_LINEAR) * np.asarray(mask, dtype=bool)


def select_far_points(points, count=FAR):
    """Ids (k,) i8 of up to `count` points far from each other, of points (n, d), the most salient first (T3.2.3).

    The first point comes first; then each time the one farthest from all chosen (Gonzalez 1985), of equally far ones
    the earlier. Points at the same place are taken once, so that fewer than count may come back.
    """
    points = np.asarray(points, dtype=np.float64)
    if points.ndim != 2 or not np.isfinite(points).all() or count < 0:
        raise ValueError(f"points must be finite, of shape (n, d), and count not negative, got {points.shape}, {count}")
    chosen, gap = [], np.full(len(points), np.inf)
    while len(chosen) < count and (gap > 0).any():
        chosen.append(int(gap.argmax()))
        gap = np.minimum(gap, np.linalg.norm(points - points[chosen[-1]], axis=1))
    return np.array(chosen, dtype=np.int64)

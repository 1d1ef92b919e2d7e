"""The support vector machine of T3.2.3: classifies pixels as salient or not by their nine conspicuities.

As in the thesis, classes are balanced by dropping rows of the larger one, features are weighted by their information
gain, and the kernel is Gaussian. Additions: the number of rows is limited, and models are stored as plain arrays.

Information gain considers one feature at a time. If the label depends only on a combination of features (an exact
XOR), the gains are due to chance.
"""

from collections.abc import Mapping
from dataclasses import dataclass, fields

import numpy as np
from scipy import special

from haptic_glance.base.lazy import cv2
from haptic_glance.base.rng import rng

from .attention import checked_ground_truth, checked_maps

BINS = 10  # of equal counts, to estimate the information gain from
MAX_ROWS = 1000  # per model: cost grows with their square, and 3,000 add less than 0.01 to the AUC on held-out objects
ENTRIES = 2**16  # of the kernel matrix that predict holds at a time: 512 kB, which a core's cache holds


@dataclass(frozen=True, eq=False)
class SVMModel:
    """A trained SVM as plain arrays: s support vectors of c features.

    center, scale (c,): features are scaled as (features - center) * scale; gains (c,) in bits, 0 for an unused feature;
    support (s, c), scaled; dual (s,); intercept and gamma, of shape ().
    """

    center: np.ndarray
    scale: np.ndarray
    gains: np.ndarray
    support: np.ndarray
    dual: np.ndarray
    intercept: np.ndarray
    gamma: np.ndarray

    def predict(self, features: np.ndarray) -> np.ndarray:
        """The saliency of each row of features (k, c): (k,) f8 in 0..1, above 0.5 if classified as salient.

        (1 + tanh f) / 2 of the decision function f, which keeps the order of f and maps the margins to 0.12 and 0.88.
        It is not a probability. Raises ValueError for another number of features or NaN.
        """
        features = _checked_features(features)
        if features.shape[1] != len(self.center):
            raise ValueError(f"this model needs {len(self.center)} features per row, got {features.shape[1]}")
        scaled = (features - self.center) * self.scale
        # The exponent -gamma |x - s|^2 of all pairs as one product of matrices.
        ours = np.column_stack([scaled, np.ones(len(scaled)), -self.gamma * (scaled**2).sum(axis=1)])
        square = -self.gamma * (self.support**2).sum(axis=1)
        theirs = np.column_stack([2 * self.gamma * self.support, square, np.ones(len(square))]).T
        step, decision = max(ENTRIES // max(len(square), 1), 1), np.empty(len(ours))
        for k in range(0, len(ours), step):
            exponents = ours[k : k + step] @ theirs
            decision[k : k + step] = np.exp(exponents, out=exponents) @ self.dual + self.intercept
        return (1 + np.tanh(decision)) / 2

    def to_arrays(self) -> dict[str, np.ndarray]:
        """dict name -> array, for an .npz."""
        return {field.name: getattr(self, field.name) for field in fields(self)}

    @classmethod
    def from_arrays(cls, arrays: Mapping[str, np.ndarray]) -> "SVMModel":
        """The model of a dict of to_arrays; other names are ignored. ValueError if a name is missing."""
        missing = [field.name for field in fields(cls) if field.name not in arrays]
        if missing:
            raise ValueError(f"these arrays are not an SVM model: {', '.join(missing)} missing")
        return cls(**{field.name: np.asarray(arrays[field.name], dtype=np.float64) for field in fields(cls)})


def fit_svm(features: np.ndarray, labels: np.ndarray, seed: int, max_rows: int = MAX_ROWS) -> SVMModel:
    """An SVMModel trained on features (k, c) and labels (k,), true for salient (T3.2.3).

    The larger class is reduced to the size of the smaller one, and both to `max_rows` rows in total, drawn by the seed.
    Features are scaled to unit deviation times their information gain. gamma is one over their total variance, and C is
    1 (scikit-learn's gamma="scale"; the thesis states neither). If no feature has any gain, every row gets 0.5.

    Raises ValueError for NaN, unequal lengths, a single class, or `max_rows` below 2.
    """
    features, labels = checked_rows(features, labels, max_rows)
    rows = balanced_rows(labels, rng(seed, "svm"), max_rows)
    return fit_rows(features[rows], labels[rows])


def fit_rows(features: np.ndarray, labels: np.ndarray) -> SVMModel:
    """An SVMModel trained on exactly these rows, otherwise as fit_svm."""
    from sklearn.svm import SVC  # takes half a second to import, and is not needed to read a model

    gains = information_gains(features, labels)
    spread = features.std(axis=0)
    scale = np.divide(gains, spread, out=np.zeros_like(gains), where=spread > 0)
    center = features.mean(axis=0)
    if not scale.any():
        no_support = np.zeros((0, len(scale)))
        return SVMModel(center, scale, gains, no_support, np.zeros(0), np.array(0.0), np.array(1.0))
    scaled = (features - center) * scale
    gamma = 1 / scaled.var(axis=0).sum()
    svc = SVC(kernel="rbf", gamma=gamma, cache_size=100).fit(scaled, labels)
    return SVMModel(center, scale, gains, svc.support_vectors_, svc.dual_coef_[0], svc.intercept_[0], np.array(gamma))


def information_gains(features: np.ndarray, labels: np.ndarray) -> np.ndarray:
    """(c,) the information gain of each feature about a label in bits, at least 0 (Quinlan 1986; T3.2.3).

    The values of features (k, c) are divided into bins of equal counts, and a value that fills a bin is its only one;
    labels (k,) are boolean. The gain of a constant is 0. The bias due to bins of few rows is subtracted as in Miller
    1955: (bins - 1) / (2 k ln 2) bits.
    """
    features, labels = np.asarray(features), np.asarray(labels, dtype=bool)
    k, c = features.shape
    cuts = np.quantile(features, np.arange(1, BINS) / BINS, axis=0)[:, None]
    bins = (features > cuts).sum(axis=0) + (features >= cuts).sum(axis=0) + (2 * BINS - 1) * np.arange(c)
    rows, salient = (
        np.bincount(bins[subset].ravel(), minlength=c * (2 * BINS - 1)).reshape(c, -1)
        for subset in (slice(None), labels)
    )
    within = (rows * _entropy(salient / np.maximum(rows, 1))).sum(axis=1) / k
    bias = ((rows > 0).sum(axis=1) - 1) / (2 * k * np.log(2))
    return np.maximum(_entropy(labels.mean()) - within - bias, 0.0)


def _entropy(share):
    """Entropy in bits of a binary variable with this share."""
    return special.entr(share) / np.log(2) + special.entr(1 - share) / np.log(2)


def balanced_rows(labels: np.ndarray, generator: np.random.Generator, max_rows: int) -> np.ndarray:
    """Ids of rows, in order: as many of each class as the smaller has, at most `max_rows` in total (T3.2.3).

    Raises ValueError when a class is missing.
    """
    classes = [np.flatnonzero(labels), np.flatnonzero(~labels)]
    count = min(len(classes[0]), len(classes[1]), max_rows // 2)
    if count == 0:
        raise ValueError(f"{len(classes[0])} of {len(labels)} rows are salient: an SVM needs rows of both classes")
    return np.sort(np.concatenate([generator.choice(ids, count, replace=False) for ids in classes]))


def _checked_features(features):
    features = np.asarray(features, dtype=np.float64)
    if features.ndim != 2 or not np.isfinite(features).all():
        raise ValueError(f"features must be finite, of shape (rows, channels), got {features.shape}")
    return features


def checked_rows(features: np.ndarray, labels: np.ndarray, max_rows: int) -> tuple[np.ndarray, np.ndarray]:
    """(features (k, c) f8, labels (k,) boolean); ValueError as fit_svm."""
    features, labels = _checked_features(features), np.asarray(labels)
    if labels.shape != features.shape[:1] or labels.dtype != bool:
        raise ValueError(f"labels must be {len(features)} booleans, got {labels.dtype} of shape {labels.shape}")
    if max_rows < 2:
        raise ValueError(f"max_rows must be at least 2, one row per class, got {max_rows}")
    return features, labels


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
    rows = balanced_rows(labels, rng(seed, f"svm pixels {name}"), 2 * int(np.ceil(share * fewer)))
    return features[rows], labels[rows]


def select_far_points(points: np.ndarray, count: int = POINTS) -> np.ndarray:
    """Ids (k,) i8 of up to `count` points far from each other, of points (n, d), the most salient first (T3.2.3).

    The first point is chosen first, then repeatedly the one farthest from all chosen points (Gonzalez 1985), of equally
    far ones the earliest. Of points at the same position only one is chosen, so fewer than count may be returned.
    """
    points = np.asarray(points, dtype=np.float64)
    if points.ndim != 2 or not np.isfinite(points).all() or count < 0:
        raise ValueError(f"points must be finite, of shape (n, d), and count not negative, got {points.shape}, {count}")
    ids, gap = [], np.full(len(points), np.inf)
    while len(ids) < count and (gap > 0).any():
        ids.append(int(gap.argmax()))
        gap = np.minimum(gap, np.linalg.norm(points - points[ids[-1]], axis=1))
    return np.array(ids, dtype=np.int64)

"""A support vector machine that tells salient pixels from the rest by their nine conspicuities (T3.2.3).

The thesis's recipe: classes balanced by dropping rows of the larger one, features weighted by their information gain,
a Gaussian kernel. Own additions: rows are capped, and nothing of scikit-learn is stored, only arrays.

Information gain looks at one feature at a time. Of a rule that no feature alone betrays (an exact XOR) it sees
nothing, and weighs by chance.
"""

from dataclasses import dataclass, fields

import numpy as np

from stages.kit.rng import rng

BINS = 10  # of equal counts, to estimate the information gain from
MOST = 1000  # rows a model: the cost grows with their square, and 3,000 gain under 0.01 in AUC on objects left out
ENTRIES = 2**20  # of the kernel matrix held at once by predict: 8 MB


@dataclass(frozen=True, eq=False)
class Model:
    """A trained SVM as plain arrays: s support vectors of c features.

    center, scale (c,): features are compared as (features - center) * scale; gains (c,) in bits, 0 of a feature that
    has no say; support (s, c), so scaled; dual (s,); intercept and gamma, of shape ().
    """

    center: np.ndarray
    scale: np.ndarray
    gains: np.ndarray
    support: np.ndarray
    dual: np.ndarray
    intercept: np.ndarray
    gamma: np.ndarray

    def predict(self, features):
        """How salient each row of features (k, c) is: (k,) f8 in 0..1, above 0.5 where the SVM says salient.

        (1 + tanh f) / 2 of the decision function f, so that rows keep f's order and the margins lie at 0.12 and 0.88;
        no probability. Raises ValueError for another number of features or NaN.
        """
        features = _checked_features(features)
        if features.shape[1] != len(self.center):
            raise ValueError(f"this model knows {len(self.center)} features a row, got {features.shape[1]}")
        step = max(ENTRIES // max(len(self.support), 1), 1)
        parts = [self._decision(features[k : k + step]) for k in range(0, len(features), step)]
        return (1 + np.tanh(np.concatenate(parts or [np.zeros(0)]))) / 2

    def _decision(self, features):
        scaled = (features - self.center) * self.scale
        square = (scaled**2).sum(axis=1)[:, None] + (self.support**2).sum(axis=1) - 2 * scaled @ self.support.T
        return np.exp(-self.gamma * square.clip(0)) @ self.dual + self.intercept

    def to_arrays(self):
        """dict name -> array, for an .npz."""
        return {field.name: getattr(self, field.name) for field in fields(self)}

    @classmethod
    def from_arrays(cls, arrays):
        """The model that to_arrays gave away; other names in the dict are left alone. ValueError for one missing."""
        missing = [field.name for field in fields(cls) if field.name not in arrays]
        if missing:
            raise ValueError(f"these arrays are no SVM model: {', '.join(missing)} missing")
        return cls(**{field.name: np.asarray(arrays[field.name], dtype=np.float64) for field in fields(cls)})


def fit_svm(features, labels, seed, most=MOST):
    """A Model trained on features (k, c) and labels (k,), true for salient (T3.2.3).

    The larger class is cut down to the smaller one, both to `most` rows in all, drawn by the seed. Features are
    brought to unit deviation, times their information gain; gamma is one over their total variance then, C is 1
    (scikit-learn's gamma="scale"; the thesis names neither). Where no feature has any gain, every row gets 0.5.

    Raises ValueError for NaN, unequal lengths, one class alone, or `most` below 2.
    """
    features, labels = checked_rows(features, labels, most)
    chosen = balanced_rows(labels, rng(seed, "svm"), most)
    return fit_rows(features[chosen], labels[chosen])


def fit_rows(features, labels):
    """A Model of just these rows, as fit_svm describes it."""
    from sklearn.svm import SVC  # takes half a second to import, which those who only read a Model need not wait for

    gains = np.array([information_gain(column, labels) for column in features.T])
    spread = features.std(axis=0)
    scale = np.divide(gains, spread, out=np.zeros_like(gains), where=spread > 0)
    center = features.mean(axis=0)
    if not scale.any():
        nothing = np.zeros((0, len(scale)))
        return Model(center, scale, gains, nothing, np.zeros(0), np.array(0.0), np.array(1.0))
    scaled = (features - center) * scale
    gamma = 1 / scaled.var(axis=0).sum()
    svc = SVC(kernel="rbf", gamma=gamma, cache_size=100).fit(scaled, labels)
    return Model(center, scale, gains, svc.support_vectors_, svc.dual_coef_[0], svc.intercept_[0], np.array(gamma))


def information_gain(values, labels):
    """How many bits of a label a value tells, at least 0 (Quinlan 1986; T3.2.3).

    values (k,) are cut into bins of equal counts, a value that fills a bin has it alone; labels (k,) are boolean. A
    constant tells exactly nothing. The chance that bins of few rows look telling is taken off as in Miller 1955:
    (bins - 1) / (2 k ln 2) bits.
    """
    values, labels = np.asarray(values), np.asarray(labels, dtype=bool)
    cuts = np.unique(np.quantile(values, np.arange(1, BINS) / BINS))
    below, upto = (np.searchsorted(cuts, values, side) for side in ("left", "right"))
    bins = np.unique(below + upto, return_inverse=True)[1]
    rows = np.bincount(bins)
    within = (rows * _entropy(np.bincount(bins, labels) / rows)).sum() / len(labels)
    chance = (len(rows) - 1) / (2 * len(labels) * np.log(2))
    return float(max(_entropy(labels.mean()) - within - chance, 0.0))


def _entropy(share):
    """Bits of a coin that shows heads with this share."""
    shares = np.stack([share, 1 - np.asarray(share)])
    return -(shares * np.log2(np.where(shares > 0, shares, 1))).sum(axis=0)


def balanced_rows(labels, generator, most):
    """Ids of rows, in order: as many of each class as the smaller has, at most `most` in all (T3.2.3).

    Raises ValueError when a class is missing.
    """
    classes = [np.flatnonzero(labels), np.flatnonzero(~labels)]
    count = min(len(classes[0]), len(classes[1]), most // 2)
    if count == 0:
        raise ValueError(f"{len(classes[0])} of {len(labels)} rows are salient: an SVM needs rows of both kinds")
    return np.sort(np.concatenate([generator.choice(ids, count, replace=False) for ids in classes]))


def _checked_features(features):
    features = np.asarray(features, dtype=np.float64)
    if features.ndim != 2 or not np.isfinite(features).all():
        raise ValueError(f"features must be finite, of shape (rows, channels), got {features.shape}")
    return features


def checked_rows(features, labels, most):
    """(features (k, c) f8, labels (k,) boolean); ValueError as fit_svm."""
    features, labels = _checked_features(features), np.asarray(labels)
    if labels.shape != features.shape[:1] or labels.dtype != bool:
        raise ValueError(f"labels must be {len(features)} booleans, got {labels.dtype} of shape {labels.shape}")
    if most < 2:
        raise ValueError(f"most must leave room for a row of each class, got {most}")
    return features, labels

"""Selection of features by information gain, before the self-organising map (T4.4.9, T4.4.10)."""

import numpy as np
from scipy.special import rel_entr
from sklearn.base import BaseEstimator, TransformerMixin

KEPT = 20  # features with the most information; the thesis gives no number
DECIMALS = 12  # of a gain
BINS = 10  # equally filled bins of a feature, for its information gain


class MostInformative(TransformerMixin, BaseEstimator):
    """Keeps the features (columns) with the highest information gain about the class, in falling order.

    The gain is the mutual information, in nats, of the class and the feature in ten equally filled bins, whose edges
    are quantiles of the training samples.
    """

    def __init__(self, count: int = KEPT) -> None:
        self.count = count

    def fit(self, samples: np.ndarray, labels: np.ndarray) -> "MostInformative":
        """Fits to samples (k, d), finite, and labels (k,)."""
        samples = np.asarray(samples, dtype=np.float64)
        cuts = np.quantile(samples, np.arange(1, BINS) / BINS, axis=0).T
        parts = [np.searchsorted(cut, column, side="right") for cut, column in zip(cuts, samples.T, strict=True)]
        self.gains_ = mutual_information(np.stack(parts, axis=1), labels)
        # Rounding errors do not rank equal gains.
        self.chosen_ = np.argsort(-self.gains_.round(DECIMALS), kind="stable")[: self.count]
        return self

    def transform(self, samples: np.ndarray) -> np.ndarray:
        """(k, count): the selected columns."""
        return np.asarray(samples, dtype=np.float64)[:, self.chosen_]


def mutual_information(parts: np.ndarray, labels: np.ndarray) -> np.ndarray:
    """(d,) mutual information, in nats, of each column of parts (k, d) i8 in 0..BINS - 1 with the labels (k,)."""
    classes, numbers = np.unique(labels, return_inverse=True)
    columns = np.arange(parts.shape[1])
    cells = (columns * BINS + parts) * len(classes) + numbers[:, None]
    counts = np.bincount(cells.ravel(), minlength=columns.size * BINS * len(classes))
    joint = counts.reshape(-1, BINS, len(classes)) / len(parts)
    independent = joint.sum(axis=2, keepdims=True) * joint.sum(axis=1, keepdims=True)
    return rel_entr(joint, independent).sum(axis=(1, 2))

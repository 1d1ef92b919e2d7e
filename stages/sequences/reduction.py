"""Selection of features by information gain, before the self-organising map (T4.4.9, T4.4.10)."""

import numpy as np
from sklearn.base import BaseEstimator, TransformerMixin
from sklearn.feature_selection import mutual_info_classif

KEPT = 20  # features with the most information; the thesis gives no number
BINS = 10  # equally filled bins of a feature, for its information gain


class MostInformative(TransformerMixin, BaseEstimator):
    """Keeps the features (columns) with the highest information gain about the class, in falling order.

    The gain is the mutual information, in nats, of the class and the feature in ten equally filled bins, whose edges
    are quantiles of the training samples (scikit-learn's mutual information of two discrete variables).
    """

    def __init__(self, count: int = KEPT) -> None:
        self.count = count

    def fit(self, samples: np.ndarray, labels: np.ndarray) -> "MostInformative":
        """Fits to samples (k, d), finite, and labels (k,)."""
        samples = np.asarray(samples, dtype=np.float64)
        cuts = np.quantile(samples, np.arange(1, BINS) / BINS, axis=0).T
        parts = [np.searchsorted(cut, column, side="right") for cut, column in zip(cuts, samples.T, strict=True)]
        self.gains_ = mutual_info_classif(np.stack(parts, axis=1), labels, discrete_features=True)  # type: ignore[arg-type]  # the inferred type is str alone
        self.chosen_ = np.argsort(-self.gains_, kind="stable")[: self.count]
        return self

    def transform(self, samples: np.ndarray) -> np.ndarray:
        """(k, count): the selected columns."""
        return np.asarray(samples, dtype=np.float64)[:, self.chosen_]

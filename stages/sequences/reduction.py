"""From many features to five or so: information gain, z-score, self-organising map, z-score (T4.4.9, T4.4.10)."""

import numpy as np
from sklearn.base import BaseEstimator, TransformerMixin
from sklearn.feature_selection import mutual_info_classif

KEPT = 20  # features with the most information; the thesis gives no number
PARTS = 10  # equally full parts that a feature is cut into to measure its information


class MostInformative(TransformerMixin, BaseEstimator):
    """Keeps the features (columns) that tell most of the class: information gain, the most informative first.

    The gain of a feature, cut into ten equally full parts at the quantiles of the training samples, is how many nats of
    the class's entropy it takes away: scikit-learn's mutual information of two discrete quantities.
    """

    def __init__(self, count=KEPT):
        self.count = count

    def fit(self, samples, labels):
        """Learns from samples (k, d), finite, and labels (k,)."""
        samples = np.asarray(samples, dtype=np.float64)
        cuts = np.quantile(samples, np.arange(1, PARTS) / PARTS, axis=0).T
        parts = [np.searchsorted(cut, column, side="right") for cut, column in zip(cuts, samples.T, strict=True)]
        self.gains_ = mutual_info_classif(np.stack(parts, axis=1), labels, discrete_features=True)
        self.chosen_ = np.argsort(-self.gains_, kind="stable")[: self.count]
        return self

    def transform(self, samples):
        """(k, count) the chosen columns."""
        return np.asarray(samples, dtype=np.float64)[:, self.chosen_]

"""One split, standardised and reduced once for all classifiers."""

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from stages.kit import Stopwatch

from .classifiers import CLASSIFIERS
from .scaling import TRAINING, scaled

VALIDITY = ("train_accuracy", "commonest_share")  # metrics that find a dead classifier


class Answers(NamedTuple):
    """Predictions for the test part, seconds, and the accuracy on the training part where it was asked for."""

    predicted: np.ndarray
    seconds: float
    train_accuracy: float | None

    @property
    def validity(self) -> list[dict]:
        """Rows that find a dead classifier: the accuracy on the training part, the share of the commonest answer."""
        share = np.unique(self.predicted, return_counts=True)[1].max() / len(self.predicted)
        values = zip(VALIDITY, (self.train_accuracy, float(share)), strict=True)
        return [{"metric": metric, "value": value} for metric, value in values]


@dataclass(frozen=True)
class Prepared:
    """The samples (k, d) and object numbers (k,) to train and to test on; seconds: the time to prepare them."""

    train: np.ndarray
    train_truth: np.ndarray
    test: np.ndarray
    test_truth: np.ndarray
    seconds: float

    @classmethod
    def from_split(
        cls,
        samples: np.ndarray,
        truth: np.ndarray,
        parts: tuple[np.ndarray, np.ndarray],
        kind: str = "features",
        scaling: str = TRAINING,
    ) -> "Prepared":
        """Scales and reduces the parts (train, test) of samples (n, d), of a kind and by a scaling of `reduction`."""
        train, test = (samples[part] for part in parts)
        with Stopwatch() as watch:
            train, test = scaled(train, test, kind, scaling)
        return cls(train, truth[parts[0]], test, truth[parts[1]], watch.seconds)

    def predict(self, name: str, random_state: int, with_training: bool = False) -> Answers:
        """The Answers of one classifier; their seconds include the preparation, as if it ran alone.

        with_training: whether it is asked about the training part, too; this takes no part in the seconds.
        """
        with Stopwatch() as watch:
            model = CLASSIFIERS[name](random_state).fit(self.train, self.train_truth)
            predicted = model.predict(self.test)
        right = float((model.predict(self.train) == self.train_truth).mean()) if with_training else None
        return Answers(predicted, self.seconds + watch.seconds, right)

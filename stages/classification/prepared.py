"""One split, standardised and reduced once for all classifiers."""

from dataclasses import dataclass

import numpy as np

from stages.kit import Stopwatch

from .classifiers import CLASSIFIERS, reduction


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
        cls, samples: np.ndarray, truth: np.ndarray, parts: tuple[np.ndarray, np.ndarray], kind: str = "features"
    ) -> "Prepared":
        """Reduces samples (n, d) of a kind of `reduction`, fitted to the first of the parts (train, test) alone."""
        train, test = (samples[part] for part in parts)
        with Stopwatch() as watch:
            for step in reduction(kind):
                train, test = step.fit_transform(train), step.transform(test)
        return cls(train, truth[parts[0]], test, truth[parts[1]], watch.seconds)

    def predict(self, name: str, random_state: int) -> tuple[np.ndarray, float]:
        """(predictions for the test part, seconds) of one classifier, the preparation included as if it ran alone."""
        with Stopwatch() as watch:
            predicted = CLASSIFIERS[name](random_state).fit(self.train, self.train_truth).predict(self.test)
        return predicted, self.seconds + watch.seconds

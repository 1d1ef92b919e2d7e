"""What is believed of an object after some touches."""

from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from .library import Library

SURE = 0.95  # belief in one object at which it is known


@dataclass(frozen=True)
class Belief:
    """log_likelihoods (classes,): sums over the touches so far under each object of the library."""

    library: "Library"
    log_likelihoods: np.ndarray
    touches: int = 0

    def after(self, image: np.ndarray, position: np.ndarray) -> "Belief":
        """The Belief after one more touch: an imprint (rows, cols) of the library's array at a position (3,)."""
        found = self.library.log_likelihoods(np.asarray(image)[None], np.asarray(position)[None])[0]
        return Belief(self.library, self.log_likelihoods + found, self.touches + 1)

    @cached_property
    def values(self) -> np.ndarray:
        """(classes,) probabilities, in the order of the library's names; equal before the first touch."""
        touches = max(self.touches, 1)
        return np.exp(self.library.calibration.log_belief(self.log_likelihoods, touches))

    @property
    def probabilities(self) -> dict[str, float]:
        """{name: probability}, the likeliest first."""
        order = np.argsort(-self.values, kind="stable")
        return {self.library.names[i]: float(self.values[i]) for i in order}

    @property
    def known(self) -> str:
        """The name of the object that is known: its probability is at least SURE; else empty."""
        best = int(self.values.argmax())
        return self.library.names[best] if self.values[best] >= SURE else ""

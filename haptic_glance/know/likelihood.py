"""How likely a picture or a touch is, where an object in a pose predicts another.

The noise of the world is unknown, so that differences have the likelihood of Student's distribution: a few large ones
do not decide alone. The constants were fitted to the classes of Princeton's segmentation benchmark with odd numbers.
"""

from dataclasses import dataclass, replace

import numpy as np

from .pressure_array import PressureArray


@dataclass(frozen=True)
class Likelihood:
    """Weights of the evidence; lengths in diameters of the largest object.

    sight: of the logarithm of one minus the similarity of a picture, at least `sight_least`; grey: of its grey values
    beside its gradients. travel: of a touch's difference in travel, whose scale is `travel_scale`. relief: of the mean
    square difference of imprints as shares of the depth, whose scale is `relief_scale`. repeated: the share of a
    touch's evidence that another one at the same place has told; `repeated_within` how far that reaches, and
    `repeated_anywhere` what any two touches share. astray: the most that a touch takes from the log likelihood, since
    the hand may have met something else.
    """

    sight: float = 34.0
    sight_least: float = 0.01
    grey: float = 0.7
    travel: float = 1.4
    travel_scale: float = 0.02
    relief: float = 5.5
    relief_scale: float = 0.085
    repeated: float = 0.7
    repeated_within: float = 0.3
    repeated_anywhere: float = 0.2
    astray: float = 18.0

    def with_noise(self, array: PressureArray) -> "Likelihood":
        """The Likelihood for an array with noise, whose lengths are in diameters."""
        return replace(
            self,
            travel_scale=float(np.hypot(self.travel_scale, array.travel_noise)),
            relief_scale=float(np.hypot(self.relief_scale, array.relief_noise / array.depth)),
        )

    def of_picture(self, similarities: np.ndarray) -> np.ndarray:
        """(v,) log likelihoods, to a constant, by similarities (2, v) of gradients and grey values."""
        gradients, greys = np.log1p(self.sight_least - similarities)
        return -self.sight * (gradients + self.grey * greys)

    def of_touch(self, travel: np.ndarray, relief: np.ndarray) -> np.ndarray:
        """Log likelihoods, to a constant, by differences of travel and mean square differences of imprints."""
        known = self.travel * np.log1p((travel / self.travel_scale) ** 2)
        known = known + self.relief * np.log1p(relief / self.relief_scale**2)
        return -np.minimum(known, self.astray)

    def weight(self, distances: np.ndarray) -> np.ndarray:
        """(...) weight of a touch, by its distances (..., touches) to those before."""
        near = np.exp(-distances / self.repeated_within)
        shares = self.repeated_anywhere + (self.repeated - self.repeated_anywhere) * near
        return 1 / (1 + shares.sum(axis=-1))

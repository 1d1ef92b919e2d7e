"""Objects that were never learned: the probability that what was felt is of a known object, or of none.

An unknown object fits the known ones worse the more it is touched. How much worse is learned from the known objects:
each is left out in turn, and is then unknown among the others.
"""

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np
import scipy
from scipy.spatial.transform import Rotation
from scipy.special import expit, log_expit

from haptic_glance.base.rng import rng
from haptic_glance.touch import Surface

if TYPE_CHECKING:
    from .library import Library

NONE = "none of these"  # the answer where the object is not among the known ones
FEWEST = 3  # known objects: two remain where one is left out
MISPLACED = 0.01  # diameters: standard deviation along each axis, of the objects that are touched
OBJECTS, TRIALS, TOUCHES = 24, 2, 8  # that are left out at most, poses of each, and touches in each pose


@dataclass(frozen=True)
class Verifier:
    """Log odds that an object is known: scale weight^growth (fit - expected) + bias.

    fit: the evidence of all touches for the known object and pose that they fit best, over the sum of their weights,
    `weight`. expected: the fit at which nothing is learned.
    """

    scale: float
    growth: float
    expected: float
    bias: float

    def probability(self, fit: float, weight: float) -> float:
        """Probability that the object is known; one half before the first touch."""
        return float(expit(self.log_odds(fit, weight))) if weight > 0 else 0.5

    def log_odds(self, fit: Any, weight: Any) -> Any:
        """Log odds that the object is known; the arguments broadcast."""
        return self.scale * weight**self.growth * (fit - self.expected) + self.bias


def fit_verifier(library: "Library") -> Verifier:
    """The Verifier that tells the known objects of a library from each of them left out, by logistic regression."""
    count = len(library.names)
    if count < FEWEST:
        raise ValueError(f"the answer {NONE!r} (unknown=True) needs {FEWEST} known objects or more, got {count}")
    if NONE in library.names:
        raise ValueError(f"an object is called {NONE!r}, which is the answer where it is unknown: rename it")
    if library.tolerant:
        raise ValueError("unknown=True needs objects of known size at a known place: leave out position and size")
    random = rng(0, "unknown")
    numbers = random.permutation(count)[:OBJECTS].tolist()
    parts = [_trial(library, number, random) for number in numbers for _ in range(TRIALS)]
    fits, weights, known = (np.concatenate(part) for part in zip(*parts, strict=True))
    signs = np.where(known, 1, -1)

    def loss(values):
        return -log_expit(signs * Verifier(*values).log_odds(fits, weights)).mean()

    bounds = [(0.01, 20), (0, 2), (-60, 0), (-10, 10)]
    return Verifier(*scipy.optimize.minimize(loss, [1.0, 1.0, -3.0, 0.0], bounds=bounds, method="L-BFGS-B").x.tolist())


def _trial(library, number, random):
    """(fits, weights, known) after each touch of an object: if it is known, and if it is not."""
    from .library import stand

    turn = Rotation.random(None, random).as_matrix() if library.pose == "any" else None
    degrees = 360 * random.random() if library.pose == "turned" else 0.0
    shift = MISPLACED * library.diameter * random.normal(size=3)
    surface = Surface(stand(library.mesh(library.names[number]), degrees, shift, turn))
    others, belief, rows = library.hypotheses.objects != number, library.belief(), []
    for line in random.permutation(library.grid.lines)[:TOUCHES].tolist():
        approach = library.line(line)
        belief = belief.after(approach, *approach.feel(surface, random))
        weight = sum(touch.weight for touch in belief.touches)
        rows += [(belief.felt.max() / weight, weight, True), (belief.felt[others].max() / weight, weight, False)]
    return tuple(np.array(column) for column in zip(*rows, strict=True))

"""Weights of the conspicuity channels, learned from where people look or mark points (T3.2.1 to T3.2.3)."""

from .fixations import fit_fixations, fixation_density
from .learned_weights import LearnedWeights, read_learned_weights
from .published import METHODS, weights

__all__ = ["METHODS", "LearnedWeights", "fit_fixations", "fixation_density", "read_learned_weights", "weights"]

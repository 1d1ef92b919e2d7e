"""Weights of the conspicuity channels, learned from where people look or mark points (T3.2.1 to T3.2.3)."""

from .attention import fit_fixations, fixation_density
from .weights import METHODS, LearnedWeights, read_learned_weights, weights

__all__ = [
    "LearnedWeights", "METHODS", "fit_fixations", "fixation_density", "read_learned_weights", "weights",
]  # fmt: skip

"""Weights of the conspicuity channels, learned from where people look (T3.2.1 to T3.2.3)."""

from .features import vertex_features
from .fixations import fit_fixations, fixation_density
from .learned import Learned, learned_for
from .published import METHODS, weights

__all__ = [
    "METHODS", "Learned", "fit_fixations", "fixation_density", "learned_for", "vertex_features", "weights",
]  # fmt: skip

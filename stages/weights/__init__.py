"""Weights of the conspicuity channels in the saliency map (T3.2.1, T3.2.2)."""

from .published import METHODS, weights
from .table import chosen_weights, read_weights, weight_table

__all__ = ["METHODS", "chosen_weights", "read_weights", "weight_table", "weights"]

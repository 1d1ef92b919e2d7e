"""Contours followed with the pressure array, blindly and through salient points (T4.4.6).

Public names: gather, draw_pairs, read_sequences, write_sequences, Sequences.
"""

from .files import Sequences, read_sequences, write_sequences
from .gather import gather
from .planes import draw_pairs

__all__ = ["Sequences", "draw_pairs", "gather", "read_sequences", "write_sequences"]

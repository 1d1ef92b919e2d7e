"""Contours followed with the pressure array, blindly and through salient points (T4.4.6).

Public names: draw_pairs, read_sequences, sample_contours, write_sequences, Sequences.
"""

from .files import Sequences, read_sequences, write_sequences
from .planes import draw_pairs
from .sample_contours import sample_contours

__all__ = ["Sequences", "draw_pairs", "read_sequences", "sample_contours", "write_sequences"]

"""Salient points: fuses the channels, selects points and projects them to vertices (T3.1.2, T3.2.5, T3.2.6)."""

from .find import best_viewpoints, compute_maps, detect, find_points, saliency
from .fuse import COMBINATIONS, fuse, select_by_centroid, select_by_suppression
from .methods import METHODS
from .options import Detection

__all__ = [
    "COMBINATIONS", "Detection", "METHODS", "best_viewpoints", "compute_maps", "detect", "find_points", "fuse",
    "saliency", "select_by_centroid", "select_by_suppression",
]  # fmt: skip

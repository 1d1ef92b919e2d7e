"""Salient points: fuse the channels, select points, project them to vertices (T3.1.2, T3.2.5, T3.2.6)."""

from .find import compute_maps, detect, find_points, saliency
from .fuse import COMBINATIONS, fuse
from .methods import METHODS
from .options import Detection
from .select import select_by_centroid, select_by_suppression
from .storage import read_points, read_saliency, read_strong_points
from .viewpoints import best_viewpoints

__all__ = [
    "COMBINATIONS", "METHODS", "Detection", "best_viewpoints", "compute_maps", "detect", "find_points", "fuse",
    "read_points", "read_saliency", "read_strong_points", "saliency", "select_by_centroid", "select_by_suppression",
]  # fmt: skip

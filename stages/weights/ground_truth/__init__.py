"""Ground truth: where people looked or marked points, at vertices, spread over the surface, and as maps (T3.2.1.3)."""

from .annotations import annotations_on_vertices
from .fixations import fixation_files, fixations_on_vertices
from .gaze import gaze_on_vertices, match_rows, read_gaze
from .interest_points import read_interest_points
from .maps import gts_map, visible_points
from .source import PUBLISHED, digest, ground_truth_amounts, ground_truth_files, published_files
from .spread import spread_on_surface

__all__ = [
    "PUBLISHED",
    "annotations_on_vertices",
    "fixation_files",
    "fixations_on_vertices",
    "gaze_on_vertices",
    "gts_map",
    "match_rows",
    "read_gaze",
    "read_interest_points",
    "spread_on_surface",
    "ground_truth_amounts",
    "digest",
    "ground_truth_files",
    "published_files",
    "visible_points",
]

"""Rendered views of a mesh from the viewpoints of the thesis, and the choice of the best viewpoints."""

from stages.kit import Viewpoint

from .best import best_viewpoints, hidden_surface
from .candidates import CANDIDATES, PERPENDICULAR_SETS
from .coverage import cumulative_coverage, fewest_views, greedy_views, point_visibility
from .material import Material
from .renderer import render
from .storage import read_view, write_view
from .view import View
from .viewpoints import FOUR, TWELVE, VIEWPOINTS, viewpoint_set

__all__ = [
    "CANDIDATES", "FOUR", "Material", "PERPENDICULAR_SETS", "TWELVE", "VIEWPOINTS", "View", "Viewpoint",
    "best_viewpoints", "cumulative_coverage", "fewest_views", "greedy_views", "hidden_surface", "point_visibility",
    "read_view", "render", "viewpoint_set", "write_view",
]  # fmt: skip

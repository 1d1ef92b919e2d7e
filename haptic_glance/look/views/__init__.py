"""Rendered views of a mesh from the viewpoints of the thesis, and the choice of the best viewpoints."""

from ..camera import Viewpoint
from .best import CANDIDATES, PERPENDICULAR_SETS, best_viewpoints, hidden_surface
from .coverage import cumulative_coverage, fewest_views, greedy_views, point_visibility
from .renderer import render
from .view import Material, View
from .viewpoints import FOUR, TWELVE, VIEWPOINTS, viewpoint_set

__all__ = [
    "CANDIDATES", "FOUR", "Material", "PERPENDICULAR_SETS", "TWELVE", "VIEWPOINTS", "View", "Viewpoint",
    "best_viewpoints", "cumulative_coverage", "fewest_views", "greedy_views", "hidden_surface", "point_visibility",
    "render", "viewpoint_set",
]  # fmt: skip

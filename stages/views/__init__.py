"""Pictures of a mesh, from the viewpoints of the thesis, and the viewpoints worth a picture."""

from stages.kit import Viewpoint

from .best import best_viewpoints, hidden_surface
from .candidates import CANDIDATES, SETS
from .cover import coverage, fewest_views, greedy_views, seen_shares
from .renderer import render
from .storage import read_view, write_view
from .view import View
from .viewpoints import FOUR, TWELVE, VIEWPOINTS, viewpoint_set

__all__ = [
    "CANDIDATES", "FOUR", "SETS", "TWELVE", "VIEWPOINTS", "View", "Viewpoint", "best_viewpoints", "coverage",
    "fewest_views", "greedy_views", "hidden_surface", "read_view", "render", "seen_shares", "viewpoint_set",
    "write_view",
]  # fmt: skip

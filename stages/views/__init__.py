"""Pictures of a mesh, from the viewpoints of the thesis."""

from stages.kit import Viewpoint

from .renderer import render
from .storage import read_view, write_view
from .view import View
from .viewpoints import FOUR, TWELVE, VIEWPOINTS, viewpoint_set

__all__ = ["FOUR", "TWELVE", "VIEWPOINTS", "View", "Viewpoint", "read_view", "render", "viewpoint_set", "write_view"]

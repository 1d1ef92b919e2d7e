"""Conspicuity maps: nine channels of visual attention in a view and on the visible surface (T3.1.1, T3.2)."""

from .channels import CHANNELS, conspicuity
from .facing import facing
from .storage import read_view_maps
from .view_maps import ViewMaps

__all__ = ["CHANNELS", "ViewMaps", "conspicuity", "facing", "read_view_maps"]

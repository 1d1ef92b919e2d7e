"""Conspicuity maps: nine channels of visual attention in a view and on the visible surface (T3.1.1, T3.2)."""

from .channels import CHANNELS, conspicuity
from .cropped_view import facing
from .view_maps import ViewMaps

__all__ = [
    "CHANNELS", "ViewMaps", "conspicuity", "facing",
]  # fmt: skip

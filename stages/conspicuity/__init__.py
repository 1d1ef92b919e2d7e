"""Computes the conspicuity maps of a data set."""

from .storage import read_view_maps

__all__ = ["read_view_maps"]

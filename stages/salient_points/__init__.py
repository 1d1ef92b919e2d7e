"""Finds the salient points of a data set."""

from .storage import read_points, read_saliency, read_strong_points

__all__ = ["read_points", "read_saliency", "read_strong_points"]

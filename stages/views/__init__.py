"""Renders the views of a data set."""

from .storage import read_view, write_view

__all__ = ["read_view", "write_view"]

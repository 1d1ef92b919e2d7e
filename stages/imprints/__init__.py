"""Presses the pressure array on every object."""

from .files import Imprints, read_imprints, write_imprints

__all__ = ["Imprints", "read_imprints", "write_imprints"]

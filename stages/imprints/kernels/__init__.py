"""What the pressure array does a million times a second: compiled kernels on plain arrays."""

from .load import depths_of_loads
from .measure import first_below, measure
from .tree import face_tree

__all__ = ["depths_of_loads", "face_tree", "first_below", "measure"]

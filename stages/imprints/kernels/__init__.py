"""What the pressure array does a million times a second: compiled kernels on plain arrays."""

from .measure import measure
from .tree import face_tree

__all__ = ["face_tree", "measure"]

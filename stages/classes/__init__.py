"""Classes of objects to tell apart by touch, each object with the points that guide the hand (T4.3.2, T4.4.10).

Public names: read_classes, read_object.
"""

from .files import read_classes, read_object

__all__ = ["read_classes", "read_object"]

"""The virtual pressure array: what a flat tactile sensor measures at a point of an object (T4.3)."""

from .distances import CONTACTS, adaptive_distances, distances, distances_at
from .follow import Sequence, contour, follow, follow_many
from .force import forces, gaps_at, press_forces, shear
from .press import normalise, press, press_at, press_many, warm_up
from .quasi_tangent import contour_imprints, quasi_tangent
from .section import SectionCurve, snap_to_surface
from .skin import Layer, Skin, indent
from .surface import Surface, sensor_axes, sensor_normals, touchable

__all__ = [
    "CONTACTS", "Layer", "SectionCurve", "Sequence", "Skin", "Surface", "adaptive_distances", "contour",
    "contour_imprints", "distances", "distances_at", "follow", "follow_many", "forces", "gaps_at", "indent",
    "normalise", "press", "press_at", "press_forces", "press_many", "quasi_tangent", 
    "sensor_axes", "sensor_normals", "shear", "snap_to_surface", "touchable", "warm_up",
]  # fmt: skip

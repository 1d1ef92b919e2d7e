"""The virtual pressure array: what a flat tactile sensor measures at a point of an object (T4.3).

Public names: adaptive_distances, contour, contour_imprints, distances, distances_at, follow, follow_many, forces,
gaps_at, indent, layout_forces, normalise, press, press_at, press_forces, press_many, quasi_tangent, read_imprints,
read_layout, section, sensor_axes, sensor_normals, shear, snap_to_surface, touchable, warm_up, write_imprints, Imprints,
Layer, Layout, SectionCurve, Sequence, Skin, Surface, CONTACTS.
"""

from stages.kit.sensor_axes import sensor_axes

from .adaptive import adaptive_distances
from .contact import CONTACTS
from .distances import distances, distances_at
from .files import Imprints, read_imprints, write_imprints
from .follow import contour, follow, follow_many
from .force import forces, gaps_at, press_forces, shear
from .frame import sensor_normals, touchable
from .layer import Layer
from .layout import Layout, layout_forces, read_layout
from .press import normalise, press, press_at, press_many
from .quasi_tangent import contour_imprints, quasi_tangent
from .section import SectionCurve, section
from .sequence import Sequence
from .skin import Skin, indent
from .snap_to_surface import snap_to_surface
from .surface import Surface
from .warm_up import warm_up

__all__ = [
    "CONTACTS",
    "Imprints",
    "Layer",
    "Layout",
    "SectionCurve",
    "Sequence",
    "Skin",
    "Surface",
    "adaptive_distances",
    "contour",
    "contour_imprints",
    "distances",
    "distances_at",
    "follow",
    "follow_many",
    "forces",
    "gaps_at",
    "indent",
    "layout_forces",
    "normalise",
    "press",
    "press_at",
    "press_forces",
    "press_many",
    "quasi_tangent",
    "read_imprints",
    "read_layout",
    "section",
    "sensor_axes",
    "sensor_normals",
    "shear",
    "snap_to_surface",
    "touchable",
    "warm_up",
    "write_imprints",
]

"""The virtual pressure array: what a flat tactile sensor measures at a point of an object (T4.3).

Public names: adaptive_distances, contour, contour_imprints, distances, distances_at, follow, follow_many, indent,
normalise, press, press_at, press_many, quasi_tangent, read_imprints, section, sensor_axes, sensor_normals,
snap_to_surface, touchable, warm_up, write_imprints, Imprints, SectionCurve, Sequence, Skin, Surface, CONTACTS.
"""

from .adaptive import adaptive_distances
from .contact import CONTACTS
from .distances import distances, distances_at
from .files import Imprints, read_imprints, write_imprints
from .follow import contour, follow, follow_many
from .frame import sensor_axes, sensor_normals, touchable
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
    "indent",
    "normalise",
    "press",
    "press_at",
    "press_many",
    "quasi_tangent",
    "read_imprints",
    "section",
    "sensor_axes",
    "sensor_normals",
    "snap_to_surface",
    "touchable",
    "warm_up",
    "write_imprints",
]

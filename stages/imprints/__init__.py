"""The virtual pressure array: what a flat tactile sensor feels at a point of an object (T4.3).

Public names: press, press_many, distances, normalise, sensor_axes, touchable, read_imprints, write_imprints, Imprints.
"""

from .distances import distances
from .files import Imprints, read_imprints, write_imprints
from .frame import sensor_axes, sensor_normals, touchable
from .press import normalise, press, press_many

__all__ = [
    "Imprints",
    "distances",
    "normalise",
    "press",
    "press_many",
    "read_imprints",
    "sensor_axes",
    "sensor_normals",
    "touchable",
    "write_imprints",
]

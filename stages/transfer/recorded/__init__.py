"""Readers of recorded touches for networks: one data set per file, with Recorded as their common result."""

from .bigs import read_bigs
from .grasps import grasp_images
from .pressure import pressure_images
from .schunk import read_schunk
from .touches import Recorded
from .vitac import read_vitac
from .vt60 import read_vt60

__all__ = ["Recorded", "grasp_images", "pressure_images", "read_bigs", "read_schunk", "read_vitac", "read_vt60"]

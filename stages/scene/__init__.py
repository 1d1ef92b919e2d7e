"""Scenes: the fewest faces that each object needs at each distance, with every rendered frame within a tolerance."""

from .budget import budget
from .camera import Camera, fly
from .frames import Frames
from .levels import Plan
from .lod_chain import Level, build_lod_chain
from .place import Placed, Scene

__all__ = ["Camera", "Frames", "Level", "Placed", "Plan", "Scene", "budget", "build_lod_chain", "fly"]

"""Scenes: the fewest faces that each object needs at each distance, with every rendered frame within a tolerance."""

from .budget import budget
from .camera import Camera, fly
from .frames import Frames
from .ladder import Level, build_ladder
from .levels import Plan
from .place import Placed, Scene

__all__ = ["Camera", "Frames", "Level", "Placed", "Plan", "Scene", "budget", "build_ladder", "fly"]

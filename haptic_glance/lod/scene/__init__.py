"""Scenes: the fewest faces that each object needs at each distance, with every rendered frame within a tolerance."""

from .budget import budget
from .camera import Camera, Placed, Scene, fly
from .chain import Level, build_lod_chain
from .frames import Frames, Plan

__all__ = [
    "Camera", "Frames", "Level", "Placed", "Plan", "Scene", "budget", "build_lod_chain", "fly",
]  # fmt: skip

"""Knowing by touch: a library of objects learned in seconds, the belief over them, and the most telling next touch.

    library = learn({"cup": cup, "duck": duck})
    exploration = Exploration(library, Surface(cup), rng(0, "cup"))
    name = exploration.finish()

The belief is that of stages.exploration: of beliefs of 95 %, 95 in a hundred are correct.
Public names: Belief, Exploration, Library, known_objects, learn, place_at, primitives, sample_places,
touched.
"""

from .belief import Belief
from .explore import Exploration
from .known import known_objects, primitives
from .library import Library, learn, touched
from .places import place_at, sample_places

__all__ = [
    "Belief",
    "Exploration",
    "Library",
    "known_objects",
    "learn",
    "place_at",
    "primitives",
    "sample_places",
    "touched",
]

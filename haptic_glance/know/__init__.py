"""Knowing objects: a belief that a look and touches share, and the recognition of single imprints (T4.2)."""

from .belief import SURE, Belief, Pose
from .classifiers import CLASSIFIERS, classifier
from .features import FEATURES, confusable, features, similarity
from .joined_touches import concatenate_touches, draw_combinations, touch_map
from .library import Library, learn, stand
from .look_and_touch import Step, touch_until_known
from .objects import known_objects, primitives
from .poses import POSES
from .pressure_array import Approach, PressureArray
from .protocol import evaluate, random_holdout, region_holdout
from .split import SPLITS, split_touches
from .unknown import NONE

__all__ = [
    "Approach", "Belief", "CLASSIFIERS", "FEATURES", "Library", "NONE", "POSES", "Pose", "PressureArray", "SPLITS",
    "SURE", "Step", "classifier", "concatenate_touches", "confusable", "draw_combinations", "evaluate", "features",
    "known_objects", "learn", "primitives", "random_holdout", "region_holdout", "similarity", "split_touches", "stand",
    "touch_map", "touch_until_known",
]  # fmt: skip

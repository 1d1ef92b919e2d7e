"""Recognition by touch: features of an imprint, classifiers, the belief over objects and the next touch (T4.2)."""

from .belief import Calibration, calibrate
from .classifiers import CLASSIFIERS, classifier
from .exploration import Exploration
from .exploration_trial import LIKELIHOODS, SPLITS, Trial, split_touches
from .features import FEATURES, confusable, features, similarity
from .joined_touches import concatenate_touches, draw_combinations, touch_map
from .library import Belief, Library, known_objects, learn, place_at, primitives, sample_places, touched
from .planner import STRATEGIES, explore, stop
from .protocol import evaluate, random_holdout, region_holdout
from .unknown import NONE

__all__ = [
    "Belief", "CLASSIFIERS", "Calibration", "Exploration", "FEATURES", "LIKELIHOODS", "Library", "NONE", "SPLITS",
    "STRATEGIES", "Trial", "calibrate", "classifier", "concatenate_touches", "confusable", "draw_combinations",
    "evaluate", "explore", "features", "known_objects", "learn", "place_at", "primitives",
    "random_holdout", "region_holdout", "sample_places", "similarity", "split_touches", "stop", "touch_map",
    "touched",
]  # fmt: skip

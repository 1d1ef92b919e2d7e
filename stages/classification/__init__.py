"""Recognition by touch: features of an imprint and five classifiers, by the thesis's protocol (T4.2).

Public names: classifier, concatenate_touches, confusable, draw_combinations, evaluate, evaluate_features, features,
random_holdout, region_holdout, similarity, touch_map, CLASSIFIERS, FEATURES.
"""

from .classifiers import CLASSIFIERS, classifier
from .features import FEATURES, features
from .protocol import evaluate, evaluate_features, random_holdout, region_holdout
from .similarity import confusable, similarity
from .touches import concatenate_touches, draw_combinations, touch_map

__all__ = [
    "CLASSIFIERS",
    "FEATURES",
    "classifier",
    "concatenate_touches",
    "confusable",
    "draw_combinations",
    "evaluate",
    "evaluate_features",
    "features",
    "random_holdout",
    "region_holdout",
    "similarity",
    "touch_map",
]

"""Who is it, by touch: features of an imprint and five classifiers, by the thesis's protocol (T4.2).

Public names: CLASSIFIERS, classifier, features, FEATURES, evaluate, evaluate_features; holdout and regions (the two
splits), similarity and shared (of imprints), TouchMap, combine and join (several touches as one sample).
"""

from .classifiers import CLASSIFIERS, classifier
from .features import FEATURES, features
from .protocol import evaluate, evaluate_features, holdout, regions
from .similarity import shared, similarity
from .touches import TouchMap, combine, join

__all__ = [
    "CLASSIFIERS",
    "FEATURES",
    "TouchMap",
    "classifier",
    "combine",
    "evaluate",
    "evaluate_features",
    "features",
    "holdout",
    "join",
    "regions",
    "shared",
    "similarity",
]

"""Who is it, by touch: features of an imprint and five classifiers, by the thesis's protocol (T4.2).

Public names: CLASSIFIERS, classifier, features, FEATURES, evaluate, evaluate_features.
"""

from .classifiers import CLASSIFIERS, classifier
from .features import FEATURES, features
from .protocol import evaluate, evaluate_features

__all__ = ["CLASSIFIERS", "FEATURES", "classifier", "evaluate", "evaluate_features", "features"]

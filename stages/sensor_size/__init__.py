"""The size and resolution that a pressure array needs to classify objects (T4.3.2, figure 4.11).

Public names: choice_repeatability, classifier, evaluate, smallest_sufficient, CLASSIFIERS.
"""

from .classifiers import CLASSIFIERS, classifier
from .protocol import evaluate
from .smallest import choice_repeatability, smallest_sufficient

__all__ = ["CLASSIFIERS", "choice_repeatability", "classifier", "evaluate", "smallest_sufficient"]

"""How large a pressure array must be, and how fine, to tell classes of objects apart (T4.3.2, figure 4.11).

Public names: CLASSIFIERS, classifier, evaluate, smallest_enough, chosen_again.
"""

from .classifiers import CLASSIFIERS, classifier
from .protocol import evaluate
from .smallest import chosen_again, smallest_enough

__all__ = ["CLASSIFIERS", "chosen_again", "classifier", "evaluate", "smallest_enough"]

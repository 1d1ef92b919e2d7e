"""Which class of objects is it, by following a contour: networks and conventional classifiers (T4.4.7 to T4.4.10).

Public names: directions, series, sequence_features, SelfOrganisingMap, ImageNet, NormalNet, classifier.
"""

from .classifiers import classifier
from .contourlet import directions
from .networks import ImageNet, NormalNet
from .series import sequence_features, series
from .som import SelfOrganisingMap

__all__ = ["ImageNet", "NormalNet", "SelfOrganisingMap", "classifier", "directions", "sequence_features", "series"]

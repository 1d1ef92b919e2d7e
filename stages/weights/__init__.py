"""Learns channel weights of a data set, and reads its ground truth."""

from dataclasses import dataclass

COLUMNS = {
    "channel": "channel, or feature of the glance, that the weight is of",
    "area": "where the pixels were drawn: on the `object`, or from the whole `image` as in the thesis",
    "training": "what an SVM is trained on: one_for_all, one_per_object or one_per_viewpoint",
    "validation": "what the folds leave out: pixels, views or objects",
    "deviation": "standard deviation of the accuracy over the folds",
    "background_alone": "accuracy of labelling every pixel of the object as salient",
}


@dataclass
class Params:
    """The weights that the methods `glance` and `glance_any_pose` take, and what the SVMs are trained on."""

    method: str
    svm: str

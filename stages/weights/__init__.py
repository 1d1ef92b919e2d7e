"""Learns channel weights of a data set, and reads its ground truth."""

from dataclasses import dataclass

from stages.engine.settings import setting

COLUMNS = {
    "channel": "channel, or feature of the glance, that the weight is of",
    "area": "where the pixels were drawn: on the `object`, or from the whole `image` as in the thesis",
    "training": "what an SVM is trained on: one_for_all, one_per_object or one_per_viewpoint",
    "validation": "what the folds leave out: pixels, views or objects",
    "deviation": "standard deviation of the accuracy over the folds",
    "background_alone": "accuracy of labelling every pixel of the object as salient",
}


def _method():
    from stages.weights.training import CHOICES

    return CHOICES


def _svm():
    from stages.weights.training import PIXELS

    return PIXELS


@dataclass
class Params:
    """The weights that the methods `glance` and `glance_any_pose` take, and what the SVMs are trained on."""

    method: str = setting(
        "gaze",
        "what `glance` takes: gaze (learned from human gaze) or fixations (learned from this data set)",
        names=_method,
    )
    svm: str = setting(
        "object",
        "what an object's own SVMs are trained on: object (pixels on it) or picture (the whole picture, as in "
        "the thesis)",
        names=_svm,
    )

"""Touches that others recorded: T4.2.4's protocol on a real pressure array, slip and recognition by fingertips."""

from dataclasses import dataclass
from pathlib import Path

from stages.engine.settings import setting

COLUMNS = {
    "classifier": "a name of haptic_glance.know.CLASSIFIERS, or majority: always the commonest answer",
    "scaling": "of pressure images before the classifier: a name of haptic_glance.know.classifiers.SCALINGS",
    "repetition": "number of the random split, or of the drawn set of classes",
    "train": "touches trained on",
    "test": "touches tested on",
    "classes": "number of classes of the set",
    "chosen": "the classes of the set",
    "task": "of grasps: slip (does the object slip) or recognition (which object is it)",
    "palm": "of grasps: direction of the palm, or all",
    "scaled": "of grasps: by mean and deviation of the training part, or each part by its own",
    "components": "of grasps: principal components, or electrodes where there is no reduction",
    "count": "of grasps: grasps tested on",
    "part": "of touches over time: test (the publisher's own test part) or training (held out within the other part)",
    "bins": "of touches over time: parts of equal length that a touch is divided into",
    "parameter": "of touches over time: what the classifier was set to",
    "heard": "of touches over time: share of the touch, from its beginning",
    "cells": "of touches over time: taxels, or cells of an array, that are read",
    "disturbance": "of touches over time: what happens to the test touches: dead taxels, dropped events or jitter",
    "severity": "of the disturbance: share of the taxels or events, or deviation in steps",
}


@dataclass
class Params:
    """Section `recorded` of params.yaml; also what the other stages on recorded touches read."""

    kind: str = setting(
        "",
        "what was recorded: pressure_images, biotac_grasps, vitac, vt60, bigs, schunk or touch_events; "
        "conf/data says so",
    )
    folder: str = setting("", "the folder or zip archive of the recordings")
    repetitions: int = setting(
        20,
        "number of random splits, of random sets of classes, and of foldings for touches over time",
        least=1,
    )

    def path(self, root: Path) -> Path:
        """The folder of the recordings; a relative folder counts from the repository root."""
        return root / Path(self.folder).expanduser()

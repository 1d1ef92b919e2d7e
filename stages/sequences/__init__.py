"""Classification of objects by following a contour: networks and conventional classifiers (T4.4.7 to T4.4.10)."""

from dataclasses import dataclass

COLUMNS = {
    "classifier": "cnn_images, cnn_normals, cnn (the sum of their probabilities), or a name of CONVENTIONAL",
    "repetition": "number of the random split, or of the object of each class that was tested",
    "training": "which of the trainings for these objects",
    "frames": "touches of a sequence",
    "cells": "sensels along each side of an imprint",
    "classes": "number of classes",
    "sequences": "number of sequences, to train and to test",
    "predicted": "the class that `value` sequences of the class `group` were taken for",
    "layer": "a layer of a network, which has `value` parameters",
    "kind": "what it is: Conv3d, ...",
    "output": "the shape of what it gives",
}


@dataclass
class Params:
    """Section `sequences` of params.yaml."""

    repetitions: int
    trainings: int
    image_epochs: int
    normal_epochs: int
    smaller_strategy: str
    smaller: list[str]
    smaller_networks: list[str]

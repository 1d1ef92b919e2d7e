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

    repetitions: int  # random splits of the sequences, 80:20 (T4.4.10); the folds of objects are as many as objects
    trainings: int  # for each fold of objects
    image_epochs: int  # passes of the 3D network over its training sequences (T4.4.8)
    normal_epochs: int  # passes of the 1D network (T4.4.8)
    smaller_strategy: str  # the strategy that fewer frames and smaller imprints are tried on
    smaller: list[str]  # FRAMESxCELLS that kNN and SVM try
    smaller_networks: list[str]  # FRAMESxCELLS that the networks try, which cost a hundred times as much

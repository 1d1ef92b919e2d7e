"""Classification of objects by following a contour: networks and conventional classifiers (T4.4.7 to T4.4.10)."""

from dataclasses import dataclass

from stages.engine.settings import setting

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

    repetitions: int = setting(
        3,
        "random splits of the sequences, 80:20 (T4.4.10); the folds of objects are as many as objects",
        least=1,
    )
    trainings: int = setting(1, "of the classifiers for each fold of unseen objects", least=1)
    image_epochs: int = setting(
        50,
        "maximum passes of the 3D network (T4.4.8); training ends earlier when the loss stops falling",
        least=1,
    )
    normal_epochs: int = setting(
        200,
        "most passes of the 1D network; the thesis's 10, on 12 times as many sequences, make as many steps as 120 here",
        least=1,
    )
    smaller_strategy: str = setting("thesis_ssim", "the strategy that fewer frames and smaller imprints are tried on")
    smaller: list[str] = setting(
        ["13x32", "7x32", "4x32", "25x16", "25x8", "13x16", "7x8"],
        "FRAMESxCELLS that kNN and SVM try",
    )
    smaller_networks: list[str] = setting(
        ["13x32", "25x16", "25x8", "13x8"],
        "FRAMESxCELLS that the networks try, which cost a hundred times as much",
    )

"""Why frozen filters are at chance on a 16 x 16 array in T table 5.3."""

from dataclasses import dataclass

from stages.engine.settings import setting

COLUMNS = {
    "setting": "what differs from `plain`: a name of VARIANTS in stages/coarse_imprints/__main__.py",
    "cells": "sensels a side of the array",
    "weights": "what the network starts from: imagenet or random",
    "size": "pixels a side that the network sees",
    "chance": "one over the number of classes",
    "repetition": "number of the split",
    "learning_rate": "the chosen learning rate",
}


def _variants():
    from stages.coarse_imprints.__main__ import VARIANTS

    return VARIANTS


@dataclass
class Params:
    """Section `coarse_imprints` of params.yaml."""

    variants: list[str] = setting(
        [
            "plain",
            "fine_array",
            "random_weights",
            "three_channels",
            "blocks",
            "settled",
            "size_224",
            "rate_of_table_5_3",
            "rate_of_table_5_4",
            "fine_array_rate_of_table_5_4",
            "fine_array_rate_of_table_5_3",
            "quarter_of_the_touches",
            "noise_0.05",
            "noise_0.2",
            "skin",
            "skin_and_rate",
        ],
        "what differs from `plain`, one thing at a time",
        names=_variants,
    )
    detector: str = setting("thesis_ssim", "which salient points are touched first, one of salient_points.methods")
    touches: int = setting(24, "imprints per object", least=1)
    width: float = setting(0.16, "of every array, in units", above=0)
    repetitions: int = setting(5, "random splits", least=1)
    epochs: int = setting(10, "passes of the final training", least=1)
    search_epochs: int = setting(4, "passes of each tried learning rate", least=1)
    batch: int = setting(16, "images a step", least=1)
    momentum: float = setting(0.9, "of the stochastic gradient descent (T5.3)", least=0, most=1)

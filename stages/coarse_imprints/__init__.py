"""Why frozen filters are at chance on a 16 x 16 array in T table 5.3."""

from dataclasses import dataclass

COLUMNS = {
    "setting": "what differs from `plain`: a name of VARIANTS in stages/coarse_imprints/__main__.py",
    "cells": "sensels a side of the array",
    "weights": "what the network starts from: imagenet or random",
    "size": "pixels a side that the network sees",
    "chance": "one over the number of classes",
    "repetition": "number of the split",
    "learning_rate": "the chosen learning rate",
}


@dataclass
class Params:
    """Section `coarse_imprints` of params.yaml."""

    variants: list[str]
    detector: str
    touches: int
    width: float
    repetitions: int
    epochs: int
    search_epochs: int
    batch: int
    momentum: float

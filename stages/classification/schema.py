"""The settings of the classification stage."""

from dataclasses import dataclass


@dataclass
class Params:
    """Section `classification` of params.yaml."""

    sets: dict[str, list[str]]  # name of the set: its objects, each with imprints in data/imprints
    classifiers: list[str]  # names of stages.classification.CLASSIFIERS
    repetitions: int  # random hold-outs and foldings, the same for every sampling and classifier

"""The settings of the exploration stage."""

from dataclasses import dataclass


@dataclass
class Params:
    """Section `exploration` of params.yaml."""

    sets: list[str]  # names of classification.sets whose objects are explored
    methods: list[str]  # samplings of data/imprints: where the objects were touched
    confidences: list[float]  # belief in one object at which touching stops
    most: int  # touches after which it stops in any case
    repetitions: int  # random hold-outs of places

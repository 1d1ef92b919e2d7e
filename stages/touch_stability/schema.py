"""The settings of the touch_stability stage."""

from dataclasses import dataclass


@dataclass
class Params:
    """Section `touch_stability` of params.yaml."""

    set: str  # the set of classification.sets whose objects are told apart
    method: str  # where they are touched: a method of imprints.methods
    classifiers: list[str]  # names of stages.classification.CLASSIFIERS
    severities: dict[str, list[float]]  # of each perturbation, in its own unit, from mild to harsh
    repetitions: int  # random hold-outs of places

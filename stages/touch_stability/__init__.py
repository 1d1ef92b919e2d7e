"""Breaking points of recognition by touch: sensor errors, moved objects, coarse models, few touches."""

from dataclasses import dataclass

COLUMNS = {
    "features": "imprint: imprints alone; imprint_place: with their positions; imprint_DENOISER: denoised",
    "classifier": "a name of haptic_glance.know.CLASSIFIERS",
    "perturbation": "a name of stages.touch_stability.PERTURBATIONS; none is clean touches",
    "severity": "in the perturbation's own unit; 0 for clean touches",
    "repetition": "number of the random split",
    "chance": "accuracy of guessing",
}


@dataclass
class Params:
    """Section `touch_stability` of params.yaml."""

    set: str  # the set of classification.sets whose objects are recognised
    method: str  # where they are touched: a method of imprints.methods
    classifiers: list[str]  # names of haptic_glance.know.CLASSIFIERS
    severities: dict[str, list[float]]  # of each perturbation, in its own unit, from mild to harsh
    repetitions: int  # random hold-outs of places
    denoisers: list[str]  # what also cleans all touches first: names of stages.touch_stability.denoisers.DENOISERS

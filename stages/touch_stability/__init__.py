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

    set: str
    method: str
    classifiers: list[str]
    severities: dict[str, list[float]]
    repetitions: int
    denoisers: list[str]

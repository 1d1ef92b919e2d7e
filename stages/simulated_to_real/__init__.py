"""How far simulated imprints help to recognise real touches."""

from dataclasses import dataclass

COLUMNS = {
    "training": "what was trained on: simulated, real or both",
    "simulation": "a name of SIMULATIONS in stages/simulated_to_real/__main__.py",
    "aligned": "whether simulated and real features were each scaled by their own mean and deviation",
    "touches": "real touches of each class trained on",
    "repetition": "number of the split",
    "classifier": "a name of haptic_glance.know.CLASSIFIERS",
}


@dataclass
class Params:
    """Section `simulated_to_real` of params.yaml."""

    simulations: list[str]
    simulated: int
    real: list[int]
    repetitions: int

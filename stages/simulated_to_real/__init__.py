"""How far simulated imprints help to recognise real touches."""

from dataclasses import dataclass

from stages.engine.settings import setting

COLUMNS = {
    "training": "what was trained on: simulated, real or both",
    "simulation": "a name of SIMULATIONS in stages/simulated_to_real/__main__.py",
    "aligned": "whether simulated and real features were each scaled by their own mean and deviation",
    "touches": "real touches of each class trained on",
    "repetition": "number of the split",
    "classifier": "a name of haptic_glance.know.CLASSIFIERS",
}


def _simulations():
    from stages.simulated_to_real.__main__ import SIMULATIONS

    return SIMULATIONS


@dataclass
class Params:
    """Section `simulated_to_real` of params.yaml."""

    simulations: list[str] = setting(
        ["array", "resting", "resting_skin", "resting_grain", "resting_small"],
        "ways to press: array, resting, resting_skin, resting_grain, resting_small",
        names=_simulations,
    )
    simulated: int = setting(48, "imprints of each class, shared by its objects", least=1)
    real: list[int] = setting([0, 1, 2, 5, 10, 20], "real touches of each class that are trained on", least=0)
    repetitions: int = setting(20, "splits, each with a run of neighbouring touches held out", least=1)

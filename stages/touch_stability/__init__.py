"""Breaking points of recognition by touch: sensor errors, moved objects, coarse models, few touches."""

from dataclasses import dataclass

from stages.classification import classifier_names
from stages.engine.settings import setting

COLUMNS = {
    "features": "imprint: imprints alone; imprint_place: with their positions; imprint_DENOISER: denoised",
    "classifier": "a name of haptic_glance.know.CLASSIFIERS",
    "perturbation": "a name of stages.touch_stability.PERTURBATIONS; none is clean touches",
    "severity": "in the perturbation's own unit; 0 for clean touches",
    "repetition": "number of the random split",
    "chance": "accuracy of guessing",
}


def _severities():
    from haptic_glance.disturb.touch_disturbances import TOUCH_PERTURBATIONS

    return TOUCH_PERTURBATIONS


def _denoisers():
    from stages.touch_stability.denoisers import DENOISERS

    return DENOISERS


@dataclass
class Params:
    """Section `touch_stability` of params.yaml."""

    set: str = setting("six", "the set of classification.sets whose objects are recognised")
    method: str = setting("glance", "where the objects are touched: a method of imprints.methods")
    classifiers: list[str] = setting(["knn", "svm"], "names of haptic_glance.know.CLASSIFIERS", names=classifier_names)
    severities: dict[str, list[float]] = setting(
        {
            "localisation": [0.01, 0.02, 0.04, 0.08, 0.16],  # units; the array is 0.16 wide
            "sensor_turned": [5.0, 10.0, 20.0, 45.0, 90.0],  # degrees about the normal
            "sensor_leaning": [2.0, 5.0, 10.0, 20.0, 30.0],  # degrees off the normal
            "noise": [0.01, 0.03, 0.1, 0.2, 0.4],  # sigma, share of full scale
            "dead_cells": [0.01, 0.03, 0.1, 0.2, 0.4],  # share of the cells
            "gain": [0.9, 0.8, 0.6, 0.4, 0.2],  # reading per load
            "saturation": [0.9, 0.8, 0.6, 0.4, 0.2],  # highest reading
            "blur": [0.25, 0.5, 1.0, 2.0, 4.0],  # sigma in cells
            "hysteresis": [0.02, 0.05, 0.1, 0.2, 0.4],  # lag, share of full scale
            "object_turned": [10.0, 45.0, 90.0, 180.0],  # degrees about the vertical
            "object_tilted": [5.0, 10.0, 20.0, 45.0, 90.0],  # degrees about a level axis
            "object_larger": [1.1, 1.25, 1.5, 2.0, 3.0],  # times the size
            "object_smaller": [0.9, 0.8, 0.67, 0.5, 0.33],  # times the size
            "coarse_object": [1500.0, 750.0, 400.0, 200.0, 100.0],  # faces of the mesh that is touched
            "coarse_object_soft": [1500.0, 750.0, 400.0, 200.0, 100.0],  # the same, finer where it is salient
            "coarse_model": [1500.0, 750.0, 400.0, 200.0, 100.0],  # faces of the mesh that the touches are learned from
            "coarse_model_soft": [1500.0, 750.0, 400.0, 200.0, 100.0],  # the same, finer where it is salient
            "few_touches": [20.0, 10.0, 5.0, 3.0],  # touches per object to learn from, of 45
        },
        "of each perturbation, in its own unit, from mild to harsh",
        names=_severities,
    )
    repetitions: int = setting(12, "random hold-outs of places", least=1)
    denoisers: list[str] = setting(
        [],
        "filters that also clean all touches first: autoencoder (T6.3), see experiment=denoised",
        names=_denoisers,
    )

"""The registry of perturbations: differences between training and test touches.

To add one, add a function and an entry. The order is that of the figure: placement, sensor, object, model.
"""

from .coarse_mesh import simplified, simplified_by_saliency
from .localisation import localisation
from .object_moved import object_scaled, object_tilted, object_turned
from .perturbation import Perturbation, PerturbedTouches
from .sensor_turned import sensor_leaning, sensor_turned
from .skin import blur, dead_cells, gain, hysteresis, noise, saturation

PERTURBATIONS = {
    "localisation": Perturbation("units beside the place", 0.0, localisation, random_draws=True, moves_positions=True),
    "sensor_turned": Perturbation("degrees about the normal", 0.0, sensor_turned, random_draws=True),
    "sensor_leaning": Perturbation("degrees off the normal", 0.0, sensor_leaning, random_draws=True),
    "noise": Perturbation("sigma, share of full scale", 0.0, noise, random_draws=True),
    "dead_cells": Perturbation("share of the cells", 0.0, dead_cells, random_draws=True),
    "gain": Perturbation("reading per load", 1.0, gain),
    "saturation": Perturbation("highest reading", 1.0, saturation),
    "blur": Perturbation("sigma in cells", 0.0, blur),
    "hysteresis": Perturbation("lag, share of full scale", 0.0, hysteresis),
    "object_turned": Perturbation("degrees about the vertical", 0.0, object_turned, moves_positions=True),
    "object_tilted": Perturbation(
        "degrees about a level axis", 0.0, object_tilted, random_draws=True, moves_positions=True
    ),
    "object_larger": Perturbation("times the size", 1.0, object_scaled, moves_positions=True),
    "object_smaller": Perturbation("times the size", 1.0, object_scaled, moves_positions=True),
    "coarse_object": Perturbation("faces, touched", 4000.0, simplified),
    "coarse_object_soft": Perturbation("faces, touched", 4000.0, simplified_by_saliency),
    "coarse_model": Perturbation("faces, in training", 4000.0, simplified, in_training=True),
    "coarse_model_soft": Perturbation("faces, in training", 4000.0, simplified_by_saliency, in_training=True),
    "few_touches": Perturbation("training touches per object", 45.0, None),
}

__all__ = ["PERTURBATIONS", "PerturbedTouches", "Perturbation"]

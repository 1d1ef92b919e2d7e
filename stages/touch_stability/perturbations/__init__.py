"""The registry of perturbations: what can differ between the touches that are known and those to be recognised.

To add one, add a function and an entry. The order is that of the figure: the hand, the sensor, the object, the model.
"""

from .coarse_mesh import plain, salient_kept
from .localisation import localisation
from .object_moved import object_scaled, object_tilted, object_turned
from .perturbation import Felt, Perturbation
from .sensor_turned import sensor_leaning, sensor_turned
from .skin import blur, dead_cells, gain, hysteresis, noise, saturation

PERTURBATIONS = {
    "localisation": Perturbation("units beside the place", 0.0, localisation, drawn=True, moves=True),
    "sensor_turned": Perturbation("degrees about the normal", 0.0, sensor_turned, drawn=True),
    "sensor_leaning": Perturbation("degrees off the normal", 0.0, sensor_leaning, drawn=True),
    "noise": Perturbation("sigma, share of full scale", 0.0, noise, drawn=True),
    "dead_cells": Perturbation("share of the cells", 0.0, dead_cells, drawn=True),
    "gain": Perturbation("reading per load", 1.0, gain),
    "saturation": Perturbation("highest reading", 1.0, saturation),
    "blur": Perturbation("sigma in cells", 0.0, blur),
    "hysteresis": Perturbation("lag, share of full scale", 0.0, hysteresis),
    "object_turned": Perturbation("degrees about the vertical", 0.0, object_turned, moves=True),
    "object_tilted": Perturbation("degrees about a level axis", 0.0, object_tilted, drawn=True, moves=True),
    "object_larger": Perturbation("times the size", 1.0, object_scaled, moves=True),
    "object_smaller": Perturbation("times the size", 1.0, object_scaled, moves=True),
    "coarse_object": Perturbation("faces, touched", 4000.0, plain),
    "coarse_object_soft": Perturbation("faces, touched", 4000.0, salient_kept),
    "coarse_model": Perturbation("faces, learned from", 4000.0, plain, learned=True),
    "coarse_model_soft": Perturbation("faces, learned from", 4000.0, salient_kept, learned=True),
    "few_touches": Perturbation("touches known an object", 45.0, None),
}

__all__ = ["PERTURBATIONS", "Felt", "Perturbation"]

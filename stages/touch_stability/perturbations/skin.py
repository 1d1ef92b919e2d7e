"""The sensor is not ideal: each perturbation is one property of haptic_glance.touch.Skin."""

from functools import partial

from haptic_glance.touch import Skin

from .perturbation import PerturbedTouches


def _felt(touches, severity, draw, what):
    return PerturbedTouches(Skin(**{what: severity}, seed=draw)(touches.images, touches.name))


noise = partial(_felt, what="noise")
dead_cells = partial(_felt, what="dead")
gain = partial(_felt, what="gain")
saturation = partial(_felt, what="saturation")
blur = partial(_felt, what="blur")
hysteresis = partial(_felt, what="hysteresis")

"""The background, black in the thesis after a trial of black, grey and white (T3.1.5)."""

from .perturbed import Conditions, in_range, same_places

WHAT = "the background's brightness"


def background(mesh, severity, _generator):
    """Another background, which the maps keep out (stages.conspicuity.background)."""
    return same_places(mesh, Conditions(background=in_range(severity, 0, 1, WHAT)))


def background_left_in(mesh, severity, _generator):
    """The background of this brightness left in the image that the maps are made of, as the thesis does it."""
    return same_places(mesh, Conditions(background=in_range(severity, 0, 1, WHAT), filled=False))

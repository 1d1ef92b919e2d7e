"""Smaller images, or the object farther away: in an orthographic image that is one."""

from .perturbed import Conditions, in_range, same_places


def image_size(mesh, severity, _generator):
    """Images of the share `severity` of the rows and columns; maps shrink alike."""
    return same_places(mesh, Conditions(rows=in_range(severity, 0.05, 1, "the share of rows")))

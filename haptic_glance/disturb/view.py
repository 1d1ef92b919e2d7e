"""Disturbances of a rendered view: the background, the light and the size of the image.

T3.1.5 tried black, grey and white backgrounds and chose black. A smaller image of an orthographic view shows an object
that is farther away.
"""

import numpy as np

from haptic_glance.mesh.mesh import Mesh

from .perturbed import Conditions, Perturbed, in_range, under_conditions

SEVERITY = "the background's brightness"


def background(mesh: Mesh, severity: float, _generator: np.random.Generator) -> Perturbed:
    """Another background, which is kept out of the maps (haptic_glance.look.channels.cropped_view)."""
    return under_conditions(mesh, Conditions(background=in_range(severity, 0, 1, SEVERITY)))


def background_left_in(mesh: Mesh, severity: float, _generator: np.random.Generator) -> Perturbed:
    """Another background, left in the image from which the maps are computed, as in the thesis."""
    return under_conditions(mesh, Conditions(background=in_range(severity, 0, 1, SEVERITY), filled=False))


def light(mesh: Mesh, severity: float, _generator: np.random.Generator) -> Perturbed:
    """The head light moves `severity` degrees off the camera, up and to the left in the image."""
    return under_conditions(mesh, Conditions(light=in_range(severity, 0, 180, "degrees off the camera")))


def image_size(mesh: Mesh, severity: float, _generator: np.random.Generator) -> Perturbed:
    """Images with the share `severity` of the rows and columns; the maps shrink by the same factor."""
    return under_conditions(mesh, Conditions(rows=in_range(severity, 0.05, 1, "the share of rows")))

"""The registry of perturbations: changes of an object, or of how it is rendered, that should not change the result.

To add one, add a function to `mesh` or here, and an entry. The disturbances of a rendered view are here.
"""

import numpy as np

from haptic_glance.mesh.mesh import Mesh

from .mesh import (
    clay,
    decimation,
    grey,
    missing_faces,
    noise,
    paint,
    pattern,
    remeshing,
    scale,
    scan,
    tilt,
    turn,
    vertex_order,
    winding,
)
from .perturbed import Conditions, Perturbation, Perturbed, in_range, under_conditions

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


PERTURBATIONS = {
    "noise": Perturbation("sigma, share of the diagonal", 0.0, noise),
    "decimation": Perturbation("share of the faces kept", 1.0, decimation),
    "remeshing": Perturbation("edge length, share of the diagonal", 0.0, remeshing),
    "missing_faces": Perturbation("share of the faces missing", 0.0, missing_faces),
    "scan": Perturbation("degrees between depth cameras", 0.0, scan),
    "vertex_order": Perturbation("share of the vertices shuffled", 0.0, vertex_order),
    "winding": Perturbation("share of the faces turned inwards", 0.0, winding),
    "turn": Perturbation("degrees about the vertical", 0.0, turn),
    "tilt": Perturbation("degrees about a level axis", 0.0, tilt),
    "scale": Perturbation("times the size", 1.0, scale),
    "light": Perturbation("degrees off the camera", 0.0, light),
    "background": Perturbation("brightness, 0 black to 1 white", 0.0, background),
    "background_left_in": Perturbation("brightness, 0 black to 1 white", 0.0, background_left_in),
    "paint": Perturbation("saturation of the colour", 0.0, paint),
    "pattern": Perturbation("saturation of two colours", 0.0, pattern),
    "grey": Perturbation("share of the hue taken away", 0.0, grey),
    "clay": Perturbation("share of the colour taken away", 0.0, clay),
    "image_size": Perturbation("share of the image's rows", 1.0, image_size),
}

__all__ = ["PERTURBATIONS", "Conditions", "Perturbation", "Perturbed"]

"""The registry of perturbations: changes of an object, or of how it is rendered, that should not change the result.

To add one, add a function to `mesh` or `view`, and an entry.
"""

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
from .perturbed import Conditions, Perturbation, Perturbed
from .view import background, background_left_in, image_size, light

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

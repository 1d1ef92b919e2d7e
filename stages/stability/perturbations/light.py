"""Light from the side instead of from the camera."""

from .perturbed import Conditions, in_range, same_places


def light(mesh, severity, _generator):
    """The head light moves `severity` degrees off the camera, up and to the left in the image."""
    return same_places(mesh, Conditions(light=in_range(severity, 0, 180, "degrees off the camera")))

"""All errors of one simplified mesh, each with its cost."""

from haptic_glance.base.timing import Stopwatch
from haptic_glance.lod.errors import surface_errors
from haptic_glance.lod.perceptual import picture_errors, take_pictures
from haptic_glance.look.views import viewpoint_set
from haptic_glance.look.weights.weights import GLANCE
from haptic_glance.mesh.mesh import Mesh

from .inputs import ObjectInputs
from .schema import Params

SALIENCY_METHOD = GLANCE  # its saliency weights the salient error of all methods


def measure_errors(inputs: ObjectInputs, mesh: Mesh, settings: Params, seed: int) -> list[dict]:
    """Parts of rows {metric, value, seconds, note} of one mesh; seconds are those of the call behind the metric."""
    parts = []
    for measure in (_surface, _pictures):
        with Stopwatch() as watch:
            values, note = measure(inputs, mesh, settings, seed)
        for name, value in values.items():
            parts.append({"metric": name, "value": value, "seconds": watch.seconds, "note": note})
    return parts


def _surface(inputs, mesh, settings, seed):
    saliencies = {"salient_error": inputs.saliency.get(SALIENCY_METHOD), "gaze_error": inputs.gaze}
    saliencies = {name: values for name, values in saliencies.items() if values is not None and values.any()}
    errors = surface_errors(inputs.mesh, mesh, saliencies, settings.samples, seed)
    return {name if name in saliencies else f"metro_{name}": value for name, value in errors.items()}, ""


def _pictures(inputs, mesh, settings, _):
    try:
        pictures = take_pictures(mesh, viewpoint_set(settings.viewpoints), tuple(settings.size))
        errors = picture_errors(inputs.pictures, pictures, inputs.analyses)
    except ValueError as error:  # a mesh that leaves the frame
        return {"ssim_error": None}, str(error)
    return {"ssim_error" if name == "ssim" else name: value for name, value in errors.items()}, ""

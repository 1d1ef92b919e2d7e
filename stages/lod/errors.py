"""All errors of one simplified mesh, each with its cost."""

from stages.kit import Stopwatch
from stages.salient_points import METHODS
from stages.views import viewpoint_set

from .metro import surface_errors
from .perceptual import picture_errors, take_pictures

JUDGE = next(iter(METHODS))  # of our models, whose saliency weighs the salient error of all methods: `enhanced`


def errors_of(subject, found, settings, seed):
    """Parts of rows {metric, value, seconds, note} of one mesh; seconds are those of the one call behind the metric."""
    parts = []
    for measure in (_surface, _pictures):
        with Stopwatch() as watch:
            values, note = measure(subject, found, settings, seed)
        for name, value in values.items():
            parts.append({"metric": name, "value": value, "seconds": watch.seconds, "note": note})
    return parts


def _surface(subject, found, settings, seed):
    judges = {"salient_error": subject.saliency.get(JUDGE), "gaze_error": subject.gaze}
    judges = {name: looks for name, looks in judges.items() if looks is not None and looks.any()}
    errors = surface_errors(subject.mesh, found, judges, settings.samples, seed)
    return {name if name in judges else f"metro_{name}": value for name, value in errors.items()}, ""


def _pictures(subject, found, settings, _):
    try:
        pictures = take_pictures(found, viewpoint_set(settings.viewpoints), tuple(settings.size))
        errors = picture_errors(subject.pictures, pictures)
    except ValueError as error:  # a mesh that leaves the frame
        return {"ssim_error": None}, str(error)
    return {"ssim_error" if name == "ssim" else name: value for name, value in errors.items()}, ""

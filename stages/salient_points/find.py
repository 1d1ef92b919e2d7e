"""From a mesh to its saliency and its salient points, in one call each."""

import numpy as np

from stages.conspicuity import Sight, conspicuity
from stages.conspicuity.channels import coverage
from stages.conspicuity.surface_values import SMOOTHING
from stages.meshes import normalise, turn_up
from stages.meshes.orient import orient
from stages.views import TWELVE, render
from stages.weights import Learned
from stages.weights import weights as published

from .methods import MACHINES, method_named
from .options import RADIUS, Options

IMAGE = (900, 1200)  # rows, columns of the views; T3.2.6
MAP = (225, 300)  # rows, columns of the maps: every quarter, so that the channels' scales stay the thesis's


def saliency(mesh, method="enhanced", weights=None, viewpoints=None, smoothing=SMOOTHING, up="z"):
    """How much each vertex draws the eye: (n,) f8 in 0..1, the most salient place 1, for any position and size.

    up: the axis of the mesh that points up, x, y or z (a GLB's is y), since people look at the upper part of things and
    walk around them; `enhanced` and `height` ask for the right one. method: a name of METHODS that has
    a saliency (all but `random` and `farthest`). `enhanced`, the default, is the density of looks that a log-linear
    model learned from human gaze expects, per unit of area; `thesis_ssim` is the thesis's own weighted average (eq.
    3.9), `itti` the classical model. weights: for a method with weights, a name that stages.weights knows or a dict
    name -> weight, instead of its own. viewpoints: Viewpoints, None for the twelve of T figure 3.2. smoothing: units of
    the normalised mesh (bounding sphere 0.5). ValueError for unknown names or bad weights.
    """
    detector = method_named(method)
    if not hasattr(detector, "saliency"):
        raise ValueError(f"method {method!r} has no saliency: it does not look")
    mesh = normalise(turn_up(orient(mesh)[0], up))
    options = Options(_learned(method, weights), smoothing=smoothing)
    return detector.saliency(mesh, look(mesh, detector.channels, viewpoints), options)


def find_points(
    mesh, method="enhanced", count=None, *, weights=None, viewpoints=None, selection="suppression", radius=RADIUS,
    seed=0, name="", up="z",
):  # fmt: skip
    """Vertex ids of the places that draw the eye: (k,) i8, most salient first.

    count: how many; None stops at the method's own threshold (T3.2.5 for maps), and only a mesh with fewer vertices
    gives fewer than asked. selection: of methods that pick in each view, `suppression` (T3.2.5) or `centroid`
    (T3.1.2). radius: the least distance between points, in units of the normalised mesh; it shrinks only where count
    points do not fit. seed and name: for `random` alone, whose draw depends on these two and not on the calls before.
    The rest as in saliency. ValueError for unknown names, a bad count, or `random` or `farthest` without a count.
    """
    detector = method_named(method)
    if count is not None and (count != int(count) or count < 1):
        raise ValueError(f"count must be a whole number of at least 1, got {count}")
    options = Options(_learned(method, weights), selection, radius, SMOOTHING, seed, name)
    mesh = normalise(turn_up(orient(mesh)[0], up))
    return detector.find(mesh, look(mesh, detector.channels, viewpoints), options, count).points


def look(mesh, channels, viewpoints=None, renderer="auto"):
    """Renders a normalised mesh, computes the channels' maps, and returns the Sight; None without channels.

    renderer: of stages.views.render; `raycast` gives the same bytes on every machine.
    """
    if not channels:
        return None
    viewpoints = TWELVE if viewpoints is None else tuple(viewpoints)
    if not viewpoints:
        raise ValueError("no viewpoints: give at least one, or None for the twelve of T figure 3.2")
    found, masks = [], []
    for viewpoint in viewpoints:
        view = render(mesh, viewpoint, IMAGE, renderer)
        found.append(conspicuity(mesh, view, channels, MAP))
        masks.append(coverage(view.mask, MAP))
    maps = {channel: np.stack([maps[channel] for maps in found]) for channel in channels}
    return Sight(mesh, viewpoints, maps, np.stack(masks))


def _learned(method, weights):
    """The published weights, those of the method replaced by what the caller gave."""
    needed, learned = method_named(method).learned, Learned()
    if needed in MACHINES:
        raise ValueError(f"method {method!r} needs an SVM that the stage `weights` trains: run the pipeline for it")
    if weights is None:
        if needed not in {None, *learned.weights}:
            raise ValueError(
                f"method {method!r} needs weights learned by the stage `weights`: give them, or take another"
            )
        return learned
    if needed is None:
        raise ValueError(f"method {method!r} has no weights")
    return Learned(learned.weights | {needed: published(weights) if isinstance(weights, str) else dict(weights)})

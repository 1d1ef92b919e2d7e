"""From a mesh to its saliency and its salient points, in one call each."""

import numpy as np

from stages.conspicuity import Sight, conspicuity
from stages.conspicuity.channels import coverage
from stages.conspicuity.surface_values import SMOOTHING
from stages.meshes import normalise
from stages.views import TWELVE, render
from stages.weights import weights as weights_of

from .methods import method_named
from .options import RADIUS, WEIGHTS, Options

IMAGE = (900, 1200)  # rows, columns of the views; T3.2.6
MAP = (225, 300)  # rows, columns of the maps: every quarter, so that the channels' scales stay the thesis's


def saliency(mesh, method="enhanced", weights=WEIGHTS, viewpoints=None, smoothing=SMOOTHING):
    """How much each vertex draws the eye: (n,) f8 in 0..1, the most salient place 1, for any position and size.

    method: a name of METHODS that has a saliency (all but `random`). weights: for `enhanced`, a name that
    stages.weights knows or a dict channel -> weight. viewpoints: Viewpoints, None for the twelve of T figure 3.2.
    smoothing: units of the normalised mesh (bounding sphere 0.5). The maps of T3.1.1 and T3.2 are fused (eq. 3.8, 3.9)
    and averaged over the views that see a vertex; vertices in no view take their neighbours' values. ValueError for
    unknown names or bad weights.
    """
    detector = method_named(method)
    if not detector.channels:
        raise ValueError(f"method {method!r} has no saliency: it does not look")
    options = Options(_channel_weights(weights), smoothing=smoothing)
    return detector.saliency(look(mesh, detector.channels, viewpoints), options)


def find_points(
    mesh, method="enhanced", count=None, *, weights=WEIGHTS, viewpoints=None, selection="suppression", radius=RADIUS,
    seed=0, name="",
):  # fmt: skip
    """Vertex ids of the places that draw the eye: (k,) i8, most salient first.

    count: how many; None stops at the thesis's threshold (T3.2.5), and only a mesh with fewer vertices gives fewer
    than asked. selection: `suppression` (T3.2.5) or `centroid` (T3.1.2). radius: the least distance between points,
    in units of the normalised mesh; it shrinks only where count points do not fit. seed and name: for `random` alone,
    whose draw depends on these two and not on the calls before. The rest as in saliency. ValueError for unknown
    names, a bad count, or `random` without a count.
    """
    detector = method_named(method)
    if count is not None and (count != int(count) or count < 1):
        raise ValueError(f"count must be a whole number of at least 1, got {count}")
    options = Options(_channel_weights(weights), selection, radius, SMOOTHING, seed, name)
    sight = look(mesh, detector.channels, viewpoints) if detector.channels else None
    return detector.find(normalise(mesh), sight, options, count).points


def look(mesh, channels, viewpoints=None):
    """Renders a mesh, computes the channels' maps, and returns the Sight that the methods work on."""
    mesh = normalise(mesh)
    viewpoints = TWELVE if viewpoints is None else tuple(viewpoints)
    found, masks = [], []
    for viewpoint in viewpoints:
        view = render(mesh, viewpoint, IMAGE)
        found.append(conspicuity(mesh, view, channels, MAP))
        masks.append(coverage(view.mask, MAP))
    maps = {channel: np.stack([maps[channel] for maps in found]) for channel in channels}
    return Sight(mesh, viewpoints, maps, np.stack(masks))


def _channel_weights(weights):
    return weights_of(weights) if isinstance(weights, str) else dict(weights)

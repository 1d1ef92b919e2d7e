"""The best set of viewpoints of a mesh by what its saliency maps show there (T3.2.4)."""

from stages.conspicuity import conspicuity
from stages.conspicuity.channels import known_channels
from stages.views import best_viewpoints as best_set
from stages.views import render
from stages.weights import weights

from .fuse import fuse

IMAGE = (300, 400)  # rows, columns of the 62 looks: a third of the thesis's, since a sum over all pixels is asked alone


def best_viewpoints(mesh, method="thesis_ssim", seed=0):
    """Four to eight Viewpoints: the perpendicular four of 18 sets with the highest level of saliency, and added views.

    mesh: normalised. The level of a view is the sum over its saliency map (T eq. 3.10), fused with the published
    weights named by method (T eq. 3.9). Raises ValueError for an unknown method, one that weighs no channels, or a mesh
    without area.
    """
    chosen = weights(method)
    known_channels(chosen)

    def level(viewpoint):
        view = render(mesh, viewpoint, IMAGE)
        return float(fuse(conspicuity(mesh, view, list(chosen)), chosen).sum())

    return best_set(mesh, level, seed)

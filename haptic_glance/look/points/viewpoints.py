"""The best set of viewpoints of a mesh by what its saliency maps show there (T3.2.4)."""

from haptic_glance.mesh.mesh import Mesh

from ..camera import Viewpoint
from ..channels import conspicuity
from ..channels.channels import check_channels
from ..views import best_viewpoints as best_set
from ..views import render
from ..weights import weights
from .fuse import fuse

VIEW_SIZE = (300, 400)  # rows, columns of the 62 views: a third of the thesis's, enough for a sum over all pixels


def best_viewpoints(mesh: Mesh, method: str = "thesis_ssim", seed: int = 0) -> list[Viewpoint]:
    """Four to eight Viewpoints: of 18 sets of four perpendicular views the most salient one, and added views.

    mesh: normalised. A view's level of saliency is the sum over its saliency map (T eq. 3.10), fused with the published
    weights named by method (T eq. 3.9). Raises ValueError for an unknown method, one that weighs no channels, or a mesh
    without area.
    """
    factors = weights(method)
    check_channels(factors)

    def level(viewpoint: Viewpoint) -> float:
        view = render(mesh, viewpoint, VIEW_SIZE)
        return float(fuse(conspicuity(mesh, view, list(factors)), factors).sum())

    return best_set(mesh, level, seed)

"""The distance of two surfaces weighted by saliency; Metro gives every place the same weight."""

import numpy as np

from stages.kit import Mesh

from .metro import surface_errors


def salient_error(reference: Mesh, mesh: Mesh, saliency: np.ndarray, samples: int = 10_000, seed: int = 0) -> float:
    """Surface distance weighted by the saliency of the reference, over its bounding-box diagonal.

    saliency (n,): 0 or more at each vertex of the reference, for example human gaze spread over the surface, or
    stages.salient_points.saliency; its scale does not matter. Samples are those of `metro`: one on the reference is
    weighted by the saliency there, interpolated within its face; one on the simplified mesh by the saliency at the
    nearest point of the reference. Each direction is a weighted mean, and the larger one is the error, as in Metro.
    Constant saliency gives Metro's mean.

    Raises ValueError for saliency of another length, negative, not finite or zero on the whole surface, where no sample
    has a positive weight, and as `metro` does.
    """
    return surface_errors(reference, mesh, {"salient": saliency}, samples, seed)["salient"]

"""How far two surfaces lie apart where people look: ours, beside Metro, which counts every place alike."""

from .metro import surface_errors


def salient_error(reference, mesh, saliency, samples=10_000, seed=0):
    """Surface distance weighted by the saliency of the reference, over its bounding-box diagonal.

    saliency (n,): 0 or more at each vertex of the reference, for example human gaze spread over the surface, or
    stages.salient_points.saliency; its scale does not matter. Samples are those of `metro`: one on the reference counts
    by the saliency there, interpolated within its face; one on the simplified mesh by the saliency at its nearest point
    of the reference. Each direction is a weighted mean, and the larger one is the error, as in Metro. Equal saliency
    everywhere gives Metro's mean.

    Raises ValueError for saliency of another length, negative, not finite or zero on the whole surface, for too few
    samples to meet it, and as `metro` does.
    """
    return surface_errors(reference, mesh, {"salient": saliency}, samples, seed)["salient"]

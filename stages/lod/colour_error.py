"""How far off the colours of a simplified mesh are from those of the original, where both are painted."""

import numpy as np

from stages.kit import Mesh
from stages.kit.rng import rng

from .nearest import surface_index


def colour_error(reference: Mesh, mesh: Mesh, samples: int = 10_000, seed: int = 0) -> float:
    """Root mean square difference, over the three channels in 0..255, of the colours that two surfaces show.

    At points on either surface, uniform by area, and the nearest points on the other one; the larger of both
    directions, as in `metro`. A mesh with a texture shows its nearest pixel, one without its vertex colours
    interpolated. Raises ValueError for a mesh without either, without area, or fewer than one sample.
    """
    if samples < 1:
        raise ValueError(f"samples must be 1 or more, got {samples}")
    errors = []
    for one, other, name in ((reference, mesh, "reference"), (mesh, reference, "mesh")):
        points, *own = surface_index(one).sample(samples, rng(seed, name))
        index = surface_index(other)
        face = index.nearest(points)[1].astype(np.int64)
        errors.append(((shown(one, *own) - shown(other, face, index.weights(points, face))) ** 2).mean())
    return float(np.sqrt(max(errors)))


def shown(mesh: Mesh, faces: np.ndarray, weights: np.ndarray) -> np.ndarray:
    """(k, 3) colours in 0..255 that a mesh shows at barycentric weights (k, 3) of faces (k,)."""
    if mesh.texture is not None:
        uv = np.einsum("ij,ijk->ik", weights, mesh.texture.uv[faces])
        return mesh.texture.sample(faces, uv).astype(np.float64)
    if mesh.colors is None:
        raise ValueError("the mesh has no colours to compare")
    return np.einsum("ij,ijk->ik", weights, mesh.colors[mesh.faces[faces]].astype(np.float64))

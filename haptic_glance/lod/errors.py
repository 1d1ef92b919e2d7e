"""Errors of a simplified mesh: distances of two surfaces (T3.1.4, T3.2.9.1), weighted by saliency, and of colours."""

from collections.abc import Mapping

import numpy as np

from haptic_glance.base.rng import rng
from haptic_glance.mesh.materials import corner_colours, shown_at_corners
from haptic_glance.mesh.mesh import Mesh
from haptic_glance.mesh.nearest import closest, surface_index


def metro(reference: Mesh, mesh: Mesh, samples: int = 10_000, seed: int = 0) -> dict[str, float]:
    """Symmetric surface distance of two meshes, as shares of the reference's bounding-box diagonal.

    Parameters
    ----------
    reference, mesh : Mesh or any input of `as_mesh`
        The meshes.
    samples : int
        Points on each surface, uniform by area.
    seed : int
        Equal seeds give equal numbers.

    Returns
    -------
    dict of str to float
        `mean`, `rms` and `max`, each the larger of its two directions. `max` is over the samples and the vertices.

    Raises
    ------
    ValueError
        For a mesh without area or fewer than one sample.

    Notes
    -----
    Distances are from points on either surface to the nearest point on the other; the distance of a point is exact. On
    four household objects at a quarter of their faces, 10,000 samples give `mean` within 1 % and `rms` within 1.5 %
    (one standard deviation), 1,000 samples within 4 and 8 %. `max` is a lower bound, 0.86 to 1 times that of 400,000
    samples.

    References
    ----------
    Cignoni, Rocchini and Scopigno, Metro: measuring error on simplified surfaces, Computer Graphics Forum 17(2), 1998
    (T [224]).

    Examples
    --------
    >>> import trimesh
    >>> from haptic_glance import metro
    >>> ball = trimesh.creation.icosphere(2)
    >>> metro(ball, ball)["max"] < 1e-9
    True
    """
    return surface_errors(reference, mesh, samples=samples, seed=seed)


def surface_errors(
    reference: Mesh, mesh: Mesh, saliencies: Mapping[str, np.ndarray] | None = None, samples: int = 10_000,
    seed: int = 0,
) -> dict[str, float]:  # fmt: skip
    """All surface errors from one sampling and one search: dict(mean, rms, max), see `metro`.

    saliencies: dict name -> (n,), 0 or more at each vertex of the reference; each adds an error weighted by it, under
    its name, see `salient_error`.
    """
    if samples < 1:
        raise ValueError(f"samples must be 1 or more, got {samples}")
    saliencies = {name: _checked(values, reference) for name, values in (saliencies or {}).items()}
    ours, theirs = surface_index(reference), surface_index(mesh)
    forth, back = ours.sample(samples, rng(seed, "reference")), theirs.sample(samples, rng(seed, "mesh"))
    to_mesh, _ = theirs.nearest(forth[0])
    to_reference, faces = ours.nearest(back[0])
    largest = theirs.farthest(ours, to_mesh.max())
    largest = ours.farthest(theirs, max(largest, to_reference.max()))
    errors = {
        "mean": max(to_mesh.mean(), to_reference.mean()),
        "rms": np.sqrt(max((to_mesh**2).mean(), (to_reference**2).mean())),
        "max": largest,
    }
    places = [(forth[1], forth[2]), (faces, ours.weights(back[0], faces))] if saliencies else []
    for name, values in saliencies.items():
        weights = [np.einsum("ij,ij->i", corners, values[reference.faces[face]]) for face, corners in places]
        errors[name] = _weighted(weights, (to_mesh, to_reference))
    return {name: float(error / ours.diagonal) for name, error in errors.items()}


def vertex_errors(reference: Mesh, mesh: Mesh) -> np.ndarray:
    """(n,) distance of each vertex of `mesh` to the surface of `reference`, in units of the mesh.

    Swap the arguments for the distances of the reference's own vertices, as CloudCompare shows them (T3.1.4, T [226]).
    Vertices in no face are measured as well. Raises ValueError for a reference without faces.
    """
    return surface_index(reference).nearest(mesh.vertices)[0]


def _checked(saliency, reference):
    saliency = np.asarray(saliency, dtype=np.float64)
    if saliency.shape != (len(reference.vertices),):
        raise ValueError(f"saliency must have one value per vertex, {len(reference.vertices)}, got {saliency.shape}")
    if not np.isfinite(saliency).all() or saliency.min(initial=0) < 0:
        raise ValueError("saliency must be finite and 0 or more")
    if not saliency[reference.faces].any():
        raise ValueError("saliency is zero on the whole surface: there is nothing to weight by")
    return saliency


def _weighted(weights, distances):
    """The larger of both directions' weighted means; a direction without weight is left out."""
    if weights[0].sum() == 0:
        raise ValueError("no sample of the reference fell where its saliency is above zero: take more samples")
    means = [
        (weight @ gaps) / weight.sum() for weight, gaps in zip(weights, distances, strict=True) if weight.sum() > 0
    ]
    return max(means)


def salient_error(reference: Mesh, mesh: Mesh, saliency: np.ndarray, samples: int = 10_000, seed: int = 0) -> float:
    """Surface distance weighted by the saliency of the reference, over its bounding-box diagonal.

    saliency (n,): 0 or more at each vertex of the reference, for example human gaze spread over the surface, or
    haptic_glance.look.points.saliency; its scale does not matter. Samples are those of `metro`: one on the reference is
    weighted by the saliency there, interpolated within its face; one on the simplified mesh by the saliency at the
    nearest point of the reference. Each direction is a weighted mean, and the larger one is the error, as in Metro.
    Constant saliency gives Metro's mean.

    Raises ValueError for saliency of another length, negative, not finite or zero on the whole surface, where no sample
    has a positive weight, and as `metro` does.
    """
    return surface_errors(reference, mesh, {"salient": saliency}, samples, seed)["salient"]


def colour_error(reference: Mesh, mesh: Mesh, samples: int = 10_000, seed: int = 0) -> float:
    """Root mean square difference, over the three channels in 0..255, of the colours that two surfaces show.

    At points on either surface, uniform by area, and the nearest points on the other one; the larger of both
    directions, as in `metro`. A mesh with a texture shows its nearest pixel, one without its vertex colours
    interpolated, as those in a `picture_of_corners`. Raises ValueError for a mesh without either, without area, or
    fewer than one sample.
    """
    if samples < 1:
        raise ValueError(f"samples must be 1 or more, got {samples}")
    errors = []
    for source, target, name in ((reference, mesh, "reference"), (mesh, reference, "mesh")):
        points, *place = surface_index(source).sample(samples, rng(seed, name))
        _, *nearest = closest(target, points)
        errors.append(((shown(source, *place) - shown(target, *nearest)) ** 2).mean())
    return float(np.sqrt(max(errors)))


def shown(mesh: Mesh, faces: np.ndarray, weights: np.ndarray) -> np.ndarray:
    """(k, 3) colours in 0..255 that a mesh shows at barycentric weights (k, 3) of faces (k,)."""
    if mesh.texture is not None:
        uv = np.einsum("ij,ijk->ik", weights, mesh.texture.uv[faces])
        colors = mesh.texture.sample(faces, uv).astype(np.float64)
        mixed = shown_at_corners(mesh.texture)[faces]
        colors[mixed] = np.einsum("ij,ijk->ik", weights[mixed], corner_colours(mesh.texture, faces[mixed]))
        return colors
    if mesh.colors is None:
        raise ValueError("the mesh has no colours to compare")
    return np.einsum("ij,ijk->ik", weights, mesh.colors[mesh.faces[faces]].astype(np.float64))

"""How far two surfaces lie apart (T3.1.4, T3.2.9.1)."""

import numpy as np
import point_cloud_utils as pcu

from stages.kit.rng import rng


def metro(reference, mesh, samples=10_000, seed=0):
    """Symmetric surface distance of two meshes: dict(mean, rms, max), divided by the reference's bounding-box diagonal.

    Points on either surface are measured to the nearest point of the other. mean and rms are over `samples` points
    spread evenly by area, max is over those and the vertices; each is the larger of its two directions (Cignoni,
    Rocchini and Scopigno 1998, T [224]). A point's distance is exact. On four household objects at a quarter of their
    faces 10,000 samples put mean within 1 % and rms within 1.5 % (one standard deviation), 1,000 within 4 and 8 %; max
    is a lower bound, 0.86 to 1 times that of 400,000 samples. Equal seed, equal numbers.

    Raises ValueError for a mesh without area or fewer than one sample.
    """
    if samples < 1:
        raise ValueError(f"samples must be 1 or more, got {samples}")
    there = _distances(sample_surface(reference, samples, rng(seed, "reference")), reference, mesh)
    back = _distances(sample_surface(mesh, samples, rng(seed, "mesh")), mesh, reference)
    errors = {
        "mean": max(inside.mean() for inside, _ in (there, back)),
        "rms": max(np.sqrt((inside**2).mean()) for inside, _ in (there, back)),
        "max": max(max(inside.max(), corners.max()) for inside, corners in (there, back)),
    }
    return {name: float(error / reference.diagonal) for name, error in errors.items()}


def distances(points, mesh):
    """(k,) distances from points (k, 3) to the nearest point of the mesh's surface."""
    return pcu.closest_points_on_mesh(np.ascontiguousarray(points, dtype=np.float64), mesh.vertices, mesh.faces)[0]


def sample_surface(mesh, count, generator):
    """(count, 3) points spread evenly by area: one in each of `count` equal slices of the surface's area.

    Slices follow the order of the faces, so that each face gets its share to within one point.
    """
    total = np.cumsum(mesh.face_areas)
    if len(total) == 0 or total[-1] <= 0:
        raise ValueError("cannot sample a mesh without area")
    at = (np.arange(count) + generator.random(count)) / count * total[-1]
    face = np.minimum(np.searchsorted(total, at, side="right"), len(total) - 1)
    root, along = np.sqrt(generator.random(count))[:, None], generator.random(count)[:, None]
    a, b, c = mesh.vertices[mesh.faces[face]].transpose(1, 0, 2)
    return (1 - root) * a + root * (1 - along) * b + root * along * c


def _distances(points, own, other):
    """Distances to `other` from points of the surface `own`, and from its vertices."""
    return distances(points, other), distances(own.vertices[np.unique(own.faces)], other)

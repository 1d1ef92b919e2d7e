"""What a few depth cameras see of an object, made a surface again."""

import numpy as np
from scipy.spatial import KDTree

from haptic_glance.lod import simplify
from haptic_glance.look.camera import Viewpoint, pixel_rays
from haptic_glance.look.views import render
from haptic_glance.mesh import Cloud, surface_of
from haptic_glance.mesh.clouds import normals_of
from haptic_glance.mesh.mesh import Mesh

from .perturbed import Perturbed, in_range

ELEVATION = 20.0  # degrees above the horizon: the underside is never seen
SIZE = 90, 120  # rows, columns: about 85 pixels across an object
FACES = 10_000  # at most; the reconstruction is finer than the readings
NOISE = 0.001  # sigma along the line of sight, share of the diagonal


def scan(mesh: Mesh, severity: float, generator: np.random.Generator) -> Perturbed:
    """The surface that depth images reconstruct, `severity` degrees apart around the object: 90 are four, 360 is one.

    A camera is as in T3.2.6, its readings are noisy, and what none sees is a hole (haptic_glance.mesh.surface_of).
    Salient points that lay there count as lost. Raises ValueError where no surface is left.
    """
    in_range(severity, 10, 360, "the degrees between cameras")
    azimuths = generator.uniform(0, 360) + np.arange(0, 360, severity)
    seen = [_points_seen(mesh, Viewpoint(float(azimuth), ELEVATION), generator) for azimuth in azimuths]
    points, normals = (np.concatenate(parts) for parts in zip(*seen, strict=True))
    made = surface_of(Cloud(points, normals))
    made = simplify(made, FACES) if len(made.faces) > FACES else made
    colors = None if mesh.colors is None else mesh.colors[KDTree(mesh.vertices).query(made.vertices)[1]]
    return Perturbed(Mesh(made.vertices, made.faces, colors), made.vertices)


def _points_seen(mesh, viewpoint, generator):
    """(points (k, 3), their normals (k, 3)) of one depth image."""
    view = render(mesh, viewpoint, SIZE, "raster")
    rows, columns = np.nonzero(view.mask)
    origins, directions = pixel_rays(rows, columns, viewpoint, SIZE)
    away = view.depth[rows, columns] + NOISE * mesh.diagonal * generator.standard_normal(len(rows))
    points = origins + away[:, None] * directions
    return points, normals_of(points, origins.mean(axis=0))

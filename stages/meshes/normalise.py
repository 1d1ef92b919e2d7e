"""The coordinate frame of all later stages: +z up, centred, a bounding sphere of radius 0.5."""

from dataclasses import replace

import numpy as np

from stages.kit import Mesh
from stages.kit.axes import Axis, axis_named, to_z_up

from .upright import settled

RADIUS = 0.5  # the sphere then spans 859 of the 900 image rows of the thesis's camera


def normalise(mesh: Mesh) -> Mesh:
    """The mesh with the centre of its bounding box at 0 and a bounding sphere about it of radius 0.5 (T3.2.9).

    Only vertices that a face uses count, so that a stray vertex cannot shrink the object. Raises ValueError when the
    mesh has no faces or no extent.
    """
    centre, radius = centre_and_radius(mesh)
    return replace(mesh, vertices=(mesh.vertices - centre) * (RADIUS / radius))


def centre_and_radius(mesh: Mesh) -> tuple[np.ndarray, float]:
    """(centre (3,) of the bounding box, radius of the bounding sphere about it), in the units of the mesh."""
    used = mesh.vertices[mesh.used]
    if len(used) == 0:
        raise ValueError("the mesh has no faces, so that it cannot be normalised")
    centre = (used.min(axis=0) + used.max(axis=0)) / 2
    radius = np.linalg.norm(used - centre, axis=1).max()
    if radius == 0:
        raise ValueError("the mesh has no extent: all vertices coincide")
    return centre, radius


def rotate_to_z_up(mesh: Mesh, up: Axis | None = None) -> Mesh:
    """The mesh rotated so that its axis `up` (see `axis_named`; None: its own) becomes +z; ValueError for no axis.

    `auto` stands for the axis that the shape suggests (`probable_up`).
    """
    mesh = settled(mesh if up is None else replace(mesh, up=axis_named(up)))
    return replace(mesh, vertices=mesh.vertices @ to_z_up(mesh.up).T, up="z")

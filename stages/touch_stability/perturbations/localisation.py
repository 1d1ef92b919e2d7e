"""The robot misses the place: it touches beside it."""

import numpy as np
import point_cloud_utils

from stages.imprints import sensor_axes, sensor_normals, touchable
from stages.kit.mesh import unit

from .perturbation import Felt, in_range


def localisation(touches, severity, draw):
    """Each place moved `severity` units along its tangent plane, in a random direction, then onto the surface.

    The array stands on the average of the normals of the corners of the face, by their distance: with the face's own
    normal it would also lean, at the least step off a vertex, and that is another perturbation. The robot feels where
    it is: the positions are those of the touches, not of the places that it missed.
    """
    in_range(severity, 0, 1, "the error of the place")
    angle = touches.random("localisation", draw).uniform(0, 2 * np.pi, len(touches.positions))[:, None]
    step = severity * (np.cos(angle) * touches.axes[:, 0] + np.sin(angle) * touches.axes[:, 1])
    positions, normals = on_surface(touches.mesh, touches.positions + step)
    return Felt(touches.press(positions, sensor_axes(normals)), positions)


def on_surface(mesh, points):
    """(positions (k, 3), normals (k, 3)): the nearest places to points (k, 3), normals blended from the corners'."""
    twice = np.concatenate([points, points[:1]])  # point_cloud_utils 0.34 misreads an array of a single point
    _, face, weights = point_cloud_utils.closest_points_on_mesh(twice, mesh.vertices, mesh.faces)
    corners, weights = mesh.faces[face[:-1]], np.asarray(weights[:-1], dtype=np.float64)[:, :, None]
    wanted, back = np.unique(corners, return_inverse=True)
    normals, can = np.zeros((len(wanted), 3)), touchable(mesh, wanted)
    normals[can] = sensor_normals(mesh, wanted[can])
    blended = (weights * normals[back.reshape(corners.shape)]).sum(axis=1)
    return (weights * mesh.vertices[corners]).sum(axis=1), unit(blended)

"""Localisation error: the robot touches beside the place."""

import numpy as np
import point_cloud_utils

from haptic_glance.mesh.mesh import Mesh, unit
from haptic_glance.touch import sensor_axes, sensor_normals, touchable

from ..touches import Touches
from .perturbation import PerturbedTouches, check_range


def localisation(touches: Touches, severity: float, draw: int) -> PerturbedTouches:
    """Each place moved `severity` units along its tangent plane in a random direction, then onto the surface.

    The array's normal is interpolated between those of the face's corners. The face's own normal would also tilt the
    array at the smallest step off a vertex, which is another perturbation. The robot knows where it is: the positions
    are those of the touches, not of the places that it missed.
    """
    check_range(severity, 0, 1, "the localisation error")
    angle = touches.random("localisation", draw).uniform(0, 2 * np.pi, len(touches.positions))[:, None]
    step = severity * (np.cos(angle) * touches.axes[:, 0] + np.sin(angle) * touches.axes[:, 1])
    positions, normals = snap_with_blended_normals(touches.mesh, touches.positions + step)
    return PerturbedTouches(touches.press(positions, sensor_axes(normals)), positions)


def snap_with_blended_normals(mesh: Mesh, points: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """(positions (k, 3), normals (k, 3)): positions nearest to points (k, 3), normals interpolated between corners."""
    twice = np.concatenate([points, points[:1]])  # point_cloud_utils 0.34 misreads an array of a single point
    _, face, weights = point_cloud_utils.closest_points_on_mesh(twice, mesh.vertices, mesh.faces)
    corners, weights = mesh.faces[face[:-1]], np.asarray(weights[:-1], dtype=np.float64)[:, :, None]
    wanted, back = np.unique(corners, return_inverse=True)
    normals, can = np.zeros((len(wanted), 3)), touchable(mesh, wanted)
    normals[can] = sensor_normals(mesh, wanted[can])
    blended = (weights * normals[back.reshape(corners.shape)]).sum(axis=1)
    return (weights * mesh.vertices[corners]).sum(axis=1), unit(blended)

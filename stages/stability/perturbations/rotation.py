"""The same object in another orientation: turned about the vertical axis, or tilted."""

import numpy as np

from haptic_glance.mesh.mesh import Mesh

from .perturbed import Perturbed


def turn(mesh: Mesh, severity: float, _generator: np.random.Generator) -> Perturbed:
    """Turned by `severity` degrees about the vertical axis: the views show other sides."""
    return _rotated(mesh, severity, np.array([0.0, 0.0, 1.0]))


def tilt(mesh: Mesh, severity: float, generator: np.random.Generator) -> Perturbed:
    """Tilted by `severity` degrees about a random horizontal axis: the object is no longer upright."""
    way = generator.uniform(0, 2 * np.pi)
    return _rotated(mesh, severity, np.array([np.cos(way), np.sin(way), 0.0]))


def _rotated(mesh, degrees, axis):
    """Rodrigues' rotation about an axis of length one."""
    angle = np.radians(degrees)
    cross = np.cross(np.eye(3), axis)  # rows e_i x axis: vertices @ cross = vertices x axis
    spin = np.eye(3) - np.sin(angle) * cross + (1 - np.cos(angle)) * (np.outer(axis, axis) - np.eye(3))
    return Perturbed(Mesh(mesh.vertices @ spin, mesh.faces, mesh.colors), mesh.vertices)

"""The same object, placed otherwise: turned about the vertical, or tilted."""

import numpy as np

from stages.kit import Mesh

from .perturbed import Perturbed


def turn(mesh, severity, _generator):
    """Turned by `severity` degrees about the vertical: the views fall on other sides."""
    return _rotated(mesh, severity, np.array([0.0, 0.0, 1.0]))


def tilt(mesh, severity, generator):
    """Tilted by `severity` degrees about a level axis drawn at random: up is no longer up."""
    way = generator.uniform(0, 2 * np.pi)
    return _rotated(mesh, severity, np.array([np.cos(way), np.sin(way), 0.0]))


def _rotated(mesh, degrees, axis):
    """Rodrigues' rotation about an axis of length one."""
    angle = np.radians(degrees)
    cross = np.cross(np.eye(3), axis)  # rows e_i x axis: vertices @ cross = vertices x axis
    spin = np.eye(3) - np.sin(angle) * cross + (1 - np.cos(angle)) * (np.outer(axis, axis) - np.eye(3))
    return Perturbed(Mesh(mesh.vertices @ spin, mesh.faces, mesh.colors), mesh.vertices)

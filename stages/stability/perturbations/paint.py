"""Colours, which the thesis's grey objects do not have: one for the whole object, or a pattern of two; or none."""

import colorsys

import numpy as np

from haptic_glance.look.views.shading import GREY
from haptic_glance.mesh.mesh import Mesh

from .perturbed import Perturbed, in_range

WAVES = 12  # sine waves whose sum decides between the two colours
LENGTH = 0.3  # of a wave, over the diagonal: patches are then the size of an object's parts


def paint(mesh: Mesh, severity: float, generator: np.random.Generator) -> Perturbed:
    """The whole object in one colour with a saturation of `severity`; the hue is drawn at random."""
    colour = _colour(generator.random(), in_range(severity, 0, 1, "saturation"))
    return _painted(mesh, np.tile(colour, (len(mesh.vertices), 1)))


def pattern(mesh: Mesh, severity: float, generator: np.random.Generator) -> Perturbed:
    """Smooth random patches of two complementary colours with a saturation of `severity`."""
    hue, saturation = generator.random(), in_range(severity, 0, 1, "saturation")
    waves = 2 * np.pi / (LENGTH * max(mesh.diagonal, 1e-30)) * _directions(generator)
    height = np.cos(mesh.vertices @ waves.T + generator.uniform(0, 2 * np.pi, WAVES)).sum(axis=1)
    two = np.stack([_colour(hue, saturation), _colour(hue + 0.5, saturation)])
    return _painted(mesh, two[(height > 0).astype(int)])


def grey(mesh: Mesh, severity: float, _generator: np.random.Generator) -> Perturbed:
    """The object's own colours without a share `severity` of their hue; their brightness stays."""
    return _faded(mesh, severity, lambda colors: colors.mean(axis=1, keepdims=True))


def clay(mesh: Mesh, severity: float, _generator: np.random.Generator) -> Perturbed:
    """The object's own colours moved by a share `severity` to the even grey of objects without colours."""
    return _faded(mesh, severity, lambda colors: GREY)


def _faded(mesh, severity, target):
    if mesh.colors is None:
        raise ValueError("has no colours to take away: run it on a set with meshes.colours=own")
    share, colors = in_range(severity, 0, 1, "the share of colour taken away"), mesh.colors.astype(np.float64)
    faded = np.rint((1 - share) * colors + share * target(colors)).astype(np.uint8)
    return Perturbed(Mesh(mesh.vertices, mesh.faces, faded), mesh.vertices)


def _directions(generator):
    drawn = generator.standard_normal((WAVES, 3))
    return drawn / np.linalg.norm(drawn, axis=1, keepdims=True)


def _colour(hue, saturation):
    """(3,) f8: the factor by which the paint multiplies red, green and blue underneath."""
    return np.array(colorsys.hsv_to_rgb(hue % 1, saturation, 1.0))


def _painted(mesh, coat):
    under = np.full((len(mesh.vertices), 3), GREY) if mesh.colors is None else mesh.colors
    return Perturbed(Mesh(mesh.vertices, mesh.faces, np.rint(under * coat).astype(np.uint8)), mesh.vertices)

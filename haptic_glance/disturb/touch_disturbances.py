"""Disturbances of touch: the place, the object, the sensor and the model differ between training and test.

`Touches` holds the touches of one object, and can repeat the touches under changed conditions. The registry of
disturbances has the order of the figure: placement, sensor, object, model. To add a disturbance, write a function and
an entry.
"""

from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property, partial

import numpy as np
from numpy.typing import ArrayLike

from haptic_glance.base.rng import rng
from haptic_glance.lod import simplify
from haptic_glance.mesh.mesh import Mesh, unit
from haptic_glance.mesh.nearest import closest
from haptic_glance.touch import Skin, Surface, press_at, sensor_axes, sensor_normals, snap_to_surface, touchable

from .perturbed import in_range


class Touches:
    """Touches of a Mesh at vertices (k,) by an array of `cells`, `pitch` units apart.

    name: the object's, for the random numbers; saliency: (n,) f8 in 0..1 per vertex, for simplification weighted by
    saliency; levels: {name of a simplified mesh: Mesh}, of data/SET/lod. `positions` (k, 3), `normals` (k, 3) and
    `axes` (k, 3, 3) are those of the undisturbed array, `images` (k, rows, cols) its imprints. Raises ValueError for a
    mesh with another axis than z up.
    """

    def __init__(
        self,
        name: str,
        mesh: Mesh,
        vertices: np.ndarray,
        cells: tuple[int, int],
        pitch: float,
        saliency: np.ndarray | None = None,
        levels: dict[str, Mesh] | None = None,
        seed: int = 0,
    ) -> None:
        if mesh.up != "z":
            raise ValueError(f"the object has {mesh.up} up, and its disturbances need z up: call rotate_to_z_up")
        self.name, self.mesh, self.cells, self.pitch = name, mesh, cells, pitch
        self.saliency, self.levels, self._seed = saliency, levels or {}, seed
        self.surface = Surface(mesh)
        self.positions = mesh.vertices[vertices]
        self.normals = sensor_normals(mesh, vertices)
        self.axes = sensor_axes(self.normals)

    @cached_property
    def images(self) -> np.ndarray:
        """(k, rows, cols) f4 in 0..1: the undisturbed imprints."""
        return self.press()

    def press(
        self,
        positions: np.ndarray | None = None,
        axes: np.ndarray | None = None,
        surface: Surface | None = None,
        pitch: float | None = None,
    ) -> np.ndarray:
        """(k, rows, cols) f4: the imprints with the given conditions, by default those of the undisturbed array."""
        return press_at(
            self.surface if surface is None else surface,
            self.positions if positions is None else positions,
            self.axes if axes is None else axes,
            self.cells,
            self.pitch if pitch is None else pitch,
        )

    def random(self, effect: str, draw: int) -> np.random.Generator:
        """A random generator for one perturbation of this object; draw: the number of the repetition."""
        return rng(self._seed, f"{self.name} {effect} {draw}")

    def skin_seed(self, draw: int) -> int:
        """The seed of the sensor, the same for all objects; the number of the draw itself for seed 0."""
        return int(rng(self._seed, f"skin {draw}").integers(2**31)) if self._seed else draw


def rotations_about(axis: np.ndarray, degrees: ArrayLike) -> np.ndarray:
    """(..., 3, 3) rotations about unit axes (..., 3) by `degrees` (...,): Rodrigues' formula."""
    x, y, z = np.moveaxis(np.asarray(axis, dtype=np.float64), -1, 0)
    zero, angle = np.zeros_like(x), np.radians(degrees)[..., None, None]
    cross = np.stack([np.stack(row, -1) for row in ((zero, -z, y), (z, zero, -x), (-y, x, zero))], -2)
    return np.eye(3) + np.sin(angle) * cross + (1 - np.cos(angle)) * (cross @ cross)


@dataclass(frozen=True)
class PerturbedTouches:
    """Disturbed touches: images (k, rows, cols) in 0..1; positions (k, 3) as the robot measures them, or None if
    they are those of the undisturbed touches.
    """

    images: np.ndarray
    positions: np.ndarray | None = None


@dataclass(frozen=True)
class TouchPerturbation:
    """One difference between training and test touches.

    unit: of the severity; unharmed: the severity that changes nothing. apply(touches, severity, draw) gives
    PerturbedTouches; None if the number of training touches changes and not the touches. in_training: the disturbed
    touches are for training and the clean ones for testing. random_draws: the perturbation is random, so that several
    draws are made. moves_positions: the positions change, so that it is also tested with positions as features (T4.2.4,
    table 4.5).
    """

    unit: str
    unharmed: float
    apply: Callable[[Touches, float, int], PerturbedTouches] | None
    in_training: bool = False
    random_draws: bool = False
    moves_positions: bool = False


def localisation(touches: Touches, severity: float, draw: int) -> PerturbedTouches:
    """Each place moved `severity` units along its tangent plane in a random direction, then onto the surface.

    The array's normal is interpolated between those of the face's corners. The face's own normal would also tilt the
    array at the smallest step off a vertex, which is another perturbation. The robot knows where it is: the positions
    are those of the touches, not of the places that it missed.
    """
    in_range(severity, 0, 1, "the localisation error")
    angle = touches.random("localisation", draw).uniform(0, 2 * np.pi, len(touches.positions))[:, None]
    step = severity * (np.cos(angle) * touches.axes[:, 0] + np.sin(angle) * touches.axes[:, 1])
    positions, normals = snap_with_blended_normals(touches.mesh, touches.positions + step)
    return PerturbedTouches(touches.press(positions, sensor_axes(normals)), positions)


def snap_with_blended_normals(mesh: Mesh, points: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """(positions (k, 3), normals (k, 3)): positions nearest to points (k, 3), normals interpolated between corners."""
    _, face, weights = closest(mesh, points)
    corners, weights = mesh.faces[face], weights[:, :, None]
    ids, back = np.unique(corners, return_inverse=True)
    normals, is_touchable = np.zeros((len(ids), 3)), touchable(mesh, ids)
    normals[is_touchable] = sensor_normals(mesh, ids[is_touchable])
    blended = (weights * normals[back.reshape(corners.shape)]).sum(axis=1)
    return (weights * mesh.vertices[corners]).sum(axis=1), unit(blended)


UP = np.array([0.0, 0.0, 1.0])


def object_turned(touches: Touches, severity: float, draw: int) -> PerturbedTouches:
    """The object rotated about the vertical by `severity` degrees: the same places, the array upright."""
    in_range(severity, 0, 360, "the turn in degrees")
    return _turned(touches, rotations_about(UP, np.float64(severity)))


def object_tilted(touches: Touches, severity: float, draw: int) -> PerturbedTouches:
    """The object tilted about a random horizontal axis by `severity` degrees; the places on it are the same."""
    in_range(severity, 0, 180, "the tilt in degrees")
    azimuth = touches.random("object_tilted", draw).uniform(0, 2 * np.pi)
    return _turned(touches, rotations_about(np.array([np.cos(azimuth), np.sin(azimuth), 0.0]), np.float64(severity)))


def object_scaled(touches: Touches, severity: float, draw: int) -> PerturbedTouches:
    """The object `severity` times as large, touched by the same array: equivalent to a finer array on the original."""
    in_range(severity, 0.05, 20, "the scale")
    return PerturbedTouches(touches.press(pitch=touches.pitch / severity), severity * touches.positions)


def _turned(touches, rotation):
    """The touches after a rotation (3, 3) of the object, computed by the inverse rotation of the array."""
    images = touches.press(axes=sensor_axes(touches.normals @ rotation.T) @ rotation)
    return PerturbedTouches(images, touches.positions @ rotation.T)


SOFT = "glance-soft"  # of lod.methods: errors have more weight where the object is salient


def touch_simplified(touches: Touches, severity: float, draw: int, way: str) -> PerturbedTouches:
    """The touches at the nearest positions on a mesh of `severity` faces, simplified by a method of lod.methods.

    The mesh is that of data/SET/lod if it exists, else it is simplified here in the same way. An object without more
    faces is unchanged.
    """
    faces = int(severity)
    if len(touches.mesh.faces) <= faces:
        return PerturbedTouches(touches.images)
    level = touches.levels.get(f"{way}_{faces}")
    mesh = simplify(touches.mesh, faces, weights=touches.saliency if way == SOFT else None) if level is None else level
    surface = Surface(mesh)
    positions, normals = snap_to_surface(surface, touches.positions, tolerance=np.inf)
    return PerturbedTouches(touches.press(positions, sensor_axes(normals), surface))


simplified = partial(touch_simplified, way="qem")
simplified_by_saliency = partial(touch_simplified, way=SOFT)


def sensor_turned(touches: Touches, severity: float, draw: int) -> PerturbedTouches:
    """Each array rotated about its normal by `severity` degrees, randomly to the left or to the right."""
    in_range(severity, 0, 180, "the turn in degrees")
    side = touches.random("sensor_turned", draw).choice([-1, 1], len(touches.positions))
    return PerturbedTouches(
        touches.press(axes=touches.axes @ rotations_about(touches.normals, side * severity).transpose(0, 2, 1))
    )


def sensor_leaning(touches: Touches, severity: float, draw: int) -> PerturbedTouches:
    """Each array tilted by `severity` degrees from the surface's normal in a random direction, at the same place."""
    in_range(severity, 0, 60, "the lean in degrees")
    angle = touches.random("sensor_leaning", draw).uniform(0, 2 * np.pi, len(touches.positions))[:, None]
    axis = np.cos(angle) * touches.axes[:, 0] + np.sin(angle) * touches.axes[:, 1]
    degrees = np.full(len(axis), severity)
    return PerturbedTouches(touches.press(axes=touches.axes @ rotations_about(axis, degrees).transpose(0, 2, 1)))


def _felt(touches, severity, draw, effect):
    seed = touches.skin_seed(draw)
    return PerturbedTouches(Skin(**{effect: severity}, seed=seed)(touches.images, touches.name))


noise = partial(_felt, effect="noise")
dead_cells = partial(_felt, effect="dead")
gain = partial(_felt, effect="gain")
saturation = partial(_felt, effect="saturation")
blur = partial(_felt, effect="blur")
hysteresis = partial(_felt, effect="hysteresis")


TOUCH_PERTURBATIONS = {
    "localisation": TouchPerturbation(
        "units beside the place", 0.0, localisation, random_draws=True, moves_positions=True
    ),
    "sensor_turned": TouchPerturbation("degrees about the normal", 0.0, sensor_turned, random_draws=True),
    "sensor_leaning": TouchPerturbation("degrees off the normal", 0.0, sensor_leaning, random_draws=True),
    "noise": TouchPerturbation("sigma, share of full scale", 0.0, noise, random_draws=True),
    "dead_cells": TouchPerturbation("share of the cells", 0.0, dead_cells, random_draws=True),
    "gain": TouchPerturbation("reading per load", 1.0, gain),
    "saturation": TouchPerturbation("highest reading", 1.0, saturation),
    "blur": TouchPerturbation("sigma in cells", 0.0, blur),
    "hysteresis": TouchPerturbation("lag, share of full scale", 0.0, hysteresis),
    "object_turned": TouchPerturbation("degrees about the vertical", 0.0, object_turned, moves_positions=True),
    "object_tilted": TouchPerturbation(
        "degrees about a level axis", 0.0, object_tilted, random_draws=True, moves_positions=True
    ),
    "object_larger": TouchPerturbation("times the size", 1.0, object_scaled, moves_positions=True),
    "object_smaller": TouchPerturbation("times the size", 1.0, object_scaled, moves_positions=True),
    "coarse_object": TouchPerturbation("faces, touched", 4000.0, simplified),
    "coarse_object_soft": TouchPerturbation("faces, touched", 4000.0, simplified_by_saliency),
    "coarse_model": TouchPerturbation("faces, in training", 4000.0, simplified, in_training=True),
    "coarse_model_soft": TouchPerturbation("faces, in training", 4000.0, simplified_by_saliency, in_training=True),
    "few_touches": TouchPerturbation("training touches per object", 45.0, None),
}

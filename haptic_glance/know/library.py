"""A library of known meshes: what a look shows and a touch feels if it is one of them, in each pose it may have."""

import hashlib
from collections.abc import Mapping
from dataclasses import replace
from functools import cached_property, lru_cache
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import ArrayLike
from scipy.spatial.transform import Rotation
from scipy.special import logsumexp

from haptic_glance.base.warner import warn_caller
from haptic_glance.look.camera import DISTANCE, VIEW_ANGLE, Viewpoint
from haptic_glance.look.views import render
from haptic_glance.mesh import rotate_to_z_up
from haptic_glance.mesh.files import MeshLike, with_known_up
from haptic_glance.mesh.mesh import Mesh
from haptic_glance.mesh.repair import area_share, centre_and_radius
from haptic_glance.touch import Surface

from .hypotheses import Hypotheses, grid_hypotheses
from .likelihood import Likelihood
from .objects import upright_named
from .poses import POSES, PoseGrid, pose_grid
from .pressure_array import Approach, PressureArray, feel_lines
from .sight import SIDE, Sketch, prepared, similarity, sketch
from .unknown import Verifier, fit_verifier

if TYPE_CHECKING:
    from .belief import Belief

START = 0.9  # diameters from the centre's plane, at which the library's lines begin
AWAY = START + 0.6  # travel, in diameters, that stands for a touch that meets nothing
DEFAULT = PressureArray((8, 8), 0.02, 0.05, 0.005, 0.0025)  # in diameters of the largest object
BYTES = 255  # in which relief is stored, as a share of the array's depth
ELEVATIONS = (10.0, 35.0, 60.0)  # degrees, from which a camera may look of which nothing is known
SPAN = 2 * DISTANCE * np.tan(np.radians(VIEW_ANGLE) / 2)  # diameters that the rows of a picture span
PROBED = 64  # lines, of a first comparison of two shapes
SAME, MOST = 0.003, 0.95  # diameters within which two shapes are the same, at this share of the lines


def learn(
    meshes: Mapping[str, MeshLike],
    pose: str = "turned",
    sensor: PressureArray | None = None,
    position: float = 0.0,
    size: float = 0.0,
    unknown: bool = False,
) -> "Library":
    """Learns objects by their meshes, so that a look and touches can tell which of them is there.

    Parameters
    ----------
    meshes : mapping of str to Mesh or any input of `as_mesh`
        Meshes by name, all in one unit. They are turned so that z is up, and the centre of each bounding box becomes
        the origin. Their sizes count; give them through `normalise` if they say nothing.
    pose : {"fixed", "turned", "any"}
        How an object may stand: as its mesh does; turned about the up axis; in any rotation.
    sensor : PressureArray, optional
        The array of the hand, in the unit of the meshes. By default 8 x 8 cells that span 0.16 of the largest object.
    position : float
        How far the centre of an object may be from the origin along each axis, in the unit of the meshes.
    size : float
        Share by which an object may be larger or smaller than its mesh.
    unknown : bool
        Whether an object may be none of these, which is then an answer of its own.

    Returns
    -------
    Library
        The objects. `belief()` is the belief before anything is known, `look(picture, camera)` that after a look.

    Raises
    ------
    ValueError
        For no mesh, for a mesh that cannot be touched, which is named, and for an unknown pose or tolerance.
    TypeError
        For meshes that are no mapping, and for names that are no texts.

    Warns
    -----
    UserWarning
        For a mesh that does not say which axis points up, and for two equal shapes, which nothing can tell apart.

    Examples
    --------
    >>> from haptic_glance import Viewpoint, render
    >>> from haptic_glance.know import learn, primitives, stand
    >>> shapes = primitives()
    >>> library = learn(shapes)
    >>> there = stand(shapes["cone"], turn=40)  # a cone that is turned by 40 degrees
    >>> belief = library.look(render(there, Viewpoint(0, 35)).rgb, Viewpoint(0, 35))
    >>> while not belief.known:
    ...     approach = belief.next_touch()
    ...     belief = belief.after(approach, *approach.feel(there))
    >>> belief.known
    'cone'
    """
    check_names(meshes)
    if not meshes:
        raise ValueError("there is no mesh to learn: give at least one by its name")
    if pose not in POSES:
        raise ValueError(f"unknown pose {pose!r}: choose one of {', '.join(POSES)}")
    if sensor is not None and not isinstance(sensor, PressureArray):
        raise TypeError(f"sensor must be a PressureArray, got {sensor!r}")
    for name, tolerance in (("position", position), ("size", size)):
        if not (isinstance(tolerance, int | float | np.number) and 0 <= float(tolerance) < np.inf):
            raise ValueError(f"{name} must be a finite tolerance of 0 or more, got {tolerance!r}")
    if not size < 1:
        raise ValueError(f"size is a share below 1 by which objects may be larger or smaller, got {size}")
    standing = {name: _standing(name, mesh) for name, mesh in meshes.items()}
    library = Library(standing, pose, sensor, position, size, unknown)
    for late, early in library.alike.items():
        warn_caller(f"{early} and {late} are the same shape: they cannot be told apart, so leave one out")
    return library


def check_names(meshes: object) -> None:
    """Raises TypeError for meshes that are no mapping, and for names that are no texts."""
    if not isinstance(meshes, Mapping):
        raise TypeError(f"meshes must be a mapping from names to meshes, got {type(meshes).__name__}")
    if wrong := [name for name in meshes if not (isinstance(name, str) and name)]:
        raise TypeError(f"meshes must have texts as names, got {wrong[0]!r}")


def stand(
    mesh: MeshLike, turn: float = 0.0, shift: ArrayLike = (0.0, 0.0, 0.0), rotation: ArrayLike | None = None
) -> Mesh:
    """A mesh as a library assumes that its object stands: z up, centred on the origin, then turned and shifted.

    Parameters
    ----------
    mesh : Mesh or any input of `as_mesh`
        The mesh.
    turn : float
        Degrees about the up axis, counter-clockwise seen from above.
    shift : (3,) array_like
        Where the centre is, in the unit of the mesh.
    rotation : (3, 3) array_like, optional
        A rotation instead of `turn`.

    Returns
    -------
    Mesh
        The mesh in its pose.
    """
    upright = rotate_to_z_up(with_known_up(mesh))
    matrix = Rotation.from_rotvec([0, 0, np.radians(turn)]).as_matrix() if rotation is None else np.asarray(rotation)
    centre, _ = centre_and_radius(upright)
    return replace(upright, vertices=(upright.vertices - centre) @ matrix.T + np.asarray(shift, dtype=np.float64))


def _standing(name, mesh):
    """The mesh of a name, z up and centred; ValueError that names it where it cannot be touched."""
    upright = upright_named(name, mesh)
    try:
        area_share(upright)
        centre, _ = centre_and_radius(upright)
    except ValueError as error:
        raise ValueError(f"{name}: {error}") from None
    return replace(upright, vertices=upright.vertices - centre)


class _Mesh:
    """A mesh in diameters, equal where its content is: the key of what is computed of it."""

    def __init__(self, mesh: Mesh) -> None:
        self.mesh = mesh
        colours = b"" if mesh.colors is None else mesh.colors.tobytes()  # which a look sees
        self.content = hashlib.sha256(mesh.vertices.tobytes() + mesh.faces.tobytes() + colours).digest()

    def __eq__(self, other: object) -> bool:
        return isinstance(other, _Mesh) and self.content == other.content

    def __hash__(self) -> int:
        return hash(self.content)


@lru_cache(maxsize=1024)
def _surface(item: _Mesh) -> Surface:
    return Surface(item.mesh)


@lru_cache(maxsize=1024)
def _felt(item: _Mesh, pose: str, array: PressureArray) -> tuple[np.ndarray, np.ndarray]:
    """(travels (lines of the object,) f4, reliefs (lines, cells) bytes) of a mesh along the lines of a grid."""
    travels, imprints = feel_lines(_surface(item), *pose_grid(pose, START).lines_of_object(), array)
    shares = imprints.reshape(len(imprints), -1) / array.depth
    travels = np.where(np.isfinite(travels), travels, AWAY)
    return travels.astype(np.float32), np.rint(BYTES * shares).astype(np.uint8)


@lru_cache(maxsize=4096)
def _views(item: _Mesh, pose: str, elevation: float, roll: float, offset: float) -> Sketch:
    """The Sketch of a mesh in each pose of a grid, seen from an azimuth of `offset` degrees."""
    axes = Viewpoint(offset, elevation, roll).axes
    cameras = [_viewpoint(axes @ rotation) for rotation in pose_grid(pose, START).rotations]
    views = (render(item.mesh, camera, size=(SIDE, SIDE)) for camera in cameras)
    return sketch(np.stack([view.rgb.mean(axis=2) for view in views]) / 255)


def _viewpoint(axes):
    """The Viewpoint whose axes (3, 3) are given."""
    back = axes[2]
    azimuth, elevation = np.arctan2(back[1], back[0]), np.arcsin(np.clip(back[2], -1, 1))
    plain = Viewpoint(*np.degrees([azimuth, elevation]).tolist())
    roll = np.arctan2(axes[1] @ plain.axes[0], axes[1] @ plain.axes[1])
    return replace(plain, roll=float(np.degrees(roll)))


def coarse(reliefs: np.ndarray, cells: tuple[int, int]) -> np.ndarray:
    """Reliefs (..., cells) as means over blocks of 2 x 2 cells, rounded down if they are bytes.

    As they are where rows or columns are odd.
    """
    rows, columns = cells
    if rows % 2 or columns % 2:
        return reliefs
    parts = reliefs.reshape(*reliefs.shape[:-1], rows // 2, 2, columns // 2, 2)
    kind = np.uint16 if reliefs.dtype == np.uint8 else reliefs.dtype
    sums = np.sum([parts[..., i, :, j].astype(kind) for i in range(2) for j in range(2)], axis=0, dtype=kind)
    means = sums // 4 if kind == np.uint16 else sums / 4
    return means.astype(reliefs.dtype).reshape(*reliefs.shape[:-1], -1)


class Library:
    """Known objects, made by `learn`.

    Attributes
    ----------
    names : tuple of str
        The objects.
    diameter : float
        Of the largest object's bounding sphere, in the unit of the meshes.
    span : float
        Length of the rows of a picture, in the unit of the meshes: 1.048 diameters. The camera looks at the origin.
    sensor : PressureArray
        The array, in the unit of the meshes.
    """

    def __init__(
        self, meshes: Mapping[str, Mesh], pose: str, sensor: PressureArray | None, position: float, size: float,
        unknown: bool,
    ) -> None:  # fmt: skip
        self.names, self.pose = tuple(meshes), pose
        self.diameter = 2 * max(centre_and_radius(mesh)[1] for mesh in meshes.values())
        self.span = SPAN * self.diameter
        self.sensor = sensor or DEFAULT.scaled(self.diameter)
        self.array = DEFAULT if sensor is None else sensor.scaled(1 / self.diameter)  # in diameters
        self.position, self.size = position / self.diameter, size
        self.grid: PoseGrid = pose_grid(pose, START)
        self.likelihood = Likelihood().with_noise(self.array)
        self.items = [_Mesh(replace(mesh, vertices=mesh.vertices / self.diameter)) for mesh in meshes.values()]
        self.hypotheses: Hypotheses = grid_hypotheses(len(self.names), self.grid.rotations)
        self._travels, self._reliefs = self._table()
        self._coarse = coarse(self._reliefs, self.array.cells)
        self.freedom = np.array({"fixed": (0, 0, 0), "turned": (0, 0, 1), "any": (1, 1, 1)}[pose])
        self.verifier: Verifier | None = None
        self.verifier = fit_verifier(self) if unknown else None

    def _table(self):
        """(travels (bases, n, k, group), reliefs (bases, n, k, group, cells)) of all objects along all lines."""
        felt = [_felt(item, self.pose, self.array) for item in self.items]
        shape = len(felt), len(self.grid.further), len(self.grid.origins), len(self.grid.group)
        travels = np.stack([travel for travel, _ in felt]).reshape(shape)
        reliefs = np.stack([relief for _, relief in felt]).reshape(*shape, -1)
        return (np.ascontiguousarray(np.moveaxis(values, 2, 0)) for values in (travels, reliefs))

    @cached_property
    def alike(self) -> dict[str, str]:
        """{name of an object: an earlier one of the same shape, which nothing can tell from it}."""
        felt = np.moveaxis(self._travels, 1, 0).reshape(len(self.names), -1)
        found = {}
        for late, name in enumerate(self.names):
            near = np.flatnonzero(np.median(np.abs(felt[:late, :PROBED] - felt[late, :PROBED]), axis=1) < SAME)
            same = near[(np.abs(felt[near] - felt[late]) < SAME).mean(axis=1) >= MOST]
            if len(same):
                found[name] = self.names[same[0]]
        return found

    def mesh(self, name: str) -> Mesh:
        """The mesh of a name, centred, with z up, in the unit in which it was given."""
        if name not in self.names:
            raise ValueError(f"unknown object {name!r}: choose one of {', '.join(self.names)}")
        mesh = self.items[self.names.index(name)].mesh
        return replace(mesh, vertices=mesh.vertices * self.diameter)

    def belief(self) -> "Belief":
        """The Belief before a look and a touch: all objects are alike."""
        return self._first

    @cached_property
    def _first(self):
        """The Belief before a look and a touch, which plans its first touch once."""
        from .belief import first_belief

        return first_belief(self)

    def look(self, picture: ArrayLike, camera: Viewpoint | None = None, hidden: ArrayLike | None = None) -> "Belief":
        """The Belief after a look, see `Belief.look`."""
        return self.belief().look(picture, camera, hidden)

    def approach(self, origin: ArrayLike, direction: ArrayLike, up: ArrayLike | None = None) -> Approach:
        """The Approach of a hand that comes along a line of its own.

        origin (3,): where the middle of the array starts, in the unit of the meshes; direction (3,): along which it
        moves; up (3,): what is upwards on the array, by default as in `sensor_axes`.
        """
        from haptic_glance.touch import sensor_axes

        origin, direction = (np.asarray(values, dtype=np.float64) for values in (origin, direction))
        if origin.shape != (3,) or direction.shape != (3,) or not np.isfinite([origin, direction]).all():
            raise ValueError(f"an approach has an origin and a direction of three numbers, got {origin}, {direction}")
        if not direction.any():
            raise ValueError("the direction of an approach must not be zero")
        axes = sensor_axes(-direction[None])[0]
        if up is not None:
            upwards = np.asarray(up, dtype=np.float64)
            upwards = upwards - upwards @ axes[2] * axes[2]
            if not np.linalg.norm(upwards) > 0:
                raise ValueError("what is upwards on the array must differ from the direction in which it moves")
            upwards /= np.linalg.norm(upwards)
            axes = np.stack([np.cross(upwards, axes[2]), upwards, axes[2]])
        return Approach(origin, axes, self.sensor)

    def line(self, number: int) -> Approach:
        """The Approach along one of the library's own lines."""
        origin, axes = self.grid.line_origins[number], self.grid.line_axes[number]
        return Approach(origin * self.diameter, axes, self.sensor, int(number))

    def predict(self, hypotheses: Hypotheses, approach: Approach) -> tuple[np.ndarray, np.ndarray]:
        """(travels (h,), reliefs (h, cells) f4 in 0..1) of a touch if each hypothesis is true; travels in diameters."""
        if hypotheses.is_grid and approach.line >= 0:
            base, element = divmod(approach.line, len(self.grid.group))
            seen = self.grid.seen[:, element]
            reliefs = self._reliefs[base][:, :, seen].reshape(len(hypotheses), -1)
            return self._travels[base][:, :, seen].ravel(), reliefs.astype(np.float32) / BYTES
        origins, axes = approach.origin[None] / self.diameter, approach.axes[None]
        travels, reliefs = self.press(hypotheses, origins, axes)
        return travels[:, 0], reliefs[:, 0]

    def predict_lines(self, hypotheses: Hypotheses, lines: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """(travels (h, k), reliefs (h, k, some cells) f4) along k of the library's lines, as `predict`, for planning.

        Neighbouring cells are averaged: the planner needs no more.
        """
        if not self.tolerant:
            base, element = np.divmod(lines, len(self.grid.group))
            further, turn = np.divmod(hypotheses.poses, len(self.grid.poses))
            at = base[None], hypotheses.objects[:, None], further[:, None], self.grid.seen[turn][:, element]
            return self._travels[at], self._coarse[at].astype(np.float32) / BYTES
        travels, reliefs = self.press(hypotheses, self.grid.line_origins[lines], self.grid.line_axes[lines])
        return travels, coarse(reliefs, self.array.cells)

    @property
    def tolerant(self) -> bool:
        """Whether position or size are unknown, so that hypotheses have a shift and a size."""
        return self.position > 0 or self.size > 0

    def press(self, hypotheses: Hypotheses, origins: np.ndarray, axes: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """(travels (h, k), reliefs (h, k, cells) f4) along k lines, by pressing the meshes."""
        count, lines = len(hypotheses), len(origins)
        travels = np.empty((count, lines), dtype=np.float32)
        reliefs = np.empty((count, lines, self.array.cells[0] * self.array.cells[1]), dtype=np.float32)
        starts, frames = hypotheses.to_object(origins, axes)
        for number in np.unique(hypotheses.objects):
            ids = np.flatnonzero(hypotheses.objects == number)
            sizes = np.repeat(hypotheses.sizes[ids], lines)
            felt, imprints = feel_lines(
                _surface(self.items[number]), starts[ids].reshape(-1, 3), frames[ids].reshape(-1, 3, 3), self.array,
                sizes,
            )  # fmt: skip
            felt = np.where(np.isfinite(felt), felt, AWAY)
            travels[ids] = felt.reshape(len(ids), lines)
            reliefs[ids] = (imprints / self.array.depth).reshape(len(ids), lines, -1)
        return travels, reliefs

    def of_picture(self, picture: ArrayLike, camera: Viewpoint | None, hidden: ArrayLike | None) -> np.ndarray:
        """(h,) log likelihoods, to a constant, of a picture for each object in each pose of the grid."""
        grey, seen = prepared(picture, hidden)
        if camera is None:
            parts = [self._of_view(grey, seen, Viewpoint(0, elevation)) for elevation in ELEVATIONS]
            return self._in_any_turn(logsumexp(parts, axis=0))
        if not isinstance(camera, Viewpoint):
            raise TypeError(f"camera must be a Viewpoint such as Viewpoint(0, 35), or None, got {camera!r}")
        if camera.elevation < 0 and self.pose != "any":
            raise ValueError(
                f"the camera is {-camera.elevation:g} degrees below the horizon, so that the table hides the object: "
                'give an elevation of 0 or more, or learn with pose="any"'
            )
        return self._of_view(grey, seen, camera)

    def _of_view(self, grey, seen, camera):
        steps = len(self.grid.poses) if self.pose == "turned" else 0  # views of other azimuths are those of other poses
        turn, offset = 0, camera.azimuth
        if steps:
            turn, offset = divmod(camera.azimuth, 360 / steps)
            turn = int(turn) % steps
        key = self.pose, float(camera.elevation), float(camera.roll), round(float(offset), 1)
        views = [_views(item, *key) for item in self.items]
        picture = sketch(grey[None])
        similarities = np.stack([similarity(picture, view, seen) for view in views], axis=1)  # (2, n, poses)
        return self.likelihood.of_picture(np.roll(similarities, turn, axis=2)).ravel()

    def _in_any_turn(self, values):
        """Log likelihoods (h,) where nobody knows from where the camera looks: of each object, in all poses alike."""
        of_object = logsumexp(values.reshape(len(self.names), -1), axis=1) - np.log(self.grid.size)
        return np.repeat(of_object, self.grid.size)

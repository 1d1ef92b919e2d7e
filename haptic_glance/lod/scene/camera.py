"""Objects placed in the world, and a perspective camera on a path (haptic_glance.look.camera is orthographic)."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np
import scipy  # imports scipy.interpolate at its first use, which takes a tenth of a second
from numpy.typing import ArrayLike

from haptic_glance.mesh.mesh import Mesh, bounding_box, unit


@dataclass(frozen=True)
class Camera:
    """The camera of one frame; +z is up, and pixel centres lie at whole numbers.

    Parameters
    ----------
    eye : tuple of 3 floats
        Position of the camera, in metres.
    target : tuple of 3 floats
        Point in the middle of the picture, in metres.
    angle : float
        Vertical view angle in degrees, 1 to 170.
    size : tuple of 2 ints
        Rows and columns of the picture, in pixels.

    Raises
    ------
    ValueError
        For a camera without a direction, a camera that looks straight up or down, and an angle out of range.

    Examples
    --------
    >>> from haptic_glance import Camera
    >>> Camera(eye=(3, 0, 1), target=(0, 0, 1), angle=40, size=(270, 480)).size
    (270, 480)
    """

    eye: tuple[float, float, float]
    target: tuple[float, float, float]
    angle: float
    size: tuple[int, int]

    def __post_init__(self) -> None:
        along = np.subtract(self.target, self.eye)
        if along.shape != (3,):
            raise ValueError(f"a camera at {self.eye} that looks at {self.target}: give x, y, z of both")
        if not np.isfinite(along).all():
            raise ValueError(f"a camera at {self.eye} that looks at {self.target} is nowhere: give finite numbers")
        if np.hypot(along[0], along[1]) <= 1e-6 * (1 + np.abs(along[2])):
            raise ValueError(f"a camera at {self.eye} cannot look at {self.target}: same place, or straight up or down")
        if not 1 <= self.angle <= 170:
            raise ValueError(f"the view angle is {self.angle} degrees: give the vertical one, from 1 to 170")
        if len(self.size) != 2 or not all(isinstance(n, int | np.integer) and n >= 1 for n in self.size):
            raise ValueError(f"a screen of {self.size} pixels: give rows and columns, whole numbers of 1 or more")

    @cached_property
    def axes(self) -> np.ndarray:
        """(3, 3): the camera's axes in the world, in rows: to the right, upwards and forward."""
        forward = unit(np.subtract(self.target, self.eye))
        right = unit(np.cross(forward, [0.0, 0.0, 1.0]))
        return np.array([right, np.cross(right, forward), forward])

    @property
    def focal(self) -> float:
        """Focal length: the pixels that one metre covers at a depth of one metre; at depth d it is focal / d."""
        return self.size[0] / (2 * np.tan(np.radians(self.angle) / 2))

    def project(self, points: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """World points (k, 3) to (rows (k,), columns (k,), depths (k,)): pixels, and metres along the view axis."""
        right, up, depth = self.axes @ (np.asarray(points, dtype=np.float64) - self.eye).T
        far = np.where(depth > 0, depth, np.nan)
        h, w = self.size
        return (h - 1) / 2 - up / far * self.focal, (w - 1) / 2 + right / far * self.focal, depth

    def directions(self, rows: np.ndarray, columns: np.ndarray) -> np.ndarray:
        """Unit directions (k, 3) of the rays through pixels."""
        h, w = self.size
        right, up, forward = self.axes
        across = ((np.asarray(columns) - (w - 1) / 2) / self.focal)[:, None]
        down = (((h - 1) / 2 - np.asarray(rows)) / self.focal)[:, None]
        return unit(forward + across * right + down * up)


def fly(eyes: ArrayLike, targets: ArrayLike, frames: int, angle: float, size: Sequence[int]) -> list[Camera]:
    """Cameras along keyframes that are joined by a smooth curve.

    Parameters
    ----------
    eyes : (k, 3) array_like
        Positions of the camera in metres, at equal times.
    targets : (k, 3) array_like
        Points that the camera looks at, in metres.
    frames : int
        Number of cameras, 1 or more.
    angle : float
        Vertical view angle in degrees.
    size : sequence of 2 ints
        Rows and columns of a picture.

    Returns
    -------
    list of Camera
        One camera per frame.

    Raises
    ------
    ValueError
        Without a keyframe or a frame, and for keyframes that are not finite.

    References
    ----------
    Fritsch and Carlson, Monotone piecewise cubic interpolation, SIAM Journal on Numerical Analysis 17(2), 1980: the
    curve does not overshoot its keyframes.

    Examples
    --------
    >>> from haptic_glance import fly
    >>> path = fly([(3, 0, 1), (1, 0, 1)], [(0, 0, 0), (0, 0, 0)], frames=3, angle=40, size=(270, 480))
    >>> [float(camera.eye[0]) for camera in path]
    [3.0, 2.0, 1.0]
    """
    eye, target = np.asarray(eyes, dtype=np.float64), np.asarray(targets, dtype=np.float64)
    if eye.ndim != 2 or eye.shape[1:] != (3,) or eye.shape != target.shape or not len(eye) or frames < 1:
        raise ValueError("a camera path needs at least one frame, and keyframes with x, y, z of an eye and a target")
    if not (np.isfinite(eye).all() and np.isfinite(target).all()):
        raise ValueError("the keyframes of a camera path must be finite: an eye or a target holds NaN or infinity")
    if len(eye) > 1:
        knots, times = np.arange(len(eye)), np.linspace(0, len(eye) - 1, frames)
        eye, target = (scipy.interpolate.PchipInterpolator(knots, points)(times) for points in (eye, target))
    else:
        eye, target = np.repeat(eye, frames, axis=0), np.repeat(target, frames, axis=0)
    screen = size[0], size[1]
    return [Camera(tuple(place), tuple(aim), angle, screen) for place, aim in zip(eye, target, strict=True)]


KINDS = ("pixels", "ssim")
Box = tuple[np.ndarray, np.ndarray]  # low (3,), high (3,)


@dataclass(frozen=True)
class Placed:
    """An object in the world.

    Parameters
    ----------
    name : str
        Name of its mesh.
    position : tuple of 3 floats
        Middle of its foot, in metres.
    turn : float
        Angle about +z in degrees, counter-clockwise seen from above.
    size : float
        Longest side of its bounding box, in metres.
    """

    name: str
    position: tuple[float, float, float]
    turn: float
    size: float

    def pose(self, mesh: Mesh) -> "Pose":
        """The Pose of this object's mesh.

        Raises ValueError for a size that is not above 0, numbers that are not finite, and a mesh without faces or
        extent.
        """
        if not len(mesh.faces):
            raise ValueError(f"{self.name} has no faces to show")
        if not self.size > 0:
            raise ValueError(f"{self.name} is {self.size} m large: give its longest side, above 0")
        if not np.isfinite([*self.position, self.turn, self.size]).all():
            place = f"position {self.position}, turn {self.turn} and size {self.size}"
            raise ValueError(f"{self.name} has {place}: give finite numbers")
        low, high = bounding_box(mesh)
        if not (high - low).max() > 0:
            raise ValueError(f"{self.name} has no extent: all corners of its faces coincide")
        foot = np.array([*((low + high) / 2)[:2], low[2]])
        cos, sin = np.cos(np.radians(self.turn)), np.sin(np.radians(self.turn))
        turn = np.array([[cos, -sin, 0.0], [sin, cos, 0.0], [0.0, 0.0, 1.0]])
        return Pose(turn, self.size / (high - low).max(), foot, np.array(self.position, dtype=np.float64), (low, high))


@dataclass(frozen=True)
class Pose:
    """Rotation turn (3, 3); metres per unit, scale; foot (3,) in the mesh; position (3,) in the world; its box."""

    turn: np.ndarray
    scale: float
    foot: np.ndarray
    position: np.ndarray
    box: Box

    def to_world(self, points: np.ndarray) -> np.ndarray:
        """Points (k, 3) of the mesh in metres."""
        return (points - self.foot) @ self.turn.T * self.scale + self.position

    def to_mesh(self, points: np.ndarray) -> np.ndarray:
        """World points (k, 3) in the mesh's own coordinates."""
        return (points - self.position) @ self.turn / self.scale + self.foot

    def corners(self, box: Box | None = None) -> np.ndarray:
        """(8, 3) corners in the world of a box (low, high) in the mesh's own coordinates, or of the mesh's own."""
        low, high = box or self.box
        picks = np.array(np.meshgrid([0, 1], [0, 1], [0, 1])).reshape(3, 8).T
        return self.to_world(np.where(picks == 0, low, high))


@dataclass(frozen=True)
class Scene:
    """Objects, a camera path, and the tolerated error.

    Parameters
    ----------
    objects : sequence of Placed
        One or more objects.
    cameras : sequence of Camera
        One camera per frame.
    tolerance : float
        Tolerated error above 0: pixels of the screen (kind `pixels`), or a loss of structure, 1 - SSIM (kind `ssim`).
    kind : {"pixels", "ssim"}
        Unit of the tolerance.
    limit : int
        Most faces of all objects of a frame together; 0 for no limit.
    hold : int
        Fewest frames that a level stays, but for the first and the last one of an object.

    Raises
    ------
    ValueError
        For values out of range.

    Examples
    --------
    >>> from haptic_glance import Placed, Scene, fly
    >>> path = fly([(3, 0, 1), (1, 0, 1)], [(0, 0, 0), (0, 0, 0)], frames=5, angle=40, size=(270, 480))
    >>> len(Scene([Placed("duck", (0, 0, 0), turn=0, size=1)], path, tolerance=1.0).cameras)
    5
    """

    objects: tuple[Placed, ...]
    cameras: tuple[Camera, ...]
    tolerance: float
    kind: str = "pixels"
    limit: int = 0
    hold: int = 3

    def __post_init__(self) -> None:
        if not self.objects or not self.cameras:
            raise ValueError("a scene needs at least one object and one camera")
        if not (np.isfinite(self.tolerance) and self.tolerance > 0):
            raise ValueError(
                f"the tolerance is {self.tolerance}: it must be above 0, since only the full mesh has no error"
            )
        if self.kind not in KINDS:
            raise ValueError(f"unknown kind of tolerance {self.kind!r}: choose one of {', '.join(KINDS)}")
        if not self.limit >= 0 or not isinstance(self.hold, int | np.integer) or self.hold < 1:
            raise ValueError(f"limit ({self.limit}) must be 0 or more, and hold ({self.hold}) a whole number from 1")

    def poses(self, meshes: Mapping[str, Mesh]) -> list[Pose]:
        """One Pose per object; ValueError for an object without a mesh, or an eye in the box of one."""
        missing = sorted({placed.name for placed in self.objects} - set(meshes))
        if missing:
            raise ValueError(f"no mesh of {', '.join(missing)}: there are {', '.join(sorted(meshes)) or 'none'}")
        poses = [placed.pose(meshes[placed.name]) for placed in self.objects]
        for placed, pose in zip(self.objects, poses, strict=True):
            eyes = pose.to_mesh(np.array([camera.eye for camera in self.cameras]))
            inside = np.flatnonzero(((eyes >= pose.box[0]) & (eyes <= pose.box[1])).all(axis=1))
            if len(inside):
                place = f"{placed.name} at {tuple(placed.position)}"
                raise ValueError(f"the camera of frame {inside[0]} is in the bounding box of {place}: move one of them")
        return poses


def world_mesh(mesh: Mesh, pose: Pose) -> Mesh:
    """The mesh in world coordinates, in metres."""
    return Mesh(pose.to_world(mesh.vertices), mesh.faces, mesh.colors)

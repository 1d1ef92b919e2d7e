"""The imprint of a sensor at one place, and where each of its cells met the object: the touch panels, free of viser."""

from dataclasses import dataclass, replace

import numpy as np

from haptic_glance.know import Library
from haptic_glance.know.belief import Touch
from haptic_glance.touch import Layer, Skin, Surface, distances_at, sensor_axes
from haptic_glance.touch.force import gaps_at, press_forces
from haptic_glance.touch.places import Places, place_at
from haptic_glance.touch.press import normalise
from haptic_glance.touch.quasi_tangent import contour_imprints, quasi_tangent
from haptic_glance.touch.surface import turned

from .specimen import Hit

RAYS, RIGID, CONTOURS, NEWTONS = "rays", "rays, rigid plate", "contours", "newtons"
SENSORS = (RAYS, RIGID, CONTOURS, NEWTONS)
UNIT = "units of the file"
LAYER = Layer(thickness=0.004)  # metres: soft foam, thick enough for a finger's load
LIFT = 0.003  # units above the surface, so that it does not show through


@dataclass(frozen=True)
class Sensor:
    """The values of the sliders. kind: one of SENSORS; cells: of each side; pitch: units from cell to cell.

    blur: of the elastic skin, in cells; noise: of full scale; turn: degrees about the normal, counter-clockwise seen
    from outside; load: newtons on the whole array and size: of the object, in metres, for NEWTONS alone.
    """

    kind: str = RAYS
    cells: int = 16
    pitch: float = 0.01
    blur: float = 0.0
    noise: float = 0.0
    turn: float = 0.0
    load: float = 1.0
    size: float = 0.1

    @property
    def array(self) -> tuple[int, int]:
        """(rows, columns)."""
        return self.cells, self.cells


@dataclass(frozen=True)
class Felt:
    """The touch at one place.

    pressed (rows, cols) in 0..1, 1 where the array is pressed hardest. span: what 0 and 1 stand for, in `unit`.
    centre (3,), axes (3, 3) rows right, up, normal, pitch: the array's pose, in units of the mesh. depths (rows, cols):
    from the array to the surface, in units; inf where nothing was met.
    """

    pressed: np.ndarray
    span: tuple[float, float]
    unit: str
    centre: np.ndarray
    axes: np.ndarray
    pitch: float
    depths: np.ndarray

    @property
    def corners(self) -> np.ndarray:
        """(4, 3) the array's corners, row 0 first, lifted to where it first meets the object."""
        rows, columns = self.depths.shape
        right, up, normal = self.axes
        lift = -min(self.depths.min(), 0.0) if np.isfinite(self.depths.min()) else 0.0
        signs = np.array([[-1, 1], [1, 1], [1, -1], [-1, -1]])
        across = signs[:, :1] * columns * right + signs[:, 1:] * rows * up
        return self.centre + lift * normal + LIFT * normal + self.pitch / 2 * across

    @property
    def contacts(self) -> tuple[np.ndarray, np.ndarray]:
        """(places (k, 3) on the object of the cells that met it, what each of them feels (k,), of `pressed`)."""
        rows, columns = self.depths.shape
        right, up, normal = self.axes
        row, column = np.nonzero(np.isfinite(self.depths))
        x, y = column - (columns - 1) / 2, (rows - 1) / 2 - row
        on_array = self.centre + self.pitch * (x[:, None] * right + y[:, None] * up)
        return on_array + (LIFT - self.depths[row, column])[:, None] * normal, self.pressed[row, column]


def place_of(surface: Surface, hit: Hit) -> Places:
    """The place of a click on the surface."""
    return place_at(surface, hit.position[None], np.array([hit.face]))


def feel(surface: Surface, place: Places, sensor: Sensor, unit: float = 1.0) -> Felt:
    """Presses the sensor at the first of the places. unit: of the mesh, in those of its file.

    CONTOURS is felt at vertices alone. Raises ValueError for it where the place is none, and as `press_forces` does.
    """
    if sensor.kind != CONTOURS:
        axes = turned(sensor_axes(place.normals[:1]), sensor.turn)
        return feel_in_pose(surface, place.positions[0], axes[0], sensor, unit)
    if place.vertices[0] < 0:
        raise ValueError("contours are felt at vertices alone: click nearer to a corner of a face, or take rays")
    (centre,), (axes,) = quasi_tangent(surface.mesh, place.vertices[:1])
    images = contour_imprints(surface, place.vertices[:1], sensor.array, sensor.pitch)
    by_rays = feel_in_pose(surface, centre, axes, replace(sensor, kind=RAYS))
    return replace(by_rays, pressed=_pressed(images, sensor), span=(0.0, 1.0), unit="shares of the planes")


def feel_in_pose(surface: Surface, centre: np.ndarray, axes: np.ndarray, sensor: Sensor, unit: float = 1.0) -> Felt:
    """Presses the sensor, which is not CONTOURS, at a centre (3,) with axes (3, 3). unit: as of `feel`."""
    pose, array, reach = (centre[None], axes[None]), (sensor.array, sensor.pitch), sensor.cells * sensor.pitch
    if sensor.kind == NEWTONS:
        force = press_forces(surface, *pose, LAYER, *array, sensor.load, unit=sensor.size)
        images, span, name = 1 - force / force.max(), (0.0, float(force.max())), "newtons"
    else:
        distances = distances_at(surface, *pose, *array, contact="rigid" if sensor.kind == RIGID else "tangent")
        images, span, name = normalise(distances, sensor.pitch), (unit * float(np.ptp(distances)), 0.0), UNIT
    if sensor.kind == RAYS:
        depths = np.where(distances < reach, distances, np.inf)
    else:  # the plate comes from above, and meets what overhangs the place
        depths = gaps_at(surface, *pose, reach, *array)
    return Felt(_pressed(images, sensor), span, name, centre, axes, sensor.pitch, depths[0])


def felt_by(touch: Touch, library: Library, unit: float = 1.0) -> Felt:
    """What a touch of a belief has felt; 0 where the object is below the array's depth. unit: as of `feel`."""
    array, relief = library.sensor, touch.relief.reshape(library.sensor.cells)
    imprint, deepest = array.depth * relief, array.depth - 3 * array.relief_noise  # noise lifts a cell that met nothing
    depths = np.where(imprint < deepest, imprint, np.inf)
    centre, span = touch.contact * library.diameter, (unit * array.depth, 0.0)
    return Felt(1 - relief, span, UNIT, centre, touch.approach.axes, array.pitch, depths)


def _pressed(images, sensor):
    """(rows, cols) the first of the images as the skin passes it on, 1 where it is pressed hardest."""
    return 1 - Skin(blur=sensor.blur, noise=sensor.noise)(images)[0]

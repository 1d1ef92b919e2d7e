"""The skin of the array: faults of a real sensor, the elastic layer, and lengths as people write them (T4.2.3).

The faults are lag, gain, noise, saturation and dead cells. The elastic layer turns an indentation into a pressure, in
physical units.
"""

import functools
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike
from scipy.ndimage import gaussian_filter

from haptic_glance.base.rng import rng

LIMITS = {"gain": (0, np.inf), "saturation": (0, 1), "blur": (0, 1000), "hysteresis": (0, 1), "noise": (0, np.inf),
          "dead": (0, 1)}  # fmt: skip
POSITIVE = ("gain", "saturation")


@dataclass(frozen=True)
class Skin:
    """A sensor as T4.2.3 describes it (force-sensing resistors below an elastic skin), applied to ideal imprints.

        skin = Skin(blur=0.8, hysteresis=0.05, noise=0.02, dead=0.02)
        images = skin(press_many(mesh, vertices))

    A sensel of an elastic skin over a rigid array measures how deep the object indents the skin above it (the elastic
    foundation of Winkler; Johnson, Contact Mechanics, 1985, section 4.3). An imprint contains this depth: 1 - image is
    the depth as a share of the imprint's relief, for an array pressed until its farthest cell touches. `indent` gives
    the imprint of an array pressed less, or more. So the steps apply to 1 - image, the load, in the order below. Values
    are shares of full scale unless another unit is given. The defaults change nothing.

    blur: standard deviation, in cells, of the Gaussian by which the skin spreads the load. Reflection at the border
    keeps the sum. An elastic cover is a low-pass filter on the load (Shimojo 1997, IEEE Trans. Robotics and Automation
    13); the Gaussian is our approximation of its kernel. hysteresis: how far a sensel lags behind its load, 0..1: the
    reading of a rising load is too low by this amount, that of a falling one too high. One play operator
    (Krasnosel'skii and Pokrovskii 1989, Systems with Hysteresis); sums of them fit tactile sensors of this kind
    (Sanchez-Duran et al. 2012, Microsystem Technologies 18). gain: reading per load, which depends on the force and the
    amplifier. noise: standard deviation of white Gaussian noise of the electronics, drawn for each imprint. saturation:
    the highest reading, in (0, 1]: above some force the resistance of an FSR does not fall further. A reading is never
    below 0. dead: share of the cells that always read 0. They belong to the sensor: the same in every imprint, drawn by
    seed and size of the array. The dead cells of a smaller share are among those of a larger one. seed: of the dead
    cells and the noise.

    Raises ValueError for values out of range. Each step can be left out; none depends on the other imprints.
    """

    blur: float = 0.0
    gain: float = 1.0
    saturation: float = 1.0
    hysteresis: float = 0.0
    noise: float = 0.0
    dead: float = 0.0
    seed: int = 0

    def __post_init__(self) -> None:
        for name, (low, high) in LIMITS.items():
            value = getattr(self, name)
            valid = isinstance(value, int | float | np.number) and low <= value <= high and np.isfinite(value)
            if not valid or (name in POSITIVE and value == 0):
                lower = "above 0" if name in POSITIVE else "0 or more"
                upper = f" and at most {high}" if high < np.inf else ""
                raise ValueError(f"{name} must be {lower}{upper}, got {value}")
        if not isinstance(self.seed, int | np.integer) or self.seed < 0:
            raise ValueError(f"seed must be an integer of 0 or more, got {self.seed}")

    def __call__(self, images: ArrayLike, name: str = "", first: int = 0) -> np.ndarray:
        """The imprints as this sensor measures them: f4 of the same shape, in 0..1.

        images: (k, rows, cols) in 0..1 as `press_many` gives them, each of a skin at rest; or (k, frames, rows, cols),
        k sequences whose frames follow each other, so that hysteresis has a history (a frame of ones between two
        touches lifts the array). name, first: the object's name and the number of the first imprint, used for the noise
        alone: imprint i of a name has the same noise in every batch.
        """
        images = np.asarray(images)
        if images.ndim not in (3, 4):
            raise ValueError(f"imprints must have shape (k, rows, cols) or (k, frames, rows, cols), got {images.shape}")
        if images.size and not (images.min() >= 0 and images.max() <= 1):  # NaN fails as well
            raise ValueError("imprints must be in 0..1: apply normalise or indent to the distances first")
        load = self._spread(1 - images.astype(np.float64))
        reading = self.gain * self._lagged(load) + self._noise(images.shape, name, first)
        reading = np.clip(reading, 0, self.saturation)
        reading[..., dead_cells(images.shape[-2:], self.dead, self.seed)] = 0
        return (1 - reading).astype(np.float32)

    def _spread(self, load):
        sigma = (0,) * (load.ndim - 2) + (self.blur, self.blur)
        return gaussian_filter(load, sigma, mode="reflect") if self.blur else load

    def _lagged(self, load):
        """The play operator along the frames from an unloaded start; a single touch is a sequence of one frame."""
        if not self.hysteresis:
            return load
        frames = load if load.ndim == 4 else load[:, None]
        lagged, previous = np.empty_like(frames), np.zeros(frames.shape[:1] + frames.shape[2:])
        for frame in range(frames.shape[1]):
            current = frames[:, frame]
            lagged[:, frame] = previous = np.clip(previous, current - self.hysteresis, current + self.hysteresis)
        return lagged.reshape(load.shape)

    def _noise(self, shape, name, first):
        if not self.noise:
            return 0.0
        draws = [rng(self.seed, f"noise {name} {first + i}").standard_normal(shape[1:]) for i in range(shape[0])]
        return self.noise * np.array(draws).reshape(shape)


def as_shares(images: np.ndarray) -> np.ndarray:
    """Images, u1 or floats in 0..1, as f4 in 0..1; ValueError for other values."""
    shares = images.astype(np.float32) / (255 if images.dtype == np.uint8 else 1)
    if not ((shares >= 0) & (shares <= 1)).all():  # NaN fails as well
        raise ValueError("images must be bytes, or numbers in 0..1")
    return shares


@functools.cache
def dead_cells(cells: tuple[int, int], share: float, seed: int = 0) -> np.ndarray:
    """(rows, cols) boolean: the dead cells, a share of all, of an array of `cells` (rows, cols) with this seed."""
    order = rng(seed, f"dead {cells[0]}x{cells[1]}").permutation(cells[0] * cells[1]).reshape(cells)
    dead = order < round(share * order.size)
    dead.flags.writeable = False  # all sensors of this kind share it
    return dead


def indent(distances: ArrayLike, depth: float) -> np.ndarray:
    """(k, rows, cols) f4 in 0..1: imprints of a skin that the object's highest point indents by `depth` units.

    distances: (k, rows, cols) from haptic_glance.touch.distances, in units of the mesh; depth: in units, above 0, the
    same for all. 0 is the cell indented deepest, 1 a cell that the object does not touch. Unlike `normalise`, which
    scales every imprint to 0..1, this keeps shallow imprints shallow, like a sensor pressed to a fixed depth.
    """
    distances = np.asarray(distances, dtype=np.float64)
    if distances.ndim != 3:
        raise ValueError(f"distances must have shape (k, rows, cols), got {distances.shape}")
    if not (np.isfinite(depth) and depth > 0):
        raise ValueError(f"depth must be a positive number of units, got {depth}")
    if not np.isfinite(distances).all():
        raise ValueError("distances must be finite numbers of units")
    depths = distances - distances.min(axis=(1, 2), keepdims=True)
    return np.minimum(depths / depth, 1).astype(np.float32)


LAYER_LIMITS = {"thickness": (0, np.inf), "modulus": (0, np.inf), "poisson": (-1, 0.5), "friction": (0, np.inf)}
LAYER_UNITS = {"thickness": "metres", "modulus": "pascals"}


@dataclass(frozen=True)
class Layer:
    """A foam or soft rubber bonded to the rigid array, as Winkler's elastic foundation: a bed of separate springs.

    Parameters
    ----------
    thickness : float
        Metres.
    modulus : float
        Young's modulus, in pascals.
    poisson : float
        Poisson's ratio, below 0.5.
    friction : float
        Coulomb's coefficient between layer and object.

    Raises
    ------
    ValueError
        For values out of range.

    Notes
    -----
    The defaults are 2 mm of a soft open-celled foam. The pressure of a spring grows with its own indentation alone.
    This holds for a layer that is thin against the contact and compressible. A rubber near a Poisson's ratio of 0.5
    bulges sideways, and this model is too stiff for it.

    References
    ----------
    Johnson, Contact Mechanics, 1985, sections 4.3 and 5.8.

    Examples
    --------
    >>> from haptic_glance import Layer
    >>> Layer(thickness=0.002, modulus=2e5).thickness
    0.002
    """

    thickness: float = 0.002
    modulus: float = 2e5
    poisson: float = 0.2
    friction: float = 0.6

    def __post_init__(self) -> None:
        for name, (low, high) in LAYER_LIMITS.items():
            value = getattr(self, name)
            if not (isinstance(value, int | float | np.number) and low < value < high):  # NaN fails as well
                upper = f" and below {high}" if high < np.inf else ", finite"
                unit = f" {LAYER_UNITS[name]}" if name in LAYER_UNITS else ""
                raise ValueError(f"layer: {name} must be above {low}{unit}{upper}, got {value}")

    @property
    def stiffness(self) -> float:
        """Pressure per indentation, in Pa/m: the layer cannot spread sideways (Johnson 1985, section 5.8)."""
        confined = (1 - self.poisson) / ((1 + self.poisson) * (1 - 2 * self.poisson))
        return self.modulus * confined / self.thickness

    @property
    def shear_stiffness(self) -> float:
        """Shear traction per tangential displacement, in Pa/m: simple shear of the layer."""
        return self.modulus / (2 * (1 + self.poisson)) / self.thickness


METRES = {"mm": 0.001, "cm": 0.01, "in": 0.0254, "m": 1.0}  # m last, as the others may end with it


class Metres(float):
    """A length in metres, which becomes one in units of the mesh when its size is known."""


def length(text: str) -> float:
    """A number of units of the mesh, or Metres from a length such as 1mm, 0.5cm or 0.1in."""
    unit = next((name for name in METRES if text.strip().endswith(name)), "")
    number = float(text.strip().removesuffix(unit))
    return Metres(number * METRES[unit]) if unit else number

"""An object that a person or the planner touches until it is recognised; the planner touches where it gains most."""

from functools import cached_property

import numpy as np

from haptic_glance.mesh.files import MeshLike, with_known_up
from haptic_glance.touch import Surface, press_at, sensor_axes
from haptic_glance.touch.places import Places
from haptic_glance.touch.surface import as_surface, turned

from .library import CELLS, PITCH, SURE, Belief, Expected, Library, check_scale, sample_places

PLACES = 64  # where the planner may touch
FRESH = 0.04  # units, a quarter of the array: nearer to a touched place there is little new
MOST = 30  # touches after which the planner gives up
WORTHLESS = 1e-3  # nats: a touch that promises less does not help


class Exploration:
    """The touches of one object and the belief that follows from them.

    Neither the planner nor the belief asks what the object is; the planner knows 64 places on it, drawn at random.

    Parameters
    ----------
    library : Library
        The known objects, from `learn`.
    surface : Surface, Mesh or any input of `as_mesh`
        The object, scaled by `normalise` as the library's objects are, with z up. It is touched by the sensor that the
        library was learned with; each array is turned at random about its normal if the library was learned so.
    random : numpy.random.Generator
        Draws the places, and the turns of the arrays.

    Raises
    ------
    ValueError
        For an object of another scale, or with another axis up.
    TypeError
        For a `random` that is no Generator, such as a seed.

    Examples
    --------
    >>> import numpy as np
    >>> from haptic_glance.know import Exploration, learn, primitives
    >>> shapes = primitives()
    >>> library = learn({name: shapes[name] for name in ("box", "cylinder")}, placed=False)
    >>> exploration = Exploration(library, shapes["box"], np.random.default_rng(0))
    >>> exploration.touch(exploration.next_place()).shape
    (16, 16)
    >>> sorted(exploration.belief.probabilities)
    ['box', 'cylinder']
    """

    def __init__(self, library: Library, surface: "MeshLike | Surface", random: np.random.Generator) -> None:
        if not isinstance(random, np.random.Generator):
            raise TypeError(f"random must be a numpy.random.Generator such as default_rng(0), got {random!r}")
        self.library = library
        self.surface = as_surface(surface if isinstance(surface, Surface) else with_known_up(surface))
        check_scale(self.surface.mesh)
        if self.surface.mesh.up != "z":
            raise ValueError(
                f"the object has {self.surface.mesh.up} up, and was learned with z up: call rotate_to_z_up"
            )
        self.candidates = sample_places(self.surface, PLACES, random)
        self.positions = np.zeros((0, 3))  # of the touches so far
        self.axes = np.zeros((0, 3, 3))  # of the arrays
        self.images = np.zeros((0, *CELLS), dtype=np.float32)  # what was felt there
        self.beliefs = [library.belief()]
        self._noise = "" if library.skin is None else f"exploration {random.integers(2**31)}"
        self._turns = np.random.default_rng(random.integers(2**31)) if library.turned else None

    @property
    def belief(self) -> Belief:
        """The belief after the last touch."""
        return self.beliefs[-1]

    def touch(self, place: Places) -> np.ndarray:
        """(rows, cols) f4: the imprint at the first of the places, by which the belief is updated.

        A second touch of the same place feels the same but for the noise and the turn of the array, so the belief stays
        as it is.
        """
        position, axes = place.positions[:1], sensor_axes(place.normals[:1])
        if self._turns is not None:
            axes = turned(axes, 360 * self._turns.random())
        image = press_at(self.surface, position, axes, CELLS, PITCH)[0]
        if self.library.skin is not None:
            image = self.library.skin(image[None], self._noise, len(self.images))[0]
        is_repeat = (self.positions == position).all(axis=1).any()
        self.positions = np.concatenate([self.positions, position])
        self.axes = np.concatenate([self.axes, axes])
        self.images = np.concatenate([self.images, image[None]])
        self.beliefs.append(self.belief if is_repeat else self.belief.after(image, position[0]))
        return image

    @cached_property
    def expected(self) -> Expected:
        """The possible findings of touches at the candidates."""
        return self.library.expect(self.candidates)

    def gains(self) -> np.ndarray:
        """(k,) nats that a touch at each candidate promises; -inf near a place that was touched."""
        distances = np.linalg.norm(self.candidates.positions[:, None] - self.positions[None], axis=2)
        return np.where((distances > FRESH).all(axis=1), self.library.gains(self.belief, self.expected), -np.inf)

    def next_place(self) -> Places | None:
        """The place at which the belief is expected to gain most; None where no fresh place promises anything.

        If the object may be unknown, and the likeliest known object is sure among the known ones, it is the first fresh
        place: the touches are then compared with those of this object, which were at random places, too.
        """
        gains = self.gains()
        if gains.max() > WORTHLESS and not (self.library.verifier and self.belief.among_known.max() >= SURE):
            return self.candidate(int(gains.argmax()))
        fresh = np.flatnonzero(np.isfinite(gains))
        return self.candidate(int(fresh[0])) if self.library.verifier and len(fresh) else None

    def finish(self, most: int = MOST) -> str:
        """Lets the planner touch until an object is known, whose name is returned; empty where it gives up.

        "none of these", if the library was learned with `unknown` and it is none of its objects.
        """
        while not self.belief.known and len(self.images) < most and (place := self.next_place()) is not None:
            self.touch(place)
        return self.belief.known

    def candidate(self, number: int) -> Places:
        """One of the candidates."""
        places = self.candidates
        return Places(places.vertices[[number]], places.positions[[number]], places.normals[[number]])

"""A library of objects known by touch: imprints of each, and how likely a new imprint is under each of them."""

import hashlib
from collections.abc import Mapping
from dataclasses import dataclass
from functools import lru_cache

import numpy as np

from stages.exploration import Calibration, calibrate
from stages.exploration.choose import State, by_gain
from stages.exploration.likelihood import FLOOR, feature_kernel, log_likelihood, place_kernel
from stages.exploration.outcomes import nearest_outcomes
from stages.imprints import Surface, press_at, sensor_axes
from stages.imprints.user_mesh import Places
from stages.kit import Mesh
from stages.kit.extras import from_extra
from stages.kit.rng import rng

from .belief import Belief
from .places import sample_places

with from_extra():
    from stages.classification import features

TOUCHES = 128  # a learned object; twice as many know no more of the household objects
CELLS, PITCH = (16, 16), 0.01  # of the array, T4.3
ORDERS, LONGEST = 5, 20  # random orders of each object's touches, and touches of each, for the calibration
BLOCK = 256  # touches compared at once, in the processor's cache
AWAY = np.exp(-3.0)  # weight of no learned touch at a place: of one three widths of `place_kernel` away


def learn(meshes: Mapping[str, Mesh], placed: bool = True, seed: int = 0) -> "Library":
    """The Library of meshes {name: mesh}, each scaled by `normalise`; a mesh that was learned before costs nothing.

    Raises ValueError for fewer than two, and for a mesh that cannot be touched, with its name.
    """
    if len(meshes) < 2:
        raise ValueError("at least two objects are needed: with one there is nothing to tell apart")
    return _library(tuple(_Named(name, mesh, seed) for name, mesh in sorted(meshes.items())), placed)


def touched(name: str, mesh: Mesh, seed: int = 0) -> np.ndarray:
    """(TOUCHES, 41) features of the touches by which `learn` knows a mesh; ValueError where it cannot be touched."""
    return _learned(_Named(name, mesh, seed))[0]


@dataclass(frozen=True)
class Expected:
    """What touches at k places may find, whatever is believed: predicted and probabilities of stages.exploration.State.

    predicted (k, classes, outcomes, classes): log likelihoods of possible touches if it is this object;
    probabilities (k, classes, outcomes): of each, if it is this object.
    """

    predicted: np.ndarray
    probabilities: np.ndarray


class Library:
    """Objects known by touch.

    names: of the objects; samples (classes, touches, 41) their features; positions (classes, touches, 3) where they
    were touched. The likelihood of an imprint is that of stages.exploration: a kernel density of its components; if the
    objects are `placed`, that is, stand as they were learned, of the touches near its place. A learned touch is used
    like a new one when it is compared with all others but itself; that calibrates the belief.
    """

    def __init__(
        self, names: tuple[str, ...], samples: np.ndarray, positions: np.ndarray, placed: bool, seed: int = 0
    ) -> None:
        with from_extra():
            from sklearn.pipeline import make_pipeline

            from stages.classification.scaling import reduction
        self.names, self.placed, (classes, self._each) = names, placed, samples.shape[:2]
        self._owners = np.repeat(np.arange(classes), self._each)
        self._reduction = make_pipeline(*reduction()).fit(flat := samples.reshape(-1, samples.shape[2]))
        self._components, self._positions = self._reduction.transform(flat), positions.reshape(-1, 3)
        self._own = self._of_own_touches()
        self.calibration: Calibration = self._calibrate(rng(seed, "calibration"))

    def belief(self) -> Belief:
        """The Belief before the first touch: all objects alike."""
        return Belief(self, np.zeros(len(self.names)))

    def log_likelihoods(self, images: np.ndarray, positions: np.ndarray) -> np.ndarray:
        """(k, classes) log likelihoods of imprints (k, *CELLS) at positions (k, 3) under each object, to a constant."""
        if np.shape(images)[1:] != CELLS:
            raise ValueError(f"this library was learned with {CELLS} cells, the imprints have {np.shape(images)[1:]}")
        kernel = feature_kernel(self._reduction.transform(features(images)), self._components)
        return self._log_likelihood(kernel, np.asarray(positions), np.arange(len(self._owners)))

    def expect(self, places: Places) -> Expected:
        """What touches at places may find: if it were object c, one of the learned touches of c near the place.

        Near in the frame in which c was learned, even where the objects are not `placed`, as in stages.exploration.
        """
        distances = np.linalg.norm(places.positions[:, None] - self._positions[None], axis=2)
        outcomes, probabilities = nearest_outcomes(distances, self._owners)
        if not self.placed:
            return Expected(self._own[outcomes], probabilities)
        predicted = [self._at_place(*at) for at in zip(places.positions, outcomes, strict=True)]
        return Expected(np.stack(predicted), probabilities)

    def gains(self, belief: Belief, expected: Expected) -> np.ndarray:
        """(k,) nats by which the entropy of the belief is expected to fall with a touch at each of k places."""
        nothing = np.zeros((1, len(expected.predicted)))
        parts = nothing, expected.predicted[None], expected.probabilities[None], self.calibration
        now = belief.values[belief.values > 0]
        return by_gain(State(belief.log_likelihoods[None], belief.touches, *parts))[0] - now @ np.log(now)

    def _log_likelihood(self, kernel, positions, ids):
        """(k, classes) of touches at positions (k, 3) whose kernel (k, n) with the learned touches `ids` is given.

        The kernel is 0 for a learned touch that must not count. If the objects are placed, it is the likelihood of
        what was felt given the place: a person or the planner chose it, which says nothing of the object.
        """
        owners = self._owners[ids]
        if not self.placed:
            return log_likelihood(kernel, owners, (kernel > 0) @ np.eye(len(self.names))[owners])
        near, of_object = place_kernel(positions, self._positions[ids]) * (kernel > 0), np.eye(len(self.names))[owners]
        return np.log(np.maximum((kernel * near) @ of_object / (near @ of_object + AWAY), FLOOR))

    def _of_own_touches(self):
        """(n, classes) log likelihoods of the learned touches, each without itself."""
        rows, parts = np.arange(len(self._components)), []
        for block in np.split(rows, rows[BLOCK::BLOCK]):
            kernel = feature_kernel(self._components[block], self._components)
            kernel[np.arange(len(block)), block] = 0
            parts.append(self._log_likelihood(kernel, self._positions[block], rows))
        return np.concatenate(parts)

    def _at_place(self, position, outcomes):
        """(classes, outcomes, classes) log likelihoods of touches like the `outcomes` (classes, outcomes), all here."""
        ids = outcomes.ravel()  # of farther touches the place kernel is next to nothing
        kernel = feature_kernel(self._components[ids], self._components[ids])
        np.fill_diagonal(kernel, 0)
        found = self._log_likelihood(kernel, position[None], ids)
        return found.reshape(*outcomes.shape, len(self.names))

    def _calibrate(self, random):
        own = self._own.reshape(len(self.names), self._each, -1)
        order = [random.permutation(self._each)[:LONGEST] for _ in range(ORDERS * len(self.names))]
        truth = np.repeat(np.arange(len(self.names)), ORDERS)
        return calibrate(own[truth[:, None], order], truth)


class _Named:
    """A mesh under a name; equal where name, seed and content are."""

    def __init__(self, name: str, mesh: Mesh, seed: int) -> None:
        content = hashlib.sha256(mesh.vertices.tobytes() + mesh.faces.tobytes()).hexdigest()
        self.name, self.mesh, self.key = name, mesh, (name, seed, content)
        self.seed = seed

    def __eq__(self, other: object) -> bool:
        return isinstance(other, _Named) and self.key == other.key

    def __hash__(self) -> int:
        return hash(self.key)


@lru_cache(maxsize=4)
def _library(objects: tuple[_Named, ...], placed: bool) -> Library:
    samples, positions = zip(*map(_learned, objects), strict=True)
    names = tuple(one.name for one in objects)
    return Library(names, np.stack(samples), np.stack(positions), placed, objects[0].seed)


@lru_cache(maxsize=256)
def _learned(one: _Named) -> tuple[np.ndarray, np.ndarray]:
    """(features (TOUCHES, 41), positions (TOUCHES, 3)) of an object."""
    try:
        surface = Surface(one.mesh)
        places = sample_places(surface, TOUCHES, rng(one.seed, one.name))
        images = press_at(surface, places.positions, sensor_axes(places.normals), CELLS, PITCH)
    except ValueError as error:
        raise ValueError(f"{one.name}: {error}") from None
    return features(images), places.positions

"""The belief over known objects and their poses: a look and touches change it, and it says where to touch next."""

from collections.abc import Callable, Iterable
from dataclasses import dataclass, field, replace
from functools import cached_property

import numpy as np
from numpy.typing import ArrayLike
from scipy.special import logsumexp

from haptic_glance.base.rng import rng
from haptic_glance.look.camera import Viewpoint

from .hypotheses import Hypotheses
from .library import AWAY, START, Library
from .particles import first_particles, refined
from .planner import CANDIDATES, TRUTHS, draw, expected_entropy
from .pressure_array import Approach, check_touch
from .unknown import NONE

SURE = 0.95  # probability at which an object is known
MISLED = 0.01  # probability that a picture tells nothing of the object
LINES, PRESSED_LINES = 384, 32  # along which a next touch is considered, where a table or presses predict it
NEGLIGIBLE = -40.0  # log weight, relative to the greatest, below which a hypothesis is not predicted any more
RADIUS = 0.5  # diameters, of the largest object
FARTHEST = 2.0  # diameters from the origin, where a hand that met an object can be
NEAREST = 0.02  # share of the way to the largest object, after which a hand cannot have met it
Reachable = Callable[[np.ndarray, np.ndarray], np.ndarray]


@dataclass(frozen=True)
class Touch:
    """One touch: along which line, its travel and relief in diameters and shares of the depth, and its contact."""

    approach: Approach
    travel: float
    relief: np.ndarray
    contact: np.ndarray
    weight: float


@dataclass(frozen=True)
class Pose:
    """How an object stands: rotation (3, 3), shift (3,) in the unit of the meshes, size as a share of the mesh's."""

    rotation: np.ndarray
    shift: np.ndarray
    size: float

    @property
    def turn(self) -> float:
        """Degrees about the up axis, of an object that stands."""
        return float(np.degrees(np.arctan2(self.rotation[1, 0], self.rotation[0, 0])) % 360)


@dataclass(frozen=True)
class Belief:
    """Probabilities of objects and poses, from `Library.belief` or `Library.look`.

    Attributes
    ----------
    library : Library
        The known objects.
    hypotheses : Hypotheses
        Objects in poses.
    log_weights : (h,) array of float
        Their log probabilities, to a constant of the touches.
    felt : (h,) array of float
        The part of these that the touches alone contribute.
    touches : tuple of Touch
        The touches so far.
    """

    library: Library
    hypotheses: Hypotheses
    log_weights: np.ndarray
    felt: np.ndarray
    touches: tuple[Touch, ...] = field(default=())

    def among(self, names: Iterable[str]) -> "Belief":
        """The belief if the object is one of some names of the library; ValueError for another name, and for none."""
        names = set(names)
        if unknown := sorted(names - set(self.library.names)):
            raise ValueError(f"unknown object {unknown[0]!r}: choose from {', '.join(self.library.names)}")
        kept = np.array([name in names for name in self.library.names])
        if not kept.any():
            raise ValueError("give at least one name")
        return replace(self, log_weights=np.where(kept[self.hypotheses.objects], self.log_weights, -np.inf))

    def look(self, picture: ArrayLike, camera: Viewpoint | None = None, hidden: ArrayLike | None = None) -> "Belief":
        """The belief after a look.

        Parameters
        ----------
        picture : (h, w) or (h, w, 3) array of uint8
            A picture against a dark background. Its rows span `library.span`, its middle shows the origin.
        camera : Viewpoint, optional
            From where the camera looks; None if that is unknown.
        hidden : (h, w) array of bool, optional
            True where something else is seen than the object and its background.

        Returns
        -------
        Belief
            The belief after the look.

        Raises
        ------
        ValueError
            For a picture of another kind, one that shows nothing, one that is all hidden, and a camera that looks from
            below the table.
        """
        evidence = self.library.of_picture(picture, camera, hidden)
        evidence = evidence - logsumexp(evidence) + np.log(len(evidence))  # so that the mean likelihood is 1
        evidence = np.logaddexp(np.log(1 - MISLED) + evidence, np.log(MISLED))
        of_pose = evidence.reshape(len(self.library.names), -1)[self.hypotheses.objects, self.hypotheses.poses]
        return replace(self, log_weights=self.log_weights + of_pose)

    def after(self, approach: Approach, travel: float, imprint: ArrayLike) -> "Belief":
        """The belief after a touch.

        Parameters
        ----------
        approach : Approach
            The line along which the hand came, of `next_touch` or `Library.approach`.
        travel : float
            How far it moved until first contact, in the unit of the meshes; inf where it met nothing.
        imprint : (rows, cols) array_like
            How far the surface lies below each cell at first contact, in the unit of the meshes; not read where nothing
            was met.

        Returns
        -------
        Belief
            The belief after the touch.

        Raises
        ------
        ValueError
            For numbers that no touch of this array gives; a travel after which the array is still far from any object
            is in another unit.
        """
        library = self.library
        touch = self._touch(approach, travel, imprint)
        touches = (*self.touches, touch)
        if self.hypotheses.is_grid and approach.line >= 0:
            evidence = _evidence(library, self.hypotheses, touch)
        else:
            likely = np.flatnonzero(self.log_weights > self.log_weights.max() + NEGLIGIBLE)
            evidence = np.full(len(self.hypotheses), NEGLIGIBLE)
            evidence[likely] = _evidence(library, self.hypotheses[likely], touch)
        after = replace(self, log_weights=self.log_weights + evidence, felt=self.felt + evidence, touches=touches)
        if not library.tolerant:
            return after
        hypotheses, log_weights = refined(library, after.hypotheses, after.log_weights, touches, _evidence)
        return replace(after, hypotheses=hypotheses, log_weights=log_weights, felt=np.zeros(len(hypotheses)))

    def _touch(self, approach, travel, imprint):
        library, diameter = self.library, self.library.diameter
        if approach.array != library.sensor:
            raise ValueError("the touch is of another array than the one that the objects were learned with")
        if not travel < np.inf and not np.isnan(travel):
            imprint = np.full(library.sensor.cells, library.sensor.depth)
        travel, imprint = check_touch(travel, imprint, library.sensor)
        place = approach.contact(travel if np.isfinite(travel) else START * diameter)
        start, away = np.linalg.norm(approach.origin) / diameter - RADIUS, np.linalg.norm(place) / diameter
        if np.isfinite(travel) and (away > FARTHEST or travel / diameter < NEAREST * start):
            raise ValueError(
                f"a travel of {travel:g} ends {away:.3g} diameters of the largest object from the origin, where no "
                "object can be: give the travel in the unit of the meshes"
            )
        contact, before = place / diameter, np.array([one.contact for one in self.touches]).reshape(-1, 3)
        weight = float(library.likelihood.weight(np.linalg.norm(before - contact, axis=1)))
        travelled = travel / diameter if np.isfinite(travel) else AWAY
        return Touch(approach, travelled, imprint.ravel() / library.sensor.depth, contact, weight)

    @cached_property
    def _of_objects(self):
        """(objects,) log probabilities, if the object is one of the library's."""
        log_weights = self.log_weights - self.log_weights.max()
        sums = np.bincount(self.hypotheses.objects, np.exp(log_weights), len(self.library.names))
        return np.log(np.maximum(sums, 1e-300)) - np.log(sums.sum())

    @cached_property
    def among_known(self) -> np.ndarray:
        """(objects,) probabilities if the object is one of the library's, in the order of its names."""
        return np.exp(self._of_objects)

    @cached_property
    def none(self) -> float:
        """The probability that the object is none of the library's: 0 unless it was learned with `unknown`."""
        if self.library.verifier is None:
            return 0.0
        weight = sum(touch.weight for touch in self.touches)
        return 1 - self.library.verifier.probability(self.felt.max() / max(weight, 1e-9), weight)

    @cached_property
    def values(self) -> np.ndarray:
        """(objects,) probabilities, in the order of the library's names."""
        return self.among_known * (1 - self.none)

    @property
    def probabilities(self) -> dict[str, float]:
        """{name: probability}, the likeliest first; with "none of these" if the library was learned with `unknown`."""
        by_name = dict(zip(self.library.names, self.values.tolist(), strict=True))
        if self.library.verifier is not None:
            by_name[NONE] = self.none
        return dict(sorted(by_name.items(), key=lambda item: -item[1]))

    @property
    def name(self) -> str:
        """The likeliest name."""
        return next(iter(self.probabilities))

    @property
    def known(self) -> str:
        """The likeliest name if its probability is at least SURE; else empty."""
        name, probability = next(iter(self.probabilities.items()))
        return name if probability >= SURE else ""

    @cached_property
    def pose(self) -> Pose:
        """The likeliest pose of the likeliest known object; its mean place and size, where these are unknown."""
        ids = np.flatnonzero(self.hypotheses.objects == int(self.among_known.argmax()))
        weights = np.exp(self.log_weights[ids] - self.log_weights[ids].max())
        some, shares = self.hypotheses[ids], weights / weights.sum()
        shift = shares @ some.shifts * self.library.diameter
        return Pose(some.rotations[weights.argmax()], shift, float(shares @ some.sizes))

    def next_touch(self, reachable: Reachable | None = None) -> Approach:
        """The line along which a touch is expected to tell most about the name.

        Parameters
        ----------
        reachable : callable, optional
            Takes the origins (k, 3) and directions (k, 3) of lines, in the unit of the meshes, and tells (k,) which of
            them the hand can follow. All by default.

        Returns
        -------
        Approach
            The line.

        Raises
        ------
        ValueError
            Where no line is reachable that was not touched.
        """
        return self.library.line(self._planned if reachable is None else self._plan(reachable))

    @cached_property
    def _planned(self):
        """The number of the line of the next touch if all are reachable."""
        return self._plan(None)

    def _plan(self, reachable):
        lines = self._lines(reachable)
        count = PRESSED_LINES if self.library.tolerant else LINES
        if len(lines) > count:
            lines = np.sort(rng(len(self.touches), "lines").permutation(lines)[:count])
        return int(lines[self.expected_entropy(lines).argmin()])

    def _lines(self, reachable):
        """The lines that can be followed and were not."""
        grid, diameter = self.library.grid, self.library.diameter
        free = np.ones(grid.lines, dtype=bool)
        free[[touch.approach.line for touch in self.touches if touch.approach.line >= 0]] = False
        if reachable is not None:
            answer = np.asarray(reachable(grid.line_origins * diameter, -grid.line_axes[:, 2]))
            if answer.shape != (grid.lines,):
                raise ValueError(f"reachable must tell of each of {grid.lines} lines, got shape {answer.shape}")
            free &= answer.astype(bool)
        if not free.any():
            raise ValueError("no line that can be reached is left: let `reachable` allow more")
        return np.flatnonzero(free)

    def expected_entropy(self, lines: np.ndarray) -> np.ndarray:
        """(k,) nats that are expected to remain of the name's entropy after a touch along each of the library's lines.

        The belief is that among the known objects.
        """
        library, random = self.library, rng(len(self.touches), "planner")
        weights = np.exp(self.log_weights - self.log_weights.max())
        ids, shares = draw(weights, CANDIDATES, random)
        truths, truth_shares = draw(shares, TRUTHS, random)
        some = self.hypotheses[ids]
        travels, reliefs = library.predict_lines(some, lines)
        travels, reliefs = travels.T, reliefs.transpose(1, 0, 2)
        products = reliefs[:, truths] @ reliefs.transpose(0, 2, 1)
        squares = np.einsum("lhc,lhc->lh", reliefs, reliefs)
        apart = (squares[:, truths, None] + squares[:, None] - 2 * products) / reliefs.shape[2]
        evidence = library.likelihood.of_touch(travels[:, truths, None] - travels[:, None], np.maximum(apart, 0))
        if self.touches:
            grid = library.grid
            reached = np.minimum(travels[:, truths], START)[..., None] * grid.line_axes[lines][:, None, 2]
            contacts = grid.line_origins[lines][:, None] - reached
            before = np.array([touch.contact for touch in self.touches])
            distances = np.linalg.norm(contacts[:, :, None] - before, axis=3)
            evidence *= library.likelihood.weight(distances)[..., None]
        return expected_entropy(some.objects, shares, truths, truth_shares, evidence)


def _evidence(library: Library, hypotheses: Hypotheses, touch: Touch) -> np.ndarray:
    """(h,) weighted log likelihoods of a touch under hypotheses."""
    travels, reliefs = library.predict(hypotheses, touch.approach)
    apart = reliefs - touch.relief.astype(np.float32)
    squares = np.einsum("hc,hc->h", apart, apart) / apart.shape[1]
    return touch.weight * library.likelihood.of_touch(travels - touch.travel, squares)


def first_belief(library: Library) -> Belief:
    """The Belief of a library before anything was seen or felt."""
    hypotheses = first_particles(library) if library.tolerant else library.hypotheses
    alike = np.full(len(hypotheses), -np.log(len(hypotheses)))
    return Belief(library, hypotheses, alike, np.zeros(len(hypotheses)))

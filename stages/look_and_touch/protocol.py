"""Objects in drawn poses, what a camera sees and a hand feels of them, and ways to choose where to touch.

An object stands at a drawn azimuth, its centre beside the origin by a drawn error. A camera at 35 degrees takes one
picture. Then the hand touches along lines of the library, one after another.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property

import numpy as np

from haptic_glance.base.rng import rng
from haptic_glance.base.timing import Stopwatch
from haptic_glance.know import Belief, Library, stand
from haptic_glance.know.pressure_array import MISSED, feel_lines
from haptic_glance.know.sight import board
from haptic_glance.look.camera import Viewpoint
from haptic_glance.look.views import render
from haptic_glance.mesh.mesh import Mesh
from haptic_glance.touch import Surface

CAMERA = Viewpoint(0.0, 35.0)
SIDE = 96  # pixels of a picture
WIDER = 4  # times the picture: what is rendered, since an object beside its place may leave the picture
BOARD = 128  # grey value of the board that hides a part of the object
AMPLIFIED = 0.12  # share of full light that a dark picture is amplified to
SENSOR_NOISE = 0.02  # of full scale, of a dark picture
SIGHTS = {
    "blind": "no look",
    "look": "a look at a half-hidden object",
    "look_told": "the same, and the hidden part is told",
    "dark": "a look in the dark",
    "siblings": "no look; the class is told",
}
ATTENTION = ("glance", "touch", "thesis_ssim")  # policies that go to places on the object
POLICIES = {
    "planned": "planned",
    "spread": "evenly spread",
    "random": "at random",
    "glance": "places of the glance",
    "touch": "places with a recurring imprint",
    "thesis_ssim": "places of the thesis's attention",
}
NEXT = 0.06  # diameters: within it of a touch, places of attention come last
RANK = 0.004  # diameters that a place of attention may be nearer for each rank that it comes later


@dataclass(frozen=True)
class Disturbance:
    """What is harder than usual: errors in diameters, noise in multiples of the sensor's, shares of the picture."""

    hidden: float = 0.6  # of the object's pixels, behind a board
    light: float = 1.0  # share of full light
    noise: float = 1.0  # of travel and relief, times the sensor's
    position: float = (
        0.01  # standard deviation of the place along each level axis, half of it upwards; at most twice it
    )
    size: float = 1.0  # of the object, as a share of the known mesh's


@dataclass
class Case:
    """One object in one drawn pose: its surface, its picture, and what is felt along each line."""

    library: Library
    name: str
    mesh: Mesh
    pose: int
    disturbance: Disturbance = Disturbance()
    seed: int = 0
    places: Mapping[str, np.ndarray] = field(default_factory=dict)  # positions (p, 3) by policy, in the mesh's frame

    def __post_init__(self) -> None:
        random, unit = rng(self.seed, f"{self.name} {self.pose}"), self.library.diameter
        self.azimuth = 360 * random.random()
        error = self.disturbance.position * np.clip(random.normal(size=3), -2, 2) * [1, 1, 0.5] * unit
        larger = replace(self.mesh, vertices=self.mesh.vertices * self.disturbance.size)
        self.there = stand(larger, self.azimuth, error)
        self.surface = Surface(self.there)
        self.order = random.permutation(self.library.grid.lines)
        self._error = error

    @cached_property
    def view(self) -> tuple[np.ndarray, np.ndarray]:
        """(grey values, whether the object is seen) of the undisturbed picture, which may cut the object off."""
        small = replace(self.there, vertices=self.there.vertices / (WIDER * self.library.diameter))
        view, border = render(small, CAMERA, size=(WIDER * SIDE, WIDER * SIDE)), (WIDER - 1) * SIDE // 2
        middle = slice(border, border + SIDE), slice(border, border + SIDE)
        return view.rgb[middle].mean(axis=2), view.face[middle] >= 0

    def picture(self, hidden: float, light: float = 1.0) -> tuple[np.ndarray, np.ndarray]:
        """(picture, mask of what is hidden) with a share of the object behind a board, in a share of full light."""
        random = rng(self.seed, f"{self.name} {self.pose} picture")
        grey, is_object = self.view
        if light < 1:
            dark = light * grey / 255 + SENSOR_NOISE * random.normal(size=grey.shape)
            grey = 255 * np.clip(dark / AMPLIFIED, 0, 1)
        mask = board(is_object, hidden, random)
        return np.where(mask, BOARD, grey).astype(np.uint8), mask

    def look(self, sight: str, siblings: Sequence[str] = ()) -> Belief:
        """The belief before the first touch."""
        belief, wrong = self.library.belief(), self.disturbance
        if sight == "siblings":
            return belief.among(siblings)
        if sight == "blind":
            return belief
        if sight == "dark":
            return belief.look(self.picture(0.0, 0.05)[0], CAMERA)
        picture, mask = self.picture(wrong.hidden, wrong.light)
        return belief.look(picture, CAMERA, mask if sight == "look_told" else None)

    @cached_property
    def _felt(self):
        """(travels, contacts) along all lines, without noise, in diameters."""
        grid, unit = self.library.grid, self.library.diameter
        one = replace(self.library.sensor, cells=(1, 1))
        travels, _ = feel_lines(self.surface, grid.line_origins * unit, grid.line_axes, one)
        reached = np.where(np.isfinite(travels), travels / unit, 0)[:, None]
        return travels, grid.line_origins - reached * grid.line_axes[:, 2]

    def feel(self, line: int) -> tuple[float, np.ndarray]:
        """(travel, imprint) of a touch along a line of the library, with noise."""
        approach, factor = self.library.line(line), self.disturbance.noise
        sensor = approach.array
        noisy = replace(sensor, travel_noise=factor * sensor.travel_noise, relief_noise=factor * sensor.relief_noise)
        random = rng(self.seed, f"{self.name} {self.pose} {line}")
        return replace(approach, array=noisy).feel(self.surface, random)

    def next_line(self, policy: str, belief: Belief) -> int:
        """The number of the line along which the hand comes next."""
        if policy == "planned":
            return belief.next_touch().line
        done = [touch.approach.line for touch in belief.touches]
        if policy == "random" or (policy == "spread" and not done):
            return int(self.order[len(done)])
        travels, contacts = self._felt
        met = travels < MISSED
        if policy == "spread":
            nearest = np.linalg.norm(contacts[:, None] - contacts[done], axis=2).min(axis=1)
            return int(np.where(met, nearest, -1).argmax())
        return self._nearest_to_places(policy, contacts, met, done)

    def _nearest_to_places(self, policy, contacts, met, done):
        """The line that meets the object nearest to a place of attention, the earlier places first."""
        turn = np.radians(self.azimuth)
        rotation = np.array([[np.cos(turn), -np.sin(turn), 0], [np.sin(turn), np.cos(turn), 0], [0, 0, 1]])
        places = (self.places[policy] * self.disturbance.size @ rotation.T + self._error) / self.library.diameter
        apart = np.linalg.norm(contacts[:, None] - places[None], axis=2) + RANK * np.arange(len(places))
        scores = np.where(met, apart.min(axis=1), np.inf)
        for line in done:
            scores[np.linalg.norm(contacts - contacts[line], axis=1) < NEXT] += 5
        scores[done] = np.inf
        return int(scores.argmin())


@dataclass(frozen=True)
class Course:
    """What is believed in the course of some touches: (touches + 1, objects) probabilities; seconds of each touch."""

    probabilities: np.ndarray
    seconds: float


def touch_on(case: Case, belief: Belief, policy: str, touches: int) -> Course:
    """The Course of some touches of a case, from a belief."""
    beliefs = [belief]
    with Stopwatch() as watch:
        for _ in range(touches):
            line = case.next_line(policy, belief)
            belief = belief.after(belief.library.line(line), *case.feel(line))
            beliefs.append(belief)
    return Course(np.array([one.among_known for one in beliefs]), watch.seconds / max(touches, 1))

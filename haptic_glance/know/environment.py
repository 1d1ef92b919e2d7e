"""A task for learning agents, in the interface of Gymnasium: see half of an object, then touch it until sure.

The import of this module registers `haptic_glance/TouchUntilSure-v0`.
"""

from collections.abc import Mapping
from typing import Any

import numpy as np
from scipy.spatial.transform import Rotation

from haptic_glance.base.extras import from_extra
from haptic_glance.mesh.files import MeshLike
from haptic_glance.touch import Surface

from .library import AWAY, learn, stand
from .look_and_touch import CAMERA, HIDDEN, MOST, MOST_HIDDEN, half_hidden
from .objects import primitives
from .pressure_array import PressureArray
from .sight import SIDE

with from_extra():
    import gymnasium
    from gymnasium.error import ResetNeeded
    from gymnasium.spaces import Box, Dict, Discrete, MultiBinary

LINES = 64  # of the library's, drawn for an episode
ZOOM = 16  # pixels a cell, in a rendered imprint
REWARD = 10.0  # for the right object, and minus this for a wrong one; each touch costs 1


class TouchUntilSure(gymnasium.Env):
    """An agent sees a part of an object, and chooses along which lines a hand touches it until it is recognised.

    `reset` draws one of the known objects, its pose, a picture in which a grey board hides a part of it, and 64 lines
    of the library. The belief begins with this look. An action is the number of the line along which the hand comes
    next. An episode ends when the belief in one object reaches 95 %, and is cut off after `most` touches. Each touch
    costs 1; the right object earns 10, a wrong one costs 10.

    An observation has `belief` (objects,), the probability of each object; `picture` (96, 96) in bytes; `imprint`
    (rows, cols) of the last touch, in shares of the array's depth; `travel` (1,) of this touch; `origins` and
    `directions` (64, 3) of the lines; `touched` (64,), the lines that were followed. Travel and origins are in
    diameters of the largest object. A travel of 1.5 and an imprint of ones stand for a touch that meets nothing, and
    for none.

    Parameters
    ----------
    meshes : mapping of str to Mesh or any input of `as_mesh`, optional
        The known objects, as `learn` takes them. Six basic shapes by default.
    pose : {"fixed", "turned", "any"}
        How an object stands: as its mesh does; at a drawn azimuth; in any rotation.
    sensor : PressureArray, optional
        The array of the hand, as `learn` takes it.
    most : int
        Touches of an episode, at most.
    hidden : float, optional
        Share of the object that the board hides, from 0 to 0.95. None: no look, and a black picture.
    render_mode : {"rgb_array"}, optional
        `render` gives the last imprint as an image.

    Raises
    ------
    ValueError
        For what `learn` refuses, for fewer than two objects, for a `most` that is no whole number from 1, for a
        `hidden` out of range, and for another render mode.
    TypeError
        For meshes that are no mapping, and for names that are no texts.
    MissingExtra
        Where Gymnasium is not installed.

    Examples
    --------
    >>> environment = TouchUntilSure(hidden=None)
    >>> observation, info = environment.reset(seed=0, options={"name": "ball"})
    >>> observation, reward, sure, cut_off, info = environment.step(environment.planned())
    >>> observation["touched"].sum()
    np.int64(1)
    """

    metadata = {"render_modes": ["rgb_array"], "render_fps": 2}

    def __init__(
        self, meshes: Mapping[str, MeshLike] | None = None, pose: str = "turned", sensor: PressureArray | None = None,
        most: int = MOST, hidden: float | None = HIDDEN, render_mode: str | None = None,
    ) -> None:  # fmt: skip
        if render_mode not in (None, *self.metadata["render_modes"]):
            raise ValueError(f"unknown render mode {render_mode!r}: choose rgb_array")
        if not (isinstance(most, int | np.integer) and most >= 1):
            raise ValueError(f"an episode needs a whole number of touches, at least one, got most={most}")
        if hidden is not None and not 0 <= hidden <= MOST_HIDDEN:
            raise ValueError(f"hidden is a share from 0 to {MOST_HIDDEN:g}, or None for no picture, got {hidden}")
        self.library = learn(primitives() if meshes is None else meshes, pose, sensor)
        if len(self.library.names) < 2:
            raise ValueError("with one object there is nothing to find out: give two or more")
        self.most, self.hidden, self.render_mode = most, hidden, render_mode
        self.ended = True  # until the first reset
        self.action_space = Discrete(LINES)
        self.observation_space = Dict({
            "belief": Box(0, 1, (len(self.library.names),)),
            "picture": Box(0, 255, (SIDE, SIDE), np.uint8),
            "imprint": Box(0, 1, self.library.sensor.cells),
            "travel": Box(0, AWAY, (1,)),
            "origins": Box(-1, 1, (LINES, 3)),
            "directions": Box(-1, 1, (LINES, 3)),
            "touched": MultiBinary(LINES),
        })  # fmt: skip

    def reset(self, *, seed: int | None = None, options: dict[str, Any] | None = None) -> tuple[dict, dict]:
        """Draws an object, its pose, its picture and the lines; `options={"name": NAME}` chooses the object."""
        super().reset(seed=seed)
        if unknown := {*(options or {})} - {"name"}:
            raise ValueError(f"unknown option {min(unknown)!r} of an episode: known: name")
        library, random = self.library, self.np_random
        name = str((options or {}).get("name") or random.choice(library.names))
        mesh = library.mesh(name)
        turn, rotation = 360 * random.random(), Rotation.random(None, random).as_matrix()
        how = {"fixed": {}, "turned": {"turn": turn}, "any": {"rotation": rotation}}[library.pose]
        there = stand(mesh, **how)
        self.name, self.surface, self.belief = name, Surface(there), library.belief()
        self.picture = np.zeros((SIDE, SIDE), dtype=np.uint8)
        if self.hidden is not None:
            self.picture, mask = half_hidden(there, library.diameter, self.hidden, random)
            self.belief = library.look(self.picture, CAMERA, mask)
        self.lines = random.permutation(library.grid.lines)[:LINES]
        self.travel, self.imprint = np.inf, np.full(library.sensor.cells, library.sensor.depth)
        self.touched, self.ended = np.zeros(LINES, dtype=np.int8), False
        return self._observation(), self._info()

    def step(self, action: int) -> tuple[dict, float, bool, bool, dict]:
        """Touches along the line with this number; returns observation, reward, sure, cut off, and info."""
        if not self.action_space.contains(action):
            raise ValueError(f"an action is a line from 0 to {LINES - 1}, got {action!r}")
        if self.ended:
            raise ResetNeeded("there is no episode, or it has ended: call reset() before the next touch")
        approach = self.library.line(self.lines[action])
        self.travel, self.imprint = approach.feel(self.surface, self.np_random)
        self.belief = self.belief.after(approach, self.travel, self.imprint)
        self.touched[action] = 1
        answer = self.belief.known
        reward = (REWARD if answer == self.name else -REWARD if answer else 0.0) - 1.0
        cut_off = not answer and len(self.belief.touches) >= self.most
        self.ended = bool(answer) or cut_off
        return self._observation(), reward, bool(answer), cut_off, self._info()

    def planned(self) -> int:
        """The action of the planner, a baseline: the line after which the name is expected to be least uncertain.

        Lines that were followed come last.
        """
        if self.ended:
            raise ResetNeeded("there is no episode, or it has ended: call reset() before asking for a touch")
        entropies = self.belief.expected_entropy(self.lines)
        return int(np.lexsort((entropies, self.touched))[0])

    def render(self) -> np.ndarray | None:
        """(16 rows, 16 cols, 3) bytes: the last imprint, dark where it is met first; None without a render mode."""
        if self.render_mode is None:
            return None
        if not hasattr(self, "belief"):
            raise ResetNeeded("there is no episode: call reset() before render()")
        shades = np.rint(255 * self._observation()["imprint"]).astype(np.uint8)
        return np.kron(shades, np.ones((ZOOM, ZOOM), dtype=np.uint8))[..., None].repeat(3, axis=2)

    def _observation(self) -> dict[str, np.ndarray]:
        library = self.library
        return {
            "belief": self.belief.values.astype(np.float32),
            "picture": self.picture.copy(),
            "imprint": (self.imprint / library.sensor.depth).astype(np.float32),
            "travel": np.array([min(self.travel / library.diameter, AWAY)], dtype=np.float32),
            "origins": library.grid.line_origins[self.lines].astype(np.float32),
            "directions": -library.grid.line_axes[self.lines, 2].astype(np.float32),
            "touched": self.touched.copy(),
        }

    def _info(self) -> dict[str, Any]:
        """The object, which the agent must not see, and the object that is known."""
        return {"name": self.name, "known": self.belief.known}


gymnasium.register("haptic_glance/TouchUntilSure-v0", f"{__name__}:{TouchUntilSure.__name__}")

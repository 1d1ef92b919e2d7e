"""A task for learning agents, in the interface of Gymnasium: touch an unknown object in an unknown pose until sure.

The import of this module registers `haptic_glance/TouchUntilSure-v0`.
"""

from collections.abc import Mapping
from typing import Any

import numpy as np
from scipy.spatial.transform import Rotation

from haptic_glance.base.extras import from_extra
from haptic_glance.mesh import normalise
from haptic_glance.mesh.files import MeshLike
from haptic_glance.mesh.mesh import Mesh
from haptic_glance.touch import Skin, Surface

from .exploration import MOST, PLACES, Exploration
from .library import CELLS, check_names, learn, primitives, upright_named

with from_extra():
    import gymnasium
    from gymnasium.error import ResetNeeded
    from gymnasium.spaces import Box, Dict, Discrete, MultiBinary

ZOOM = 16  # pixels a cell, in a rendered imprint
REWARD = 10.0  # for the right object, and minus this for a wrong one; each touch costs 1


class TouchUntilSure(gymnasium.Env):
    """An agent chooses where to touch an object that it has to recognise.

    `reset` draws one of the known objects, turns it at random, and draws 64 places on it. An action is the number of
    the place that is touched next. The belief over the objects follows from the imprints, as in `Exploration`. An
    episode ends when the belief in one object reaches 95 %, and is cut off after `most` touches. Each touch costs 1;
    the right object earns 10, a wrong one costs 10.

    An observation has `belief` (objects,), the probability of each object; `image` (16, 16), the last imprint;
    `positions` and `normals` (64, 3), the places in units of the normalised object; `touched` (64,), the places that
    were touched.

    Parameters
    ----------
    meshes : mapping of str to Mesh or any input of `as_mesh`, optional
        The known objects, which are normalised and rotated so that z is up. Six basic shapes by default.
    most : int
        Touches of an episode, at most.
    render_mode : {"rgb_array"}, optional
        `render` gives the last imprint as an image.
    skin : Skin, optional
        The sensor, for example `Skin(dead=0.02, noise=0.02)`; an ideal one by default. It learns the objects and
        touches them.

    Raises
    ------
    ValueError
        For fewer than two objects, for a mesh that cannot be touched, for a `most` that is no whole number from 1, and
        for another render mode.
    TypeError
        For meshes that are no mapping, and for names that are no texts.
    MissingExtra
        Where Gymnasium is not installed.

    Examples
    --------
    >>> environment = TouchUntilSure()
    >>> observation, info = environment.reset(seed=0, options={"name": "ball"})
    >>> observation, reward, sure, cut_off, info = environment.step(environment.planned())
    >>> reward
    -1.0
    """

    metadata = {"render_modes": ["rgb_array"], "render_fps": 2}

    def __init__(
        self, meshes: Mapping[str, MeshLike] | None = None, most: int = MOST, skin: Skin | None = None,
        render_mode: str | None = None,
    ) -> None:  # fmt: skip
        if render_mode not in (None, *self.metadata["render_modes"]):
            raise ValueError(f"unknown render mode {render_mode!r}: choose rgb_array")
        if meshes is not None:
            check_names(meshes)
        upright = {name: upright_named(name, mesh) for name, mesh in (meshes or {}).items()}
        self.meshes = primitives() if meshes is None else {name: normalise(mesh) for name, mesh in upright.items()}
        if not (isinstance(most, int | np.integer) and most >= 1):
            raise ValueError(f"an episode needs a whole number of touches, at least one, got most={most}")
        self.library = learn(self.meshes, placed=False, turned=True, skin=skin)
        self.most, self.ended, self.render_mode = most, True, render_mode  # ended until the first reset
        self.action_space = Discrete(PLACES)
        self.observation_space = Dict({
            "belief": Box(0, 1, (len(self.library.names),)),
            "image": Box(0, 1, CELLS),
            "positions": Box(-1, 1, (PLACES, 3)),
            "normals": Box(-1, 1, (PLACES, 3)),
            "touched": MultiBinary(PLACES),
        })  # fmt: skip

    def reset(self, *, seed: int | None = None, options: dict[str, Any] | None = None) -> tuple[dict, dict]:
        """Draws an object, its pose and the places on it; `options={"name": NAME}` chooses the object."""
        super().reset(seed=seed)
        if unknown := {*(options or {})} - {"name"}:
            raise ValueError(f"unknown option {min(unknown)!r} of an episode: known: name")
        name = str((options or {}).get("name") or self.np_random.choice(self.library.names))
        if name not in self.meshes:
            raise ValueError(f"unknown object {name!r}: choose one of {', '.join(self.library.names)}")
        mesh, turn = self.meshes[name], Rotation.random(None, self.np_random)
        surface = Surface(Mesh(turn.apply(mesh.vertices), mesh.faces))
        self.name, self.exploration = name, Exploration(self.library, surface, self.np_random)
        self.touched, self.ended = np.zeros(PLACES, dtype=np.int8), False
        return self._observation(), self._info()

    def step(self, action: int) -> tuple[dict, float, bool, bool, dict]:
        """Touches the place with this number; returns observation, reward, sure, cut off, and info."""
        if not self.action_space.contains(action):
            raise ValueError(f"an action is a place from 0 to {PLACES - 1}, got {action!r}")
        if self.ended:
            raise ResetNeeded("there is no episode, or it has ended: call reset() before the next touch")
        self.exploration.touch(self.exploration.candidate(int(action)))
        self.touched[action] = 1
        answer = self.exploration.belief.known
        reward = (REWARD if answer == self.name else -REWARD if answer else 0.0) - 1.0
        cut_off = not answer and len(self.exploration.images) >= self.most
        self.ended = bool(answer) or cut_off
        return self._observation(), reward, bool(answer), cut_off, self._info()

    def planned(self) -> int:
        """The action of the planner, a baseline: the place at which the belief is expected to gain most.

        Where each place is near a touched one, the first untouched place.
        """
        if self.ended:
            raise ResetNeeded("there is no episode, or it has ended: call reset() before asking for a touch")
        gains = self.exploration.gains()
        return int(gains.argmax() if np.isfinite(gains).any() else self.touched.argmin())

    def render(self) -> np.ndarray | None:
        """(256, 256, 3) bytes: the last imprint, dark where it is pressed first; None without a render mode."""
        if self.render_mode is None:
            return None
        if not hasattr(self, "exploration"):
            raise ResetNeeded("there is no episode: call reset() before render()")
        shades = np.rint(255 * self._observation()["image"]).astype(np.uint8)
        return np.kron(shades, np.ones((ZOOM, ZOOM), dtype=np.uint8))[..., None].repeat(3, axis=2)

    def _observation(self) -> dict[str, np.ndarray]:
        touched, places = self.exploration, self.exploration.candidates
        image = touched.images[-1] if len(touched.images) else np.zeros(CELLS)
        return {
            "belief": touched.belief.values.astype(np.float32),
            "image": image.astype(np.float32),
            "positions": places.positions.astype(np.float32),
            "normals": places.normals.astype(np.float32),
            "touched": self.touched.copy(),
        }

    def _info(self) -> dict[str, Any]:
        """The object, which the agent must not see, and the object that is known."""
        return {"name": self.name, "known": self.exploration.belief.known}


gymnasium.register("haptic_glance/TouchUntilSure-v0", f"{__name__}:{TouchUntilSure.__name__}")

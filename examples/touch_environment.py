"""A Gymnasium environment of touch: the sensor moves over a mesh and feels forces in newtons.

    python examples/touch_environment.py bunny.stl

The observation is the force image of a 16 x 16 array under foam, the action moves the array along its right, up and
normal. The reward is higher the nearer the load is to 1 N: to follow the surface with a steady touch earns most.
Needs gymnasium, which is no dependency of haptic-glance.
"""

import sys

import numpy as np

from haptic_glance import Layer, Mesh, Surface, forces, gaps_at, load, normalise, sensor_axes

try:
    import gymnasium
except ModuleNotFoundError:
    raise ModuleNotFoundError("gymnasium is not installed: pip install gymnasium", name="gymnasium") from None

CELLS, PITCH = (16, 16), 0.001  # metres
STEP = 0.002  # metres along each axis, at most
TARGET = 1.0  # newtons
RANGE = 0.05  # metres off the surface, at which an episode ends


class TouchEnvironment(gymnasium.Env):
    """The force image (16, 16) f4 in newtons of an array on a mesh in metres; actions (3,) in -1..1, of 2 mm each."""

    def __init__(self, mesh: Mesh, layer: Layer | None = None) -> None:
        self.surface, self.layer = Surface(mesh), layer or Layer()
        highest = self.layer.stiffness * self.layer.thickness * PITCH**2
        self.observation_space = gymnasium.spaces.Box(0, highest, CELLS, np.float32)
        self.action_space = gymnasium.spaces.Box(-1, 1, (3,), np.float32)

    def reset(self, *, seed=None, options=None):
        """Puts the array on a random point of the surface."""
        super().reset(seed=seed)
        mesh = self.surface.mesh
        face = self.np_random.choice(len(mesh.faces), p=mesh.face_areas / mesh.face_areas.sum())
        self.centre = mesh.vertices[mesh.faces[face]].mean(axis=0)
        self.axes = sensor_axes(mesh.face_normals[[face]])
        return self._felt(), {"centre": self.centre.copy()}

    def step(self, action):
        """Moves the array and feels."""
        self.centre = self.centre + STEP * np.clip(action, -1, 1) @ self.axes[0]
        felt = self._felt()
        force = float(felt.sum())
        info = {"load": force, "centre": self.centre.copy()}
        return felt, -abs(force - TARGET) / TARGET, bool(self.gap > RANGE), False, info

    def _felt(self):
        """The forces where the array stands; its rigid backing stops it where the layer is compressed entirely."""
        gaps = gaps_at(self.surface, self.centre[None], self.axes, self.layer.thickness, CELLS, PITCH)
        self.gap = gaps.min()
        depth = np.clip(-self.gap, 0, self.layer.thickness)
        self.centre = self.centre + max(-self.gap - depth, 0) * self.axes[0, 2]
        return forces(gaps, self.layer, PITCH**2, depth=depth)[0].astype(np.float32)


if __name__ == "__main__":
    mesh = normalise(load(sys.argv[1]))
    environment = TouchEnvironment(Mesh(0.1 * mesh.vertices, mesh.faces))  # 10 cm across
    felt, _ = environment.reset(seed=0)
    for _ in range(20):
        felt, reward, over, _, info = environment.step([0.2, 0.0, 0.3 if felt.sum() > TARGET else -0.3])
        print(f"{info['load']:6.2f} N on {int((felt > 0).sum()):3} cells, reward {reward:.2f}")

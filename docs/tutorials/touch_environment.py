"""
Simulated touch in a Gymnasium loop
===================================

An agent moves a pressure array over an object and feels forces in newtons. Its observation is the force image of 16 x
16 cells under foam; its action moves the array along its right, up and normal. The reward is highest at a load
of 1 N, so the best agent follows the surface with a steady touch.

The class below is an environment of `Gymnasium <https://gymnasium.farama.org>`_ where that is installed. Without it
the class has no spaces, and the loop is the same. A second environment comes with the package: the agent sees a part
of an object, and touches it until the name is known.

Needs ``pip install 'haptic-glance[pictures]'``; runs without a network. The extra ``agents`` brings Gymnasium.
"""

import matplotlib.pyplot as plt
import numpy as np
import trimesh

from haptic_glance import Layer, Mesh, Surface, forces, gaps_at, sensor_axes

try:
    import gymnasium
except ModuleNotFoundError:
    gymnasium = None
    print("gymnasium is not installed: the environment goes without its spaces and checks")
else:
    import haptic_glance.know.environment  # noqa: F401 - registers the second environment

CELLS, PITCH = (16, 16), 0.001  # metres
STEP = 0.002  # metres along each axis, at most
TARGET = 1.0  # newtons
RANGE = 0.05  # metres off the surface, at which an episode ends

# %%
# The environment
# ---------------


class TouchEnvironment(gymnasium.Env if gymnasium else object):
    """The force image (16, 16) f4 in newtons of an array on a mesh in metres; actions (3,) in -1..1, of 2 mm each."""

    def __init__(self, mesh: Mesh, layer: Layer | None = None) -> None:
        self.surface, self.layer = Surface(mesh), layer or Layer()
        if gymnasium:
            highest = self.layer.stiffness * self.layer.thickness * PITCH**2
            self.observation_space = gymnasium.spaces.Box(0, highest, CELLS, np.float32)
            self.action_space = gymnasium.spaces.Box(-1, 1, (3,), np.float32)

    def reset(self, *, seed=None, options=None):
        """Puts the array on a random point of the surface."""
        if gymnasium:
            super().reset(seed=seed)
        else:
            self.np_random = np.random.default_rng(seed)
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


# %%
# A loop
# ------
#
# The agent slides to the right over an egg, 0.2 mm at a time. If the load is above the target, the agent moves away
# from the egg; if the load is below the target, the agent moves closer.

if __name__ == "__main__":
    egg = trimesh.creation.icosphere(5, radius=0.03).apply_scale([1, 1, 1.4])
    environment = TouchEnvironment(Mesh(egg.vertices, egg.faces))
    felt, _ = environment.reset(seed=3)
    images, loads, rewards = [], [], []
    for _ in range(60):
        pushed = np.clip(0.1 * (felt.sum() - TARGET), -0.3, 0.3)
        felt, reward, over, _, info = environment.step([0.1, 0.0, pushed])
        images.append(felt)
        loads.append(info["load"])
        rewards.append(reward)
        if over:
            break
    print(f"{len(loads)} steps, mean reward {np.mean(rewards):.2f}, of the last ten {np.mean(rewards[-10:]):.2f}")

    fig = plt.figure(figsize=(9, 4.6), layout="constrained")
    top, bottom = fig.subfigures(2, 1, height_ratios=[1, 1.2])
    for step, axis in zip([1, 10, 20, 30, 40, 50], top.subplots(1, 6), strict=True):
        axis.imshow(images[min(step, len(images) - 1)], cmap="magma", vmin=0, vmax=np.max(images))
        axis.set_title(f"step {step}", fontsize=10)
        axis.axis("off")
    axis = bottom.subplots()
    axis.plot(loads)
    axis.axhline(TARGET, color="0.6", ls="--", label="target")
    axis.set_xlabel("step")
    axis.set_ylabel("load, N")
    axis.legend()
    plt.show()

# %%
# Touch until sure
# ----------------
#
# The registered environment ``TouchUntilSure-v0`` shows a picture in which a board hides a part of an object. Then the
# agent chooses along which of 64 lines the hand comes. Each touch costs 1, the right name earns 10, and a wrong name
# costs 10. The episode ends when the belief in one name reaches 95 %.
#
# Here eight balls differ in the height of one bump, and each ball stands at a drawn azimuth. The board hides 60 % of
# the ball. A hand at random mostly misses the bump. The planner touches where it expects the name to become surest.

BALL = trimesh.creation.icosphere(4, radius=0.5)


def bumped(elevation: float, height: float = 0.12) -> Mesh:
    """A ball of diameter 1 with a bump at an elevation in degrees."""
    top = [np.cos(np.radians(elevation)), 0, np.sin(np.radians(elevation))]
    radii = 1 + height * np.exp(-20 * (1 - 2 * BALL.vertices @ top))
    return Mesh(BALL.vertices * radii[:, None], BALL.faces)


if __name__ == "__main__" and gymnasium:
    meshes = {f"bump at {elevation}": bumped(elevation) for elevation in (-15, 0, 15, 30, 45, 60, 75)}
    meshes["ball"] = bumped(0, height=0)
    task = gymnasium.make("haptic_glance/TouchUntilSure-v0", meshes=meshes, most=20)
    agents = {"planner": lambda _: task.unwrapped.planned(), "random": lambda random: int(random.integers(64))}
    for agent, choose in agents.items():
        touches, right = [], []
        for seed in range(20):
            random, over, count = np.random.default_rng(seed), False, 0
            observation, _ = task.reset(seed=seed)
            while not over:
                observation, _, sure, cut_off, info = task.step(choose(random))
                over, count = sure or cut_off, count + 1
            touches.append(count)
            right.append(info["known"] == info["name"])
        print(f"{agent}: {np.mean(touches):.1f} touches, right {100 * np.mean(right):.0f} %")

    fig, (seen, felt) = plt.subplots(1, 2, figsize=(6, 3), layout="constrained")
    seen.imshow(observation["picture"], cmap="gray", vmin=0, vmax=255)
    seen.set_title("what the camera sees", fontsize=10)
    felt.imshow(observation["imprint"], cmap="gray", vmin=0, vmax=1)
    felt.set_title("the last imprint", fontsize=10)
    for axis in (seen, felt):
        axis.axis("off")
    plt.show()

"""A ball with bumps, in scenes of a few small frames."""

import numpy as np
import pytest
import trimesh

from haptic_glance.lod.scene import Frames, Placed, Scene, build_lod_chain, fly
from haptic_glance.mesh.mesh import Mesh


def bumpy(seed, subdivisions=4):
    """A closed ball of radius 0.5 whose surface rises and falls: coarser levels must show."""
    ball = trimesh.creation.icosphere(subdivisions=subdivisions, radius=0.5)
    along = np.random.default_rng(seed).normal(size=(3, 3)) * 4
    bumps = np.sin(ball.vertices @ along.T).sum(axis=1)
    return Mesh(ball.vertices * (1 + 0.05 * bumps)[:, None], ball.faces)


@pytest.fixture(scope="session")
def meshes():
    return {"one": bumpy(0), "two": bumpy(1, subdivisions=3)}


@pytest.fixture(scope="session")
def chains(meshes):
    return {name: build_lod_chain(mesh) for name, mesh in meshes.items()}


@pytest.fixture(scope="session")
def make_scene():
    """Function of changes to a Scene of three objects, to which the camera comes near in five frames."""

    def make(objects=None, frames=5, size=(60, 80), tolerance=1.0, **changes):
        cameras = tuple(fly([[0, -4, 0.6], [0, -1.2, 0.4]], [[0, 0, 0.1], [0, 0, 0.1]], frames, 40, size))
        placed = objects or (
            Placed("one", (-0.2, 0.0, 0.0), 30.0, 0.25), Placed("two", (0.2, 0.1, 0.0), 0.0, 0.2),
            Placed("one", (0.05, 0.5, 0.0), 90.0, 0.25),
        )  # fmt: skip
        return Scene(placed, cameras, tolerance, **changes)

    return make


@pytest.fixture(scope="session")
def frames_of(meshes, chains):
    """Function of a Scene to its Frames."""
    return lambda scene: Frames(scene, meshes, [chains[placed.name][0] for placed in scene.objects])

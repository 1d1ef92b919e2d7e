"""Scenes drawn at random: what stands where on a ground, and the path of a camera that comes near."""

from collections.abc import Mapping, Sequence
from dataclasses import replace

import numpy as np

from haptic_glance.base.rng import rng
from haptic_glance.lod.scene.camera import Box

from .schema import Item, Keyframe, Params

GROUND = 0.6, 2.0  # metres a side, from a small table to a rug
FEWEST, MOST = 6, 12  # objects
LARGER = 0.8, 1.25  # times the object's own size
GAP = 0.01  # metres between two objects, which are taken as upright cylinders
TRIES = 100  # places tried for an object before the ground grows
GROWTH = 1.1
KEYS = 4  # keyframes of the camera
FAR, NEAR = (1.0, 1.6), (0.6, 1.0)  # metres from the target at the first, in sides of the ground, and at the last
ASIDE = 60.0  # degrees about the vertical between two keyframes, at most
RISE = 20.0, 40.0  # degrees above the horizon
LOWEST = 0.45  # metres: no eye is inside an object, of which none is that high


def draw_scene(
    settings: Params, number: int, boxes: Mapping[str, Box], sizes: Mapping[str, float], seed: int
) -> Params:
    """The settings with the objects and the camera path of random scene `number`, named random_NUMBER.

    boxes: dict name -> (low, high) in units of the mesh, sizes: dict name -> metres of the longest side, of the objects
    that may stand there. Each of 6 to 12 of them (fewer where there are no more) stands once, at 0.8 to 1.25 of its
    size, turned at random, at even odds anywhere on a square ground; the circles round their feet do not overlap. The
    camera comes near from afar, to look at one of them in the end, and the others or the middle on its way.
    """
    random = rng(seed, f"scene {number}")
    count = min(int(random.integers(FEWEST, MOST + 1)), len(boxes))
    names = random.permutation(sorted(boxes))[:count].tolist()
    side = float(np.exp(random.uniform(*np.log(GROUND))))
    lengths = [sizes[name] * random.uniform(*LARGER) for name in names]
    radii = [length * _footprint(boxes[name]) for name, length in zip(names, lengths, strict=True)]
    places, side = _places(radii, side, random)
    turns = random.uniform(0, 360, count)
    objects = [
        Item(name, [*map(float, place), 0.0], float(turn), float(length))
        for name, place, turn, length in zip(names, places, turns, lengths, strict=True)
    ]
    return replace(settings, name=scene_name(number), objects=objects, camera=_camera(objects, side, random))


def scene_name(number: int) -> str:
    """The name of a random scene, for the tables."""
    return f"random_{number:02d}"


def _footprint(box):
    """Radius of the circle round a box's foot, over its longest side."""
    extent = box[1] - box[0]
    return float(np.hypot(extent[0], extent[1]) / 2 / extent.max())


def _places(radii: Sequence[float], side: float, random: np.random.Generator) -> tuple[np.ndarray, float]:
    """((o, 2) middles of circles that do not overlap, on a square round 0; its side, which grows where it is full)."""
    found = np.zeros((0, 2))
    while len(found) < len(radii):
        radius, others = radii[len(found)], np.array(radii[: len(found)])
        reach = max(side / 2 - radius, 0)
        tried = random.uniform(-reach, reach, (TRIES, 2))
        apart = np.linalg.norm(tried[:, None] - found, axis=2) >= others + radius + GAP
        free = np.flatnonzero(apart.all(axis=1))
        if len(free):
            found = np.vstack([found, tried[free[0]]])
        else:
            side *= GROWTH
    return found, side


def _camera(objects: Sequence[Item], side: float, random: np.random.Generator) -> list[Keyframe]:
    targets = [[0.0, 0.0, 0.05], *([*item.position[:2], item.size / 2] for item in objects)]
    seen = [0, *random.integers(len(targets), size=KEYS - 2), random.integers(1, len(targets))]
    distances = np.geomspace(side * random.uniform(*FAR) + 0.5, random.uniform(*NEAR), KEYS)
    turns = np.radians(random.uniform(0, 360) + np.cumsum(random.uniform(-ASIDE, ASIDE, KEYS)))
    rises = np.radians(random.uniform(*RISE, KEYS))
    along = np.stack([np.cos(turns) * np.cos(rises), np.sin(turns) * np.cos(rises), np.sin(rises)], axis=1)
    eyes = np.array([targets[k] for k in seen]) + along * distances[:, None]
    eyes[:, 2] = np.maximum(eyes[:, 2], LOWEST)
    return [Keyframe(eye.tolist(), targets[k]) for eye, k in zip(eyes, seen, strict=True)]

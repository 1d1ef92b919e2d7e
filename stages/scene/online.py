"""Plans of levels frame by frame while a camera moves, their rivals, and random scenes.

An online planner knows the frame at hand and those before it, and none ahead. Rivals are all faces, the usual share by
distance, and a model's count. A random scene has objects on a ground, and a camera that comes near.
"""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace

import numpy as np

from haptic_glance.base.rng import rng
from haptic_glance.lod.scene.camera import Box
from haptic_glance.lod.scene.chain import Level
from haptic_glance.lod.scene.frames import Frames, Plan

from . import Item, Keyframe, Params

BEHIND = 1e-9  # metres: the depth of what reaches behind the camera
Error = Callable[[int, int], float]  # (frame, level) -> error on the screen


def online(frames: Frames, chains: Sequence[Sequence[Level]], rendered: bool = True) -> Plan:
    """The Plan of a planner that sees no frame ahead.

    chains: the levels of each object. rendered: the levels that it tries are rendered in the frame at hand, and the
    jump where it changes to a coarser one; else their errors there are those of their own surfaces (the 99 % quantile),
    at the distance of the object's box. Each object for itself, by `choose`. Where the error of all objects together
    is higher than of each alone, nothing is mended.
    """
    columns = [_column(frames, item, chain, rendered) for item, chain in enumerate(chains)]
    return Plan(np.stack(columns, axis=1), chains, frames)


def choose(
    error: Error, jump: Callable[[int, int, int], float], approach: np.ndarray, seen: np.ndarray, count: int,
    tolerance: float, hold: int,
) -> np.ndarray:  # fmt: skip
    """(f,) levels of one object, of `count`, 0 the finest; the choice in a frame asks for nothing of later ones.

    error(frame, level); jump(frame, level, coarser level). approach (f,): the factor by which errors grow until the
    next frame if the camera goes on as it came; seen (f,): whether the object is in view. A level stays while its error
    will be within the tolerance in the next frame. Else a finer one follows at once. A coarser one follows when the
    present one has stayed `hold` frames, if it will be within the tolerance for as long, and the jump is.
    """
    levels, level, age = [], 0, hold
    for frame in range(len(seen)):

        def lasts(candidate, ahead, frame=frame):
            return error(frame, candidate) * approach[frame] ** ahead <= tolerance

        before = level
        if seen[frame]:
            entered = frame == 0 or not seen[frame - 1]
            while level and not lasts(level, 1):
                level -= 1
            if level == before and (entered or age >= hold):
                while level + 1 < count and lasts(level + 1, hold):
                    level += 1
                while level > before and not entered and jump(frame, before, level) > tolerance:
                    level -= 1
        age = 1 if level != before else age + 1
        levels.append(level)
    return np.array(levels, dtype=np.int64)


def _column(frames, item, chain, rendered):
    full, distance = chain[0], frames.distance[:, item]
    approach = np.maximum(np.append(1.0, distance[:-1] / distance[1:]), 1.0)
    scale = _scale(frames, item)

    def error(frame, level):
        if rendered:
            return frames.between(frame, item, full, chain[level])
        return chain[level].error["q99"] * scale[frame]

    def jump(frame, level, coarser):
        return frames.between(frame, item, chain[level], chain[coarser]) if rendered else error(frame, coarser)

    scene = frames.scene
    return choose(error, jump, approach, frames.in_view[:, item], len(chain), scene.tolerance, scene.hold)


def _scale(frames, item):
    """(f,) pixels per unit of the mesh where the object's box is nearest to the camera; without end behind it."""
    pose = frames.poses[item]
    depths = np.array([camera.project(pose.corners())[2].min() for camera in frames.scene.cameras])
    focal = np.array([camera.focal for camera in frames.scene.cameras])
    return pose.scale * focal / np.maximum(depths, BEHIND)


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
    return replace(settings, name=f"random_{number:02d}", objects=objects, camera=_camera(objects, side, random))


def _footprint(box):
    """Radius of the circle round a box's foot, over its longest side."""
    extent = box[1] - box[0]
    return float(np.hypot(extent[0], extent[1]) / 2 / extent.max())


def _places(radii: Sequence[float], side: float, random: np.random.Generator) -> tuple[np.ndarray, float]:
    """((o, 2) middles of circles that do not overlap, on a square round 0; its side, which grows where it is full)."""
    middles = np.zeros((0, 2))
    while len(middles) < len(radii):
        radius, placed = radii[len(middles)], np.array(radii[: len(middles)])
        reach = max(side / 2 - radius, 0)
        candidates = random.uniform(-reach, reach, (TRIES, 2))
        is_free = np.linalg.norm(candidates[:, None] - middles, axis=2) >= placed + radius + GAP
        free = np.flatnonzero(is_free.all(axis=1))
        if len(free):
            middles = np.vstack([middles, candidates[free[0]]])
        else:
            side *= GROWTH
    return middles, side


def _camera(objects: Sequence[Item], side: float, random: np.random.Generator) -> list[Keyframe]:
    targets = [[0.0, 0.0, 0.05], *([*item.position[:2], item.size / 2] for item in objects)]
    aims = [0, *random.integers(len(targets), size=KEYS - 2), random.integers(1, len(targets))]
    distances = np.geomspace(side * random.uniform(*FAR) + 0.5, random.uniform(*NEAR), KEYS)
    turns = np.radians(random.uniform(0, 360) + np.cumsum(random.uniform(-ASIDE, ASIDE, KEYS)))
    rises = np.radians(random.uniform(*RISE, KEYS))
    along = np.stack([np.cos(turns) * np.cos(rises), np.sin(turns) * np.cos(rises), np.sin(rises)], axis=1)
    eyes = np.array([targets[k] for k in aims]) + along * distances[:, None]
    eyes[:, 2] = np.maximum(eyes[:, 2], LOWEST)
    return [Keyframe(eye.tolist(), targets[k]) for eye, k in zip(eyes, aims, strict=True)]


HALVINGS = 14  # of the span of the tuned factor, which is then known to 0.1 %
SPAN = (1e-3, 1e3)


def full(frames: Frames) -> Plan:
    """The Plan with all faces of every object."""
    return Plan(np.zeros(frames.shape, dtype=np.int64), tuple((level,) for level in frames.full), frames)


def uniform(frames: Frames, chains: Sequence[Sequence[Level]], full_detail: float, by_size: bool = False) -> Plan:
    """The usual practice: every object reduced to the same share of faces, chosen by its distance alone.

    chains: the levels of each object, the same from which a budget chooses. All faces up to the distance `full_detail`,
    in metres, half of them at twice that, a quarter at four times, and so on, by the nearest level: the error on the
    surface is about inversely proportional to the faces, and on the screen to the distance. by_size: distances in
    lengths of the object, so that the size on the screen decides, as in game engines.
    """
    distance = frames.distance
    if by_size:
        distance = distance / [placed.size for placed in frames.scene.objects]
    return by_counts(frames, chains, np.minimum(full_detail / distance, 1) * [chain[0].faces for chain in chains])


def by_counts(frames: Frames, chains: Sequence[Sequence[Level]], counts: np.ndarray) -> Plan:
    """The Plan of the levels nearest, in ratio, to the face counts (frames, objects)."""
    faces = [np.log([level.faces for level in chain]) for chain in chains]
    nearest = [np.abs(np.log(column)[:, None] - log_faces).argmin(axis=1)
               for log_faces, column in zip(faces, counts.T, strict=True)]  # fmt: skip
    return Plan(np.stack(nearest, axis=1), chains, frames)


def equal(plan: Plan, limit: int) -> Plan:
    """The Plan with the same count for all objects in view in each frame that has more than `limit` faces.

    Each takes its finest level of at most that count, the largest with which the frame is within the limit.
    """
    levels = plan.levels.copy()
    for frame in np.flatnonzero(plan.faces.sum(axis=1) > limit):
        visible = np.flatnonzero(plan.frames.in_view[frame])
        chains = [[level.faces for level in plan.chains[item]] for item in visible.tolist()]
        for count in sorted({count for counts in chains for count in counts}, reverse=True):
            level_ids = [next((k for k, n in enumerate(counts) if n <= count), len(counts) - 1) for counts in chains]
            if sum(counts[k] for counts, k in zip(chains, level_ids, strict=True)) <= limit:
                levels[frame, visible] = level_ids
                break
    return Plan(levels, plan.chains, plan.frames)


def tune(
    plan_of: Callable[[float], Plan], measure: Callable[[Plan], float], target: float, below: bool = False
) -> Plan:
    """The Plan of `plan_of(factor)` whose `measure` is closest to `target` from above: no more faces than at equality.

    Larger factors must give coarser plans. The coarsest Plan is returned where even it has less error. below: return
    the coarsest Plan found whose `measure` is at most `target`.
    """
    valid_end, other_end = np.log(SPAN) if below else np.log(SPAN)[::-1]
    best = plan_of(float(np.exp(valid_end)))
    for _ in range(HALVINGS):
        middle = (valid_end + other_end) / 2
        plan = plan_of(float(np.exp(middle)))
        if measure(plan) <= target if below else measure(plan) >= target:
            valid_end, best = middle, plan
        else:
            other_end = middle
    return best

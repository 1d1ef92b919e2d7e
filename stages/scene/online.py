"""Levels chosen frame by frame: a planner that knows the frame at hand and those before it, and none ahead."""

from collections.abc import Callable, Sequence

import numpy as np

from haptic_glance.lod.scene.chain import Level
from haptic_glance.lod.scene.frames import Frames, Plan

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

        def lasts(tried, ahead, frame=frame):
            return error(frame, tried) * approach[frame] ** ahead <= tolerance

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

"""The smallest face counts of a scene that meet a tolerance, planned by the levels' errors and checked by rendering.

The plan of one object is the cheapest sequence of levels over the frames, without popping or flicker.
"""

from collections.abc import Iterator, Mapping, Sequence
from typing import Any

import numpy as np

from haptic_glance.mesh.files import with_known_up
from haptic_glance.mesh.repair import rotate_to_z_up

from .camera import Scene
from .chain import Level, build_lod_chain
from .frames import Frames, Plan

# A level's error, measured on its whole surface, predicts that of the visible part only within a factor. The search
# starts from an optimistic share of it, so that no cheaper level is missed, and renders every level that it chooses.
OPTIMISM = {"pixels": 0.6, "ssim": 0.02}  # share of the error on the screen predicted by a level's 99 % quantile
REJECTED = 1.001  # tolerances: the error noted for a level that a frame rejects though it passed among full meshes


def budget(
    meshes: Mapping[str, Any], scene: Scene, options: Mapping[str, Mapping[str, Any]] | None = None,
    chains: Mapping[str, Sequence[Level]] | None = None, frames: Frames | None = None,
) -> Plan:  # fmt: skip
    """Plans the fewest faces of each object in each frame, with every frame within the scene's tolerance.

    Parameters
    ----------
    meshes : mapping of str to Mesh or any input of `as_mesh`
        The mesh of each name in the scene. With `chains`, z up, as these are; else the function turns it z up.
    scene : Scene
        Objects, cameras and tolerance.
    options : mapping of str to mapping, optional
        Options of `haptic_glance.lod.simplify` by name, for the salient regions: `{"weights": saliency}`, or `{"keep":
        vertices, "rings": 3}`.
    chains : mapping of str to sequence of Level, optional
        Levels from `haptic_glance.lod.scene.build_lod_chain`, in place of options.
    frames : Frames, optional
        Frames of this scene, to share rendered pictures with another plan.

    Returns
    -------
    Plan
        The level of each object in each frame.

    Raises
    ------
    ValueError
        For a scene or options that do not fit the meshes, and for a limit below the smallest feasible one, which the
        message names.
    TypeError
        For meshes that are no mapping.

    Notes
    -----
    The errors of the levels predict the errors of a frame. The function renders the chosen levels, replaces the
    predicted errors by the rendered ones, and plans again, until the plan uses rendered errors alone and every frame,
    with all objects at their levels, is within the tolerance. Where a level switches, the jump of the picture must be
    within the tolerance as well, and a level stays for `scene.hold` frames. Where a frame exceeds the face limit, the
    objects whose error stays smallest are coarsened; such frames may exceed the tolerance.
    """
    if not isinstance(meshes, Mapping):
        raise TypeError(f"meshes must be a mapping from names to meshes, got {type(meshes).__name__}")
    if chains is None:
        meshes = {name: rotate_to_z_up(with_known_up(mesh)) for name, mesh in meshes.items()}
        scene.poses(meshes)  # raises before the work begins
        if unknown := sorted(set(options or ()) - set(meshes)):
            raise ValueError(f"options of {', '.join(unknown)}: there are {', '.join(sorted(meshes))}")
        names = sorted({placed.name for placed in scene.objects})
        chains = {name: build_lod_chain(meshes[name], **(options or {}).get(name, {})) for name in names}
    elif missing := sorted({placed.name for placed in scene.objects} - set(chains)):
        raise ValueError(f"no levels of {', '.join(missing)}: there are {', '.join(sorted(chains)) or 'none'}")
    of_objects = tuple(chains[placed.name] for placed in scene.objects)
    frames = frames or Frames(scene, meshes, [chain[0] for chain in of_objects])
    return _Search(scene, frames, of_objects).run()


class _Search:
    def __init__(self, scene, frames, chains):
        self.scene, self.frames, self.chains = scene, frames, chains
        self.faces = [np.array([level.faces for level in chain]) for chain in chains]
        self._check_limit()
        self.errors = [self._predicted(item) for item in range(len(chains))]
        # The jump between two levels is about the coarser one's error or more, and at most the sum of both errors.
        self.jumps = [np.maximum(error[:, :, None], error[:, None, :]) for error in self.errors]
        self.rendered = set()

    def _check_limit(self):
        smallest = int((self.frames.in_view * [counts[-1] for counts in self.faces]).sum(axis=1).max())
        if 0 < self.scene.limit < smallest:
            raise ValueError(
                f"a limit of {self.scene.limit} faces is infeasible: in one frame the coarsest levels have {smallest} "
                f"together, which is the smallest feasible limit"
            )

    def _predicted(self, item):
        quantile = np.array([level.error["q99"] for level in self.chains[item]])
        return (
            OPTIMISM[self.scene.kind] * quantile * self.frames.scale[:, item, None] * self.frames.in_view[:, item, None]
        )

    def run(self) -> Plan:
        while True:
            levels = self._plan()
            fresh = [state for state in self._used(levels) if state not in self.rendered]
            if fresh:
                self._render(fresh)
            elif not self._reject_broken(levels):
                return Plan(levels, self.chains, self.frames)

    def _plan(self):
        least = np.zeros(self.frames.shape, dtype=np.int64)
        while True:
            levels = np.stack([self._levels_of(item, least[:, item]) for item in range(len(self.chains))], axis=1)
            crowded_frames = np.flatnonzero(self._total(levels) > self.scene.limit) if self.scene.limit else ()
            if not len(crowded_frames):
                return levels
            for frame in crowded_frames:  # none twice: no level is finer than its `least`
                counts = [
                    faces * visible for faces, visible in zip(self.faces, self.frames.in_view[frame], strict=True)
                ]
                errors = [error[frame] for error in self.errors]
                least[frame] = share_limit(levels[frame], counts, errors, self.scene.limit)

    def _total(self, levels):
        counts = np.stack([faces[k] for faces, k in zip(self.faces, levels.T, strict=True)], axis=1)
        return (counts * self.frames.in_view).sum(axis=1)

    def _levels_of(self, item, least):
        cost = self.faces[item] * self.frames.in_view[:, item, None]
        errors = np.where(np.arange(len(self.chains[item])) < least[:, None], np.inf, self.errors[item])
        # Out of view all levels cost nothing: a small share of the count makes the choice unique.
        return cheapest(cost + 1e-3 * self.faces[item], errors, self.jumps[item], self.scene.tolerance, self.scene.hold)

    def _used(self, levels) -> Iterator[tuple[int, int, int, int]]:
        """(frame, object, level, level) of the errors on which a plan rests: against the full mesh, and of switches.

        The next coarser level is included, or one whose predicted error is too high would never be tried.
        """
        for item, column in enumerate(levels.T):
            for frame, level in enumerate(column):
                if self.frames.in_view[frame, item]:
                    for candidate in range(level, min(level + 2, len(self.chains[item]))):
                        yield frame, item, 0, int(candidate)
                    if frame and column[frame - 1] != level:
                        yield frame, item, int(column[frame - 1]), int(level)

    def _render(self, fresh):
        pairs = [(frame, item, *(self.chains[item][k] for k in pair)) for frame, item, *pair in fresh]
        if self.scene.kind == "pixels":
            self.frames.measure(pairs)
        for (frame, item, first, second), pair in zip(fresh, pairs, strict=True):
            self.rendered.add((frame, item, first, second))
            error = self.frames.between(*pair)
            self.jumps[item][frame, first, second] = self.jumps[item][frame, second, first] = error
            if first == 0:
                self.errors[item][frame, second] = error

    def _reject_broken(self, levels):
        """Renders whole frames; True where one breaks the tolerance though its objects one by one were within it."""
        plan, broken = Plan(levels, self.chains, self.frames), False
        for frame, check in enumerate(plan.checks):
            for item in np.flatnonzero(check.objects > self.scene.tolerance):
                if self.errors[item][frame, levels[frame, item]] > self.scene.tolerance:
                    continue  # no level has less error
                blamed = self._blamed(plan, frame, item)
                errors, level = self.errors[blamed][frame], levels[frame, blamed]
                if errors[level] <= self.scene.tolerance:
                    errors[level] = max(check.objects[blamed], REJECTED * self.scene.tolerance)
                    broken = True
        return broken

    def _blamed(self, plan, frame, item):
        """The object whose level breaks the tolerance of `item`: itself, or one in front of it.

        A displacement is between meshes of the same object; structure is also lost by a neighbour's changed silhouette.
        """

        def error_without(refined):
            levels = plan.shown(frame)
            levels[refined] = self.frames.full[refined]
            return self.frames.check(frame, levels).objects[item]

        if self.scene.kind == "pixels" or error_without(item) <= self.scene.tolerance:
            return item
        suspects = [k for k, level in enumerate(plan.levels[frame]) if level > 0 and k != item]
        return min(suspects, key=error_without)


VIOLATION_COST = 1e9  # in faces, of an error of twice the tolerance: no saving is worth a visible error


def cheapest(faces: np.ndarray, errors: np.ndarray, jumps: np.ndarray, tolerance: float, hold: int = 1) -> np.ndarray:
    """(f,) the level to show in each frame, with the fewest faces in total.

    faces (f, l): cost of each level in each frame. errors (f, l): on the screen. jumps (f, l, l): how far the picture
    jumps in frame f from one level to another. hold: the least number of frames that a level stays, so that an object
    near a threshold does not flicker (hysteresis; the first and the last level may stay shorter). An error or a jump
    above the tolerance is accepted only where every other sequence has more of it; an infinite error never, if there is
    any other. Exact, by dynamic programming over (level, frames since the last switch).
    """
    frames, count = errors.shape
    cost = faces + _penalty(errors, tolerance)
    jump = _penalty(jumps, tolerance)
    diagonal = np.arange(count)
    jump[:, diagonal, diagonal] = np.inf  # staying is not a switch
    best = np.full((hold, count), np.inf)
    best[-1] = cost[0]
    previous = np.zeros((frames, count), dtype=np.int64)  # the level before a switch
    aged = np.zeros((frames, count), dtype=bool)  # in the oldest state: it was that old before
    for frame in range(1, frames):
        switched = best[-1][:, None] + jump[frame]
        previous[frame] = switched.argmin(axis=0)
        new = np.empty_like(best)
        if hold == 1:
            aged[frame] = best[0] <= switched.min(axis=0)
            new[0] = np.minimum(best[0], switched.min(axis=0))
        else:
            new[0], new[1:] = switched.min(axis=0), best[:-1]
            aged[frame] = best[-1] <= new[-1]
            new[-1] = np.minimum(new[-1], best[-1])
        best = new + cost[frame]
    return _trace(best, previous, aged, hold)


def _penalty(values, tolerance):
    return VIOLATION_COST * np.maximum(values / tolerance - 1, 0)


def _trace(best, previous, aged, hold):
    """The levels, from the last frame back."""
    age, level = np.unravel_index(best.argmin(), best.shape)
    levels = []
    for frame in range(len(previous) - 1, -1, -1):
        levels.append(level)
        if age == hold - 1 and aged[frame, level]:
            continue
        if age == 0:
            level, age = previous[frame, level], hold - 1
        else:
            age -= 1
    return np.array(levels[::-1], dtype=np.int64)


def share_limit(
    levels: Sequence[int] | np.ndarray, faces: Sequence[np.ndarray], errors: Sequence[np.ndarray], limit: int
) -> np.ndarray:
    """(o,) levels with at most `limit` faces together, coarsened where the error grows least.

    levels (o,): those of each object without the limit; faces, errors: one (l_o,) per object, finest first. Repeatedly
    that object takes its next coarser level whose error is then the smallest; of equal ones, that which saves the most
    faces. Where errors grow from level to level, the worst error is thus the smallest that the limit allows.
    """
    levels = np.array(levels)
    total = sum(counts[level] for counts, level in zip(faces, levels, strict=True))
    while total > limit:
        prices = [_price(counts, error, level) for counts, error, level in zip(faces, errors, levels, strict=True)]
        item = prices.index(min(prices))
        if not np.isfinite(prices[item][0]):
            break
        total += faces[item][levels[item] + 1] - faces[item][levels[item]]
        levels[item] += 1
    return levels


def _price(faces, errors, level):
    """(error, minus the faces saved) of the next coarser level; infinite where there is none."""
    if level + 1 >= len(faces):
        return np.inf, 0
    return errors[level + 1], faces[level + 1] - faces[level]

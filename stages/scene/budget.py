"""The smallest face counts of a scene that meet a tolerance, planned by the levels' errors and held by rendering."""

import numpy as np

from .frames import Frames
from .ladder import build_ladder
from .levels import Plan
from .plan import cheapest, share

# A level's error, measured on its whole surface, is that of what a frame shows only within a factor. The search starts
# from less than all of it, so that nothing cheaper is passed over, and every level that it chooses is then rendered.
HOPE = {"pixels": 0.6, "ssim": 0.02}  # of the error on the screen that the 99 % quantile of a level foretells
SAFE = 1.001  # beyond the tolerance: what a frame says against a level that looked right with all else at full detail


def budget(meshes, scene, options=None, ladders=None, frames=None):
    """A Plan: the fewest faces of each object in each frame with which every frame holds the scene's tolerance.

    meshes: dict name -> Mesh; scene: Scene; options: dict name -> options of stages.lod.simplify, for the salient
    places: dict(weights=saliency), or dict(keep=vertices, rings=3). ladders: dict name -> Levels made before
    (build_ladder), in place of options; frames: Frames of this scene, to share what was rendered.

    The levels' own errors foretell what a frame shows; what they choose is rendered, the rendered error takes the place
    of the foretold one, and the plan is made anew until it stands on rendered errors alone and every frame, with all
    objects at their levels, holds. Where a level switches, the jump of the picture is held below the tolerance as well,
    and a level stays for `scene.hold` frames. Where a frame has more than the face limit, the objects are coarsened
    whose error stays the smallest; frames then hold what they can.

    Raises ValueError for a scene that does not fit the meshes, and for a limit below the smallest total, which it
    names.
    """
    if ladders is None:
        scene.poses(meshes)  # says what does not fit before the work begins
        names = sorted({placed.name for placed in scene.objects})
        ladders = {name: build_ladder(meshes[name], **(options or {}).get(name, {})) for name in names}
    frames = frames or Frames(scene, meshes, full_levels(scene, ladders))
    search = _Search(scene, frames, tuple(ladders[placed.name] for placed in scene.objects))
    return search.run()


def full_levels(scene, ladders):
    """The finest Level of each object: the mesh as it is."""
    return [ladders[placed.name][0] for placed in scene.objects]


class _Search:
    def __init__(self, scene, frames, ladders):
        self.scene, self.frames, self.ladders = scene, frames, ladders
        self.faces = [np.array([level.faces for level in ladder]) for ladder in ladders]
        self._check_limit()
        self.errors = [self._foretold(item) for item in range(len(ladders))]
        # The jump between two levels is at least about the coarser one's error, and at most the sum of both.
        self.jumps = [np.maximum(error[:, :, None], error[:, None, :]) for error in self.errors]
        self.known = set()

    def _check_limit(self):
        smallest = int((self.frames.in_view * [counts[-1] for counts in self.faces]).sum(axis=1).max())
        if 0 < self.scene.limit < smallest:
            raise ValueError(
                f"a limit of {self.scene.limit} faces cannot be held: the coarsest levels of what one frame shows have "
                f"{smallest} together; that is the smallest feasible limit"
            )

    def _foretold(self, item):
        quantile = np.array([level.error["q99"] for level in self.ladders[item]])
        return HOPE[self.scene.kind] * quantile * self.frames.scale[:, item, None] * self.frames.in_view[:, item, None]

    def run(self):
        while True:
            levels = self._plan()
            fresh = [state for state in self._used(levels) if state not in self.known]
            if fresh:
                self._render(fresh)
            elif not self._frames_hold_back(levels):
                return Plan(levels, self.ladders, self.frames)

    def _plan(self):
        least = np.zeros(self.frames.shape, dtype=np.int64)
        while True:
            levels = np.stack([self._one(item, least[:, item]) for item in range(len(self.ladders))], axis=1)
            over = np.flatnonzero(self._total(levels) > self.scene.limit) if self.scene.limit else ()
            if not len(over):
                return levels
            for frame in over:  # never one that was shared before: no level is finer than its `least`
                counts = [own * seen for own, seen in zip(self.faces, self.frames.in_view[frame], strict=True)]
                errors = [error[frame] for error in self.errors]
                least[frame] = share(levels[frame], counts, errors, self.scene.limit)

    def _total(self, levels):
        counts = np.stack([faces[k] for faces, k in zip(self.faces, levels.T, strict=True)], axis=1)
        return (counts * self.frames.in_view).sum(axis=1)

    def _one(self, item, least):
        cost = self.faces[item] * self.frames.in_view[:, item, None]
        errors = np.where(np.arange(len(self.ladders[item])) < least[:, None], np.inf, self.errors[item])
        # Out of view all levels cost nothing: a trace of the count keeps the choice defined.
        return cheapest(cost + 1e-3 * self.faces[item], errors, self.jumps[item], self.scene.tolerance, self.scene.hold)

    def _used(self, levels):
        """What a plan rests on: (frame, object, level, level) of errors against the full mesh, and of switches.

        The next coarser level counts as well, or one that was foretold too badly would never be tried.
        """
        for item, column in enumerate(levels.T):
            for frame, level in enumerate(column):
                if self.frames.in_view[frame, item]:
                    for tried in range(level, min(level + 2, len(self.ladders[item]))):
                        yield frame, item, 0, int(tried)
                    if frame and column[frame - 1] != level:
                        yield frame, item, int(column[frame - 1]), int(level)

    def _render(self, fresh):
        wanted = [(frame, item, *(self.ladders[item][k] for k in pair)) for frame, item, *pair in fresh]
        if self.scene.kind == "pixels":
            self.frames.measure(wanted)
        for (frame, item, one, other), pair in zip(fresh, wanted, strict=True):
            self.known.add((frame, item, one, other))
            found = self.frames.between(*pair)
            self.jumps[item][frame, one, other] = self.jumps[item][frame, other, one] = found
            if one == 0:
                self.errors[item][frame, other] = found

    def _frames_hold_back(self, levels):
        """Renders the whole frames; True where one breaks a tolerance that its objects, one by one, held."""
        plan, broken = Plan(levels, self.ladders, self.frames), False
        for frame, check in enumerate(plan.checks):
            for item in np.flatnonzero(check.objects > self.scene.tolerance):
                if self.errors[item][frame, levels[frame, item]] > self.scene.tolerance:
                    continue  # it is not to be had better
                blamed = self._blamed(plan, frame, item)
                errors, level = self.errors[blamed][frame], levels[frame, blamed]
                if errors[level] <= self.scene.tolerance:
                    errors[level] = max(check.objects[blamed], SAFE * self.scene.tolerance)
                    broken = True
        return broken

    def _blamed(self, plan, frame, item):
        """The object whose level breaks the tolerance of `item`: its own, or that of one that stands before it.

        A displacement is between meshes of the same object; structure is lost as well to a neighbour's changed outline.
        """

        def left(refined):
            levels = plan.shown(frame)
            levels[refined] = self.frames.full[refined]
            return self.frames.check(frame, levels).objects[item]

        if self.scene.kind == "pixels" or left(item) <= self.scene.tolerance:
            return item
        others = [k for k, level in enumerate(plan.levels[frame]) if level > 0 and k != item]
        return min(others, key=left)

"""One scene at one tolerance: our plan, and the others at the same measured error of the rendered frames."""

from dataclasses import dataclass, field, replace

import numpy as np

from stages.kit import Stopwatch
from stages.kit.mesh import Mesh

from . import rivals
from .budget import budget
from .frames import Frames
from .ladder import ERRORS
from .levels import Plan
from .plan import cheapest
from .storage import full_of, read_ladders

OURS, PLAIN = "ours", "plain"  # kinds of ladder: with the salient places minded, and without


@dataclass(frozen=True, eq=False)
class Found:
    """A plan by a method. matched: what was made equal to ours, `error` (mean over the frames of the frame error),
    `displacement` (mean over the pixels), `held` (every frame within the tolerance), or nothing; `limit`: half of the
    faces of our fullest frame are all that a frame may have.
    """

    method: str
    matched: str
    plan: Plan
    seconds: float
    note: str = ""


@dataclass(frozen=True, eq=False)
class Contest:
    """A scene, its meshes and frames, and the ladders of each kind for its objects."""

    scene: object
    meshes: dict[str, Mesh]
    frames: Frames
    ladders: dict[str, dict] = field(repr=False)

    def of(self, kind):
        """The ladder of each object of the scene."""
        return tuple(self.ladders[kind][placed.name] for placed in self.scene.objects)


def contest(scene, meshes, folder):
    """A Contest from the ladders in a folder."""
    full = full_of({name: meshes[name] for name in sorted({placed.name for placed in scene.objects})})
    ladders = {kind: read_ladders(folder, kind, full) for kind in (OURS, PLAIN)}
    frames = Frames(scene, meshes, [full[placed.name] for placed in scene.objects])
    return Contest(scene, meshes, frames, ladders)


def mean_error(plan):
    """Mean over the frames of the error held against the tolerance."""
    return float(plan.errors.mean())


def mean_displacement(plan):
    """Mean displacement in pixels over all pixels in which an object is seen."""
    return float(np.concatenate([check.displacements for check in plan.checks]).mean())


def worst_error(plan):
    """The error of the worst frame."""
    return float(plan.errors.max())


def compare(own, counts=None, all_matches=True):
    """list[Found]: ours first.

    counts: (frames, objects) faces that the thesis's network answers, or None; tuned by one factor on all of them.
    all_matches: also plans that are equal to ours in other ways, the full meshes, plans by the levels' own errors,
    never rendered, and plans under a limit of faces.
    """
    found = [_timed(OURS, "", lambda: _budget(own, OURS)), _timed("ours_plain", "", lambda: _budget(own, PLAIN))]
    ours = found[0].plan
    for method, by_size in (("uniform", False), ("uniform_size", True)):
        found += _tuned(own, method, _uniform(own, by_size), ours, all_matches)
    if counts is not None:
        found += _tuned(own, "network", _network(own, counts), ours, all_matches)
    if all_matches:
        found += [_timed("full", "", lambda: rivals.full(own.frames)), *_unrendered(own), *_limited(own, ours)]
        if counts is not None:
            found.append(_timed("network", "asked", lambda: _network(own, counts)(1.0)))
    return found


def _budget(own, kind):
    return budget(own.meshes, own.scene, ladders=own.ladders[kind], frames=own.frames)


def _uniform(own, by_size):
    return lambda coarseness: rivals.uniform(own.frames, own.of(OURS), 1 / coarseness, by_size)


def _network(own, counts):
    return lambda coarseness: rivals.by_counts(own.frames, own.of(OURS), counts / coarseness)


def _limited(own, ours):
    """Half of the faces of our fullest frame, shared where it hurts least, and equally."""
    coarsest = [ladder[-1].faces for ladder in ours.ladders]
    smallest = int((own.frames.in_view * coarsest).sum(axis=1).max())
    limit = max(int(ours.faces.sum(axis=1).max()) // 2, smallest, 1)
    scene = replace(own.scene, limit=limit)
    plans = {
        OURS: lambda: budget(own.meshes, scene, ladders=own.ladders[OURS], frames=own.frames),
        "equal": lambda: rivals.equal(ours, limit),
    }
    return [replace(_timed(name, "limit", make), note=f"limit of {limit:,} faces") for name, make in plans.items()]


def _tuned(own, method, plan_of, ours, all_matches):
    found = [_timed(method, "error", lambda: rivals.tune(plan_of, mean_error, mean_error(ours)))]
    if mean_error(found[0].plan) < mean_error(ours):
        found = [replace(found[0], note="even its coarsest plan has less error than ours")]
    if all_matches:
        wanted = mean_displacement(ours)
        found.append(_timed(method, "displacement", lambda: rivals.tune(plan_of, mean_displacement, wanted)))
        found.append(_timed(method, "held", lambda: rivals.tune_below(plan_of, worst_error, own.scene.tolerance)))
    return found


def _unrendered(own):
    """Plans by one measure of the levels' own surfaces: does it foretell what the frames show?"""
    ladders = own.of(OURS)
    plans = []
    for name in ERRORS:
        with Stopwatch() as watch:
            levels = [_by_surface(own, item, ladder, name) for item, ladder in enumerate(ladders)]
        plan = Plan(np.stack(levels, axis=1), ladders, own.frames)
        plans.append(Found(f"unrendered_{name}", "", plan, watch.seconds))
    return plans


def _by_surface(own, item, ladder, name):
    errors = np.array([level.error[name] for level in ladder]) * own.frames.scale[:, item, None]
    faces = np.array([level.faces for level in ladder]) * own.frames.in_view[:, item, None]
    # The distance of two levels is at most the sum of their errors; as these point anywhere, about the root of squares.
    steps = np.hypot(errors[:, :, None], errors[:, None, :])
    return cheapest(faces, errors, steps, own.scene.tolerance, own.scene.hold)


def _timed(method, matched, make):
    with Stopwatch() as watch:
        plan = make()
        plan.errors  # noqa: B018 (rendered within the time)
    return Found(method, matched, plan, watch.seconds)

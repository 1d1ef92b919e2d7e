"""One scene at one tolerance: our plan, and the others at the same measured error of the rendered frames."""

from dataclasses import dataclass, field, replace

import numpy as np

from stages.kit import Stopwatch
from stages.kit.mesh import Mesh

from . import rivals
from .budget import Plan, budget
from .frames import Frames
from .ladder import ERRORS
from .plan import cheapest
from .storage import full_of, read_ladders

# Kinds of ladder: with the salient places minded, without, and at the shares of the usual practice.
OURS, PLAIN, SHARES = "ours", "plain", "shares"


@dataclass(frozen=True, eq=False)
class Found:
    """A plan by a method. matched: what was made equal to ours, `error` (mean over the frames of the frame error),
    `displacement` (mean over the pixels), `held` (every frame within the tolerance), or nothing.
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
    ladders = {kind: read_ladders(folder, kind, full) for kind in (OURS, PLAIN, SHARES)}
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


def compare(own, counts_of=None, all_matches=True):
    """list[Found]: ours first.

    counts_of: function tolerance -> wanted faces (frames, objects), what the thesis's network answers, or None.
    all_matches: also plans that are equal to ours in other ways, the full meshes, and plans by the levels' own errors,
    never rendered.
    """
    found = [_timed(OURS, "", lambda: _budget(own, OURS)), _timed("ours_plain", "", lambda: _budget(own, PLAIN))]
    ours = found[0].plan
    for method, by_size in (("uniform", False), ("uniform_size", True)):
        found += _tuned(own, method, _uniform(own, by_size), ours, all_matches)
    if counts_of is not None:
        found += _tuned(own, "network", _network(own, counts_of), ours, all_matches)
    if all_matches:
        found += [_timed("full", "", lambda: rivals.full(own.frames)), *_unrendered(own)]
        if counts_of is not None:
            found.append(_timed("network", "asked", lambda: _network(own, counts_of)(1.0)))
    return found


def _budget(own, kind):
    return budget(own.meshes, own.scene, ladders=own.ladders[kind], frames=own.frames)


def _uniform(own, by_size):
    return lambda coarseness: rivals.uniform(own.frames, own.of(SHARES), 1 / coarseness, by_size)


def _network(own, counts_of):
    return lambda coarseness: rivals.by_counts(own.frames, own.of(OURS), counts_of(own.scene.tolerance * coarseness))


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

"""Compares ways to choose the levels of one scene at one tolerance, and stores levels and plans.

Other ways are compared at the same error of the rendered frames. A chain of levels is in
data/SET/scene/levels/NAME/KIND_FACES.npz, its errors in KIND.csv.
"""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from pathlib import Path

import numpy as np
import pandas as pd

from haptic_glance.base.files import read_arrays, read_mesh, read_table, write_mesh, write_table
from haptic_glance.base.timing import Stopwatch
from haptic_glance.lod.scene.beforehand import Profile, by_profiles, by_sums, rendered_sums
from haptic_glance.lod.scene.budget import budget, cheapest
from haptic_glance.lod.scene.camera import Scene
from haptic_glance.lod.scene.chain import ERRORS, Level, finest
from haptic_glance.lod.scene.frames import Frames, Plan
from haptic_glance.mesh.mesh import Mesh

from . import online as rivals
from .online import online

OURS, PLAIN = "ours", "plain"  # kinds of LOD chain: with the salient regions spared, and without
PROFILE = f"{OURS}_profile.npz"
MATCHED, ASKED = ("error", "displacement", "held"), "asked"  # see MethodPlan


@dataclass(frozen=True, eq=False)
class MethodPlan:
    """A plan by a method. matched: the quantity made equal to ours, `error` (mean over the frames of the frame error),
    `displacement` (mean over the pixels), `held` (every frame within the tolerance), or ""; `limit`: under a face limit
    of half of our fullest frame; `asked`: the network's own counts, not tuned.
    """

    method: str
    matched: str
    plan: Plan
    seconds: float
    note: str = ""
    planning: float | None = None  # processor seconds of planning, of planners that begin with nothing rendered


@dataclass(frozen=True, eq=False)
class SceneSetup:
    """A scene, its meshes and frames, and for its objects the LOD chains of each kind and the profiles of ours."""

    scene: Scene
    meshes: dict[str, Mesh]
    frames: Frames
    chains: dict[str, dict[str, tuple[Level, ...]]] = field(repr=False)
    profiles: dict[str, Profile] = field(repr=False, default_factory=dict)

    def of(self, kind: str) -> tuple[tuple[Level, ...], ...]:
        """The LOD chain of each object of the scene."""
        return tuple(self.chains[kind][placed.name] for placed in self.scene.objects)


def load_setup(scene: Scene, meshes: Mapping[str, Mesh], folder: Path) -> SceneSetup:
    """The SceneSetup with the LOD chains in a folder."""
    full = {name: finest(meshes[name]) for name in sorted({placed.name for placed in scene.objects})}
    chains = {kind: {name: read_chain(folder / name, kind, level) for name, level in full.items()}
              for kind in (OURS, PLAIN)}  # fmt: skip
    frames = Frames(scene, meshes, [full[placed.name] for placed in scene.objects])
    profiles = {name: Profile(**read_arrays(folder / name / PROFILE)) for name in full}
    return SceneSetup(scene, dict(meshes), frames, chains, profiles)


def _budget(setup, kind):
    return budget(setup.meshes, setup.scene, chains=setup.chains[kind], frames=setup.frames)


def _online(setup, ours):
    """Planned on frames of their own, so that they render all that they ask about; measured on those of the others."""
    plans = []
    for method, rendered in (("online", True), ("online_unrendered", False)):
        fresh = Frames(setup.scene, setup.meshes, setup.frames.full)
        method_plan = _planned(method, lambda fresh=fresh, rendered=rendered: online(fresh, setup.of(OURS), rendered))
        plans.append(replace(method_plan, plan=Plan(method_plan.plan.levels, method_plan.plan.chains, setup.frames)))
    return plans


def _beforehand(setup, ours):
    """At our mean displacement: by errors rendered beforehand, and by those of every level in every frame.

    The second renders on frames of its own, within its time.
    """
    chains = setup.of(OURS)
    profiles = [setup.profiles[placed.name] for placed in setup.scene.objects]
    fresh = Frames(setup.scene, setup.meshes, setup.frames.full)
    with Stopwatch() as watch:
        sums = rendered_sums(fresh, chains)
    ways = {
        "beforehand": (lambda coarseness: by_profiles(setup.frames, chains, profiles, 1 / coarseness), 0.0),
        "every_level": (lambda coarseness: by_sums(setup.frames, chains, sums, 1 / coarseness), watch.seconds),
    }
    plans = []
    for method, (plan_of, before) in ways.items():
        (tuned,) = _tuned(setup, method, plan_of, ours, ("displacement",))
        single_plan = _planned(method, lambda plan_of=plan_of: plan_of(1.0))  # the price changes nothing of the cost
        plans.append(replace(tuned, planning=before + single_plan.seconds))
    return plans


def _uniform(setup, by_size):
    return lambda coarseness: rivals.uniform(setup.frames, setup.of(OURS), 1 / coarseness, by_size)


def _network(setup, counts):
    return lambda coarseness: rivals.by_counts(setup.frames, setup.of(OURS), counts / coarseness)


def _limited(setup, ours):
    """Half of the faces of our fullest frame, distributed by error, and equally."""
    coarsest = [chain[-1].faces for chain in ours.chains]
    smallest = int((setup.frames.in_view * coarsest).sum(axis=1).max())
    limit = max(int(ours.faces.sum(axis=1).max()) // 2, smallest, 1)
    scene = replace(setup.scene, limit=limit)
    plans = {
        OURS: lambda: budget(setup.meshes, scene, chains=setup.chains[OURS], frames=setup.frames),
        "equal": lambda: rivals.equal(ours, limit),
    }
    return [replace(_timed(name, "limit", make), note=f"limit of {limit:,} faces") for name, make in plans.items()]


MEASURES: dict[str, Callable[[Plan], float]] = {  # mean error over the frames, mean displacement over all pixels
    "error": lambda plan: float(plan.errors.mean()),
    "displacement": lambda plan: float(np.concatenate([check.displacements for check in plan.checks]).mean()),
}


def _tuned(setup, method, plan_of, ours, matched):
    plans = []
    for name, measure in MEASURES.items():
        if name in matched:
            target = measure(ours)
            tuned = _timed(method, name, lambda measure=measure, target=target: rivals.tune(plan_of, measure, target))
            note = f"even its coarsest plan has less {name} than ours" if measure(tuned.plan) < target else ""
            plans.append(replace(tuned, note=note))
    if "held" in matched:
        worst, most = lambda plan: float(plan.errors.max()), setup.scene.tolerance
        plans.append(_timed(method, "held", lambda: rivals.tune(plan_of, worst, most, below=True)))
    return plans


def _unrendered(setup, ours):
    """Plans by one error of the levels' own surfaces, without rendering: do these predict the errors of the frames?"""
    chains = setup.of(OURS)
    plans = []
    for name in ERRORS:
        with Stopwatch() as watch:
            levels = [_by_surface(setup, item, chain, name) for item, chain in enumerate(chains)]
        plan = Plan(np.stack(levels, axis=1), chains, setup.frames)
        plans.append(MethodPlan(f"unrendered_{name}", "", plan, watch.seconds))
    return plans


def _by_surface(setup, item, chain, name):
    errors = np.array([level.error[name] for level in chain]) * setup.frames.scale[:, item, None]
    faces = np.array([level.faces for level in chain]) * setup.frames.in_view[:, item, None]
    # The distance of two levels is at most the sum of their errors; for random directions about their root sum square.
    jumps = np.hypot(errors[:, :, None], errors[:, None, :])
    return cheapest(faces, errors, jumps, setup.scene.tolerance, setup.scene.hold)


def _planned(method, make: Callable[[], Plan]) -> MethodPlan:
    with Stopwatch() as watch:
        plan = make()
    return MethodPlan(method, "", plan, watch.seconds, planning=watch.seconds)


def _timed(method, matched, make: Callable[[], Plan]) -> MethodPlan:
    with Stopwatch() as watch:
        plan = make()
        _ = plan.errors  # rendered within the time
    return MethodPlan(method, matched, plan, watch.seconds)


# Plans beside ours and uniform levels: without salience, all faces, by the levels' own errors without rendering, under
# a face limit, by planners that see no frame ahead, and by the mean displacement, rendered beforehand or in each frame.
OTHERS = {
    "plain": lambda setup, _: [_timed("ours_plain", "", lambda: _budget(setup, PLAIN))],
    "full": lambda setup, _: [_timed("full", "", lambda: rivals.full(setup.frames))],
    "unrendered": _unrendered, "limited": _limited, "online": _online, "beforehand": _beforehand,
}  # fmt: skip


def compare(
    setup: SceneSetup, matched: Sequence[str] = MATCHED, others: Sequence[str] = tuple(OTHERS)
) -> list[MethodPlan]:
    """The plan of each method but the thesis's network, ours first.

    matched: in what the uniform levels are made equal to ours. others: names of OTHERS, further plans.
    """
    plans = [_planned(OURS, lambda: _budget(setup, OURS))]
    ours = plans[0].plan
    for method, by_size in (("uniform", False), ("uniform_size", True)):
        plans += _tuned(setup, method, _uniform(setup, by_size), ours, matched)
    return [*plans, *(planned for name in others for planned in OTHERS[name](setup, ours))]


def compare_network(
    setup: SceneSetup, counts: np.ndarray, ours: Plan, matched: Sequence[str] = (*MATCHED, ASKED)
) -> list[MethodPlan]:
    """The plans by the faces that the thesis's network predicts, counts (frames, objects), tuned by one common factor.

    matched: in what it is made equal to ours; ASKED: its own counts.
    """
    plans = _tuned(setup, "network", _network(setup, counts), ours, matched)
    return [*plans, _timed("network", ASKED, lambda: _network(setup, counts)(1.0))] if ASKED in matched else plans


DIGITS = 9  # decimals of an error, enough for a mesh of unit size


def write_chain(folder: Path, kind: str, levels: Sequence[Level]) -> None:
    """Writes the levels below the finest, and KIND.csv: faces and the errors of each."""
    for level in levels[1:]:
        write_mesh(folder / f"{kind}_{level.faces}.npz", level.mesh)
    errors = [{name: round(error, DIGITS) for name, error in level.error.items()} for level in levels]
    rows = [{"faces": level.faces} | error for level, error in zip(levels, errors, strict=True)]
    write_table(folder / f"{kind}.csv", pd.DataFrame(rows))


def read_chain(folder: Path, kind: str, full: Level) -> tuple[Level, ...]:
    """The Levels of an object; full: the finest one, which all kinds share."""
    table = read_table(folder / f"{kind}.csv").set_index("faces")
    below = [Level(read_mesh(folder / f"{kind}_{faces}.npz"), dict(row)) for faces, row in table.iloc[1:].iterrows()]
    return (full, *below)

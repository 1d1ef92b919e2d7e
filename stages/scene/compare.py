"""Compares ways to choose the levels of one scene at one tolerance, and stores levels and plans.

Other ways are compared at the same error of the rendered frames. A chain of levels is in
data/SET/scene/levels/NAME/KIND_FACES.npz, its errors in KIND.csv.
"""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from pathlib import Path

import numpy as np
import pandas as pd

from haptic_glance.base.files import read_mesh, read_table, write_mesh, write_table
from haptic_glance.base.timing import Stopwatch
from haptic_glance.lod.scene.budget import budget
from haptic_glance.lod.scene.camera import Scene
from haptic_glance.lod.scene.chain import Level, finest
from haptic_glance.lod.scene.frames import Frames, Plan
from haptic_glance.mesh.mesh import Mesh

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


OURS, PLAIN = "ours", "plain"  # kinds of LOD chain: with the salient regions spared, and without
MATCHED, ASKED = ("error", "displacement", "held"), "asked"  # see MethodPlan


@dataclass(frozen=True, eq=False)
class MethodPlan:
    """A plan by a method. matched: the quantity made equal to ours, `error` (mean over the frames of the frame error),
    `displacement` (mean over the pixels), `held` (every frame within the tolerance), or ""; `asked`: the network's own
    counts, not tuned.
    """

    method: str
    matched: str
    plan: Plan
    seconds: float
    note: str = ""
    planning: float | None = None  # processor seconds of planning, of planners that begin with nothing rendered


@dataclass(frozen=True, eq=False)
class SceneSetup:
    """A scene, its meshes and frames, and for its objects the LOD chains of each kind."""

    scene: Scene
    meshes: dict[str, Mesh]
    frames: Frames
    chains: dict[str, dict[str, tuple[Level, ...]]] = field(repr=False)

    def of(self, kind: str) -> tuple[tuple[Level, ...], ...]:
        """The LOD chain of each object of the scene."""
        return tuple(self.chains[kind][placed.name] for placed in self.scene.objects)


def load_setup(scene: Scene, meshes: Mapping[str, Mesh], folder: Path) -> SceneSetup:
    """The SceneSetup with the LOD chains in a folder."""
    full = {name: finest(meshes[name]) for name in sorted({placed.name for placed in scene.objects})}
    chains = {kind: {name: read_chain(folder / name, kind, level) for name, level in full.items()}
              for kind in (OURS, PLAIN)}  # fmt: skip
    frames = Frames(scene, meshes, [full[placed.name] for placed in scene.objects])
    return SceneSetup(scene, dict(meshes), frames, chains)


def _budget(setup, kind):
    return budget(setup.meshes, setup.scene, chains=setup.chains[kind], frames=setup.frames)


def _uniform(setup, by_size):
    return lambda coarseness: uniform(setup.frames, setup.of(OURS), 1 / coarseness, by_size)


def _network(setup, counts):
    return lambda coarseness: by_counts(setup.frames, setup.of(OURS), counts / coarseness)


MEASURES: dict[str, Callable[[Plan], float]] = {  # mean error over the frames, mean displacement over all pixels
    "error": lambda plan: float(plan.errors.mean()),
    "displacement": lambda plan: float(np.concatenate([check.displacements for check in plan.checks]).mean()),
}


def _tuned(setup, method, plan_of, ours, matched):
    plans = []
    for name, measure in MEASURES.items():
        if name in matched:
            target = measure(ours)
            tuned = _timed(method, name, lambda measure=measure, target=target: tune(plan_of, measure, target))
            note = f"even its coarsest plan has less {name} than ours" if measure(tuned.plan) < target else ""
            plans.append(replace(tuned, note=note))
    if "held" in matched:
        worst, most = lambda plan: float(plan.errors.max()), setup.scene.tolerance
        plans.append(_timed(method, "held", lambda: tune(plan_of, worst, most, below=True)))
    return plans


def _planned(method, make: Callable[[], Plan]) -> MethodPlan:
    with Stopwatch() as watch:
        plan = make()
    return MethodPlan(method, "", plan, watch.seconds, planning=watch.seconds)


def _timed(method, matched, make: Callable[[], Plan]) -> MethodPlan:
    with Stopwatch() as watch:
        plan = make()
        _ = plan.errors  # rendered within the time
    return MethodPlan(method, matched, plan, watch.seconds)


def compare(setup: SceneSetup, matched: Sequence[str] = MATCHED, with_full: bool = True) -> list[MethodPlan]:
    """The plan of each method but the thesis's network, ours first.

    matched: in what the uniform levels are made equal to ours. with_full: also all faces.
    """
    plans = [_planned(OURS, lambda: _budget(setup, OURS))]
    ours = plans[0].plan
    for method, by_size in (("uniform", False), ("uniform_size", True)):
        plans += _tuned(setup, method, _uniform(setup, by_size), ours, matched)
    plans.append(_timed("ours_plain", "", lambda: _budget(setup, PLAIN)))
    return [*plans, _timed("full", "", lambda: full(setup.frames))] if with_full else plans


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

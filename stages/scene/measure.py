"""The jobs of a scene: read objects and levels, compare the ways to choose levels, return the rows.

The thesis's network for scenes, the faces of each object at each distance learned from other objects (T3.1.3), is a job
of its own, since it alone depends on objects that are not in the scene.
"""

import sys
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd

from haptic_glance.base.files import read_arrays, read_mesh, read_table, write_arrays, write_table
from haptic_glance.lod.scene.camera import Placed, Scene, fly
from haptic_glance.lod.scene.frames import Frames, Plan
from haptic_glance.lod.scene.level_renders import displacement_picture, shaded
from haptic_glance.lod.task import variant
from haptic_glance.mesh.mesh import Mesh
from stages.engine.run import Rows
from stages.lod.cell import ObjectInputs, keep_rule
from stages.salient_points.measure import read_saliency, read_strong_points

from . import Params
from .compare import (
    ASKED,
    MATCHED,
    OURS,
    MethodPlan,
    SceneSetup,
    compare,
    compare_network,
    load_setup,
)
from .counts.evaluate import COMBINED, Map, evaluate_counts
from .counts.models import Counts, fit_counts, read_curves
from .rows import frame_rows, plan_rows, saved_rows

SHOWN = ("full", "uniform", OURS)  # methods of the pictures for the report
FRAMED = ("full", "uniform", "uniform_size", "network", OURS, "ours_plain")  # with rows of every frame
MAIN = ("", "error")  # plans of their own, and those at the same mean error
TABLE, PLAN_FILE = (
    "plan.csv",
    "plans/{}.npz",
)  # of our plan, and of all: METHOD or METHOD.MATCHED -> (frames, objects) levels


@dataclass(frozen=True)
class Case:
    """A scene at its tolerance times a factor."""

    settings: Params
    factor: float = 1.0

    @property
    def name(self) -> str:
        """That of its files and of its item."""
        return f"{self.settings.name}_{self.factor:g}"

    @property
    def matched(self) -> tuple[str, ...]:
        """In what rivals are made equal to ours."""
        return MATCHED if self.in_detail else ("error",)

    @property
    def in_detail(self) -> bool:
        """Whether its frames have rows, and its plan a table and pictures."""
        return self.factor == 1


def measure(case: Case, folder: Path, data: Path, made: Path, shown: Sequence[str], seed: int) -> Rows:
    """Rows of a case by all methods but the network; also writes the levels of each plan.

    made: what the run has written so far, with the levels. shown: the names of the objects with levels. In detail it
    also writes the table of our plan and pictures.
    """
    setup, saliency = _setup(case, data, made, shown)
    plans = compare(setup, case.matched, with_full=case.in_detail)
    levels = {f"{planned.method}.{planned.matched}".rstrip("."): planned.plan.levels for planned in plans}
    write_arrays(folder / PLAN_FILE.format(case.name), **levels)
    if case.in_detail:
        write_table(folder / TABLE, pd.DataFrame(plan_table(setup, plans[0].plan)))
        write_arrays(folder / "pictures.npz", **pictures(setup, _framed(plans)))
    return _rows(setup, plans[0], plans, saliency, case, seed)


def measure_network(
    case: Case, folder: Path, data: Path, made: Path, shown: Sequence[str], others: Sequence[str], seed: int
) -> Rows:
    """Rows of the thesis's network, as `measure` has them of the other methods; one with the reason if there is none.

    others: the objects without levels; from the curves of all that are not in the scene it learns.
    """
    setup, saliency = _setup(case, data, made, shown)
    others = sorted({*shown, *others} - {placed.name for placed in setup.scene.objects})
    try:
        if setup.scene.kind != "pixels":
            raise ValueError("the thesis's network has no perceptual tolerance")
        model = fit_network(data, others, setup.scene.cameras[0].focal, COMBINED, seed)
    except ValueError as error:
        row = {"method": "network", "kind": setup.scene.kind, "tolerance": setup.scene.tolerance, "matched": "error"}
        row |= {"frame": "all", "metric": "faces", "value": None, "note": str(error)}
        return [row | {"factor": case.factor, "group": case.settings.name}]
    ours = MethodPlan(
        OURS, "", Plan(read_arrays(made / PLAN_FILE.format(case.name))[OURS], setup.of(OURS), setup.frames), 0.0
    )
    matched = (*case.matched, *([ASKED] if case.in_detail else []))
    plans = compare_network(setup, _counts(setup, data, model), ours.plan, matched)
    return _rows(setup, ours, plans, saliency, case, seed)


def _setup(case, data, made, shown):
    """(SceneSetup, dict name -> saliency (n,) or None) of a case."""
    scene, _ = scene_of(case.settings, shown, case.factor)
    names = sorted({placed.name for placed in scene.objects})
    inputs = {name: read_object(data, name, case.settings.method) for name in names}
    setup = load_setup(scene, {name: mesh for name, (mesh, *_) in inputs.items()}, made / "levels")
    return setup, {name: values for name, (*_, values) in inputs.items()}


def _rows(setup, ours, plans, saliency, case, seed):
    """All rows of these plans; those of frames only in detail."""
    framed = _framed(plans) if case.in_detail else []
    pictured = [case.in_detail and planned.matched in MAIN for planned in plans]  # 1 - SSIM takes a fourth of the time
    rows = [
        row for planned, flag in zip(plans, pictured, strict=True) for row in plan_rows(setup, planned, saliency, flag)
    ]
    rows += saved_rows(setup, ours, plans, seed)
    rows += [row for planned in framed for row in frame_rows(setup, planned)]
    return [row | {"factor": case.factor, "group": case.settings.name} for row in rows]


def _framed(plans):
    return [planned for planned in plans if planned.matched in MAIN and planned.method in FRAMED]


def _counts(setup, data, model):
    """(frames, objects) faces that the thesis's network predicts."""
    scene, points = setup.scene, []
    for placed in scene.objects:
        strong = read_strong_points(data / POINTS.format(placed.name))
        points.append({name: len(strong[name]) for name in model.regressors})
    diagonals = [setup.meshes[placed.name].diagonal * pose.scale
                 for placed, pose in zip(scene.objects, setup.frames.poses, strict=True)]  # fmt: skip
    return predicted_counts(model, setup.frames, points, np.array(diagonals), scene.tolerance)


def plan_table(setup: SceneSetup, plan: Plan) -> list[dict]:
    """Rows of a plan: frame, place (index in the scene), item, faces of its level, and its error in the frame."""
    return [
        {"frame": frame, "place": item, "item": setup.scene.objects[item].name, "level": int(plan.levels[frame, item]),
         "faces": level.faces, "in_view": bool(setup.frames.in_view[frame, item]),
         "error": round(float(plan.checks[frame].objects[item]), 6)}
        for frame in range(len(plan.levels))
        for item, level in enumerate(plan.shown(frame))
    ]  # fmt: skip


def pictures(setup: SceneSetup, entries: Sequence[MethodPlan]) -> dict[str, np.ndarray]:
    """Arrays: frames (k,), methods (m,), rgb (k, m, h, w, 3) u1, displacement (k, m, h, w) f2 in pixels."""
    plans = {entry.method: entry.plan for entry in entries}
    methods = [method for method in SHOWN if method in plans]
    order = np.argsort(setup.frames.scale.mean(axis=1), kind="stable")  # far frames first, of few pixels
    frames = np.unique([order[len(order) // 3], order[2 * len(order) // 3], order[-1]])
    cells = [[(setup.frames, frame, plans[method].shown(frame)) for method in methods] for frame in frames]
    return {
        "frames": frames,
        "methods": np.array(methods),
        "rgb": np.stack([[shaded(*cell).clip(0, 255).astype(np.uint8) for cell in row] for row in cells]),
        "displacement": np.stack([[displacement_picture(*cell).astype(np.float16) for cell in row] for row in cells]),
    }


MESH, POINTS = "meshes/{}.npz", "salient_points/{}.npz"  # of an object, below data/SET


def scene_of(settings: Params, names: Sequence[str], factor: float = 1.0) -> tuple[Scene, list[str]]:
    """(Scene of the settings, its objects that are not among `names`), the tolerance times `factor`.

    Where none of its objects is among `names`, as with meshes of one's own, the named ones take their places in order,
    once each. Raises ValueError where the scene has no place, and as Scene and fly do.
    """
    missing = list(dict.fromkeys(item.name for item in settings.objects if item.name not in names))
    present = [(item.name, item) for item in settings.objects if item.name in names]
    present = present or list(zip(names, settings.objects, strict=False))
    if not present:
        raise ValueError(f"scene {settings.name} has no object, or data/SET/meshes is empty: choose another scene")
    placed = tuple(Placed(name, _place(item), item.turn, item.size) for name, item in present)
    if len(settings.screen) != 2:
        raise ValueError(f"scene.screen is {settings.screen}: give rows and columns")
    eyes, targets = ([getattr(key, end) for key in settings.camera] for end in ("eye", "target"))
    cameras = tuple(fly(eyes, targets, settings.frames, settings.angle, settings.screen))
    scene = Scene(placed, cameras, settings.tolerance * factor, settings.kind, settings.limit, settings.hold)
    return scene, missing


def _place(item):
    if len(item.position) != 3:
        raise ValueError(f"{item.name} stands at {item.position}: give x, y, z in metres")
    x, y, z = item.position
    return x, y, z


def report_missing(settings: Params, scene: Scene, missing: Sequence[str]) -> None:
    """Prints which objects are missing, and which take their places where none of the scene's own is present."""
    if missing:
        scene_names = {item.name for item in settings.objects}
        stand_ins = ", ".join(dict.fromkeys(item.name for item in scene.objects if item.name not in scene_names))
        how = f"with {stand_ins} in their places" if stand_ins else "without them"
        print(f"scene: {settings.name} continues {how}; not in data/SET/meshes: {', '.join(missing)}", file=sys.stderr)


def read_object(data: Path, name: str, method: str) -> tuple[Mesh, dict[str, Any], np.ndarray | None]:
    """(Mesh, options of simplify, saliency (n,) or None) of an object in data/SET, for a method of the lod stage."""
    path = data / POINTS.format(name)
    mesh, saliency = read_mesh(data / MESH.format(name)), read_saliency(path)
    lod_variant = variant(method)
    rule = keep_rule(ObjectInputs(name, mesh, read_strong_points(path), saliency), lod_variant)
    options = {"keep": rule.vertices, "rings": rule.rings, "weights": rule.weights}
    return mesh, options, saliency.get(lod_variant.method or "")


CURVE = "lod/{}/curve.csv"  # of an object, below data/SET


def lod_rows(data: Path, objects: Sequence[str]) -> pd.DataFrame:
    """The rows of the lod stage for some objects. Raises ValueError where it has none."""
    paths = [data / CURVE.format(name) for name in objects]
    tables = [read_table(path) for path in paths if path.exists()]
    if not tables:
        raise ValueError(f"no {data / CURVE.format('NAME')} to learn from: run `dvc repro lod@{data.name}`")
    return pd.concat(tables)


def evaluation_rows(data: Path, objects: Sequence[str], seed: int, side_by_side: Map) -> Rows:
    """Rows of `evaluate_counts` on all these objects."""
    meshes = {name: read_mesh(data / MESH.format(name)) for name in objects}
    points = {name: read_strong_points(data / POINTS.format(name)) for name in objects}
    curves = read_curves(lod_rows(data, objects), {name: len(mesh.faces) for name, mesh in meshes.items()})
    return evaluate_counts(curves, meshes, points, seed, side_by_side)


def fit_network(data: Path, objects: Sequence[str], focal: float, combinations: Sequence[str], seed: int) -> Counts:
    """The thesis's network, trained on the measured curves of some objects.

    objects: those outside the scene; focal: pixels per unit at distance one. Raises ValueError where there is no curve
    to train on.
    """
    if not objects:
        raise ValueError("no object outside the scene to train on")
    rows = lod_rows(data, objects)
    faces = {name: len(read_mesh(data / MESH.format(name)).faces) for name in objects}
    return fit_counts(read_curves(rows, faces), combinations, "network", seed, focal)


def predicted_counts(
    model: Counts, frames: Frames, points: Sequence[Mapping[str, int]], diagonals: np.ndarray, tolerance: float
) -> np.ndarray:
    """(frames, objects) f8 face counts that the model predicts.

    points: dict combination -> number, per object; diagonals: in metres, per object. Distances are in
    diagonals of the object, as in training.
    """
    distance = frames.distance / diagonals
    pixels = np.full(len(distance), tolerance)
    columns = [
        model.faces_needed(pixels, distance[:, item], level.faces, points[item])
        for item, level in enumerate(frames.full)
    ]
    return np.stack(columns, axis=1).astype(np.float64)

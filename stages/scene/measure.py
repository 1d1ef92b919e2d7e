"""The jobs of one tolerance: read the levels, compare the methods to choose them, return the rows.

The network is a job of its own: it alone depends on objects that are not in the scene.
"""

from collections.abc import Sequence
from pathlib import Path

import numpy as np
import pandas as pd

from stages.kit.files import write_arrays, write_table
from stages.kit.run import Rows
from stages.salient_points import read_strong_points

from .compare import OURS, MethodPlan, SceneSetup, compare, compare_network, load_setup
from .counts.evaluate import COMBINED
from .levels import Plan
from .network import fit_network, predicted_counts
from .pictures import displacement_picture, shaded
from .read import POINTS, read_object, scene_of
from .rows import frame_rows, object_rows, plan_rows, saved_rows
from .schema import Params
from .storage import read_plan, write_plan

SHOWN = ("full", "uniform", OURS)  # methods of the pictures for the report
FRAMED = ("full", "uniform", "uniform_size", "network", OURS, "ours_plain")  # with rows of every frame
MAIN = ("", "error")  # plans of their own, and those at the same mean error
TABLE = "plan.csv"


def measure(
    factor: float, folder: Path, data: Path, made: Path, settings: Params, shown: Sequence[str], seed: int
) -> Rows:
    """Rows of the scene at its tolerance times a factor, by all methods but the network; also writes our plan.

    made: what the run has written so far, with the levels. shown: the names of the scene's objects. At the factor 1
    also writes the table of the plan and pictures.
    """
    setup, saliency = _setup(factor, data, made, settings, shown)
    found = compare(setup, all_matches=factor == 1)
    write_plan(folder, factor, found[0].plan.levels)
    if factor == 1:
        write_table(folder / TABLE, pd.DataFrame(plan_table(setup, found[0].plan)))
        write_arrays(folder / "pictures.npz", **pictures(setup, _framed(found)))
    return _rows(setup, found[0], found, saliency, factor, seed)


def measure_network(
    factor: float, folder: Path, data: Path, made: Path, settings: Params, shown: Sequence[str], others: Sequence[str],
    seed: int,
) -> Rows:  # fmt: skip
    """Rows of the thesis's network, as `measure` has them of the other methods; one with the reason if there is none.

    others: the objects outside the scene, from whose curves it learns.
    """
    setup, saliency = _setup(factor, data, made, settings, shown)
    try:
        model = _model(setup.scene, data, others, seed)
    except ValueError as error:
        row = {"method": "network", "kind": settings.kind, "tolerance": setup.scene.tolerance, "matched": "error"}
        row |= {"frame": "all", "metric": "faces", "value": None, "note": str(error)}
        return [row | {"factor": factor}]
    ours = MethodPlan(OURS, "", Plan(read_plan(made, factor), setup.of(OURS), setup.frames), 0.0)
    found = compare_network(setup, _counts(setup, data, model), ours.plan, all_matches=factor == 1)
    return _rows(setup, ours, found, saliency, factor, seed)


def _setup(factor, data, made, settings, shown):
    """(SceneSetup, dict name -> saliency (n,) or None) of the scene at its tolerance times a factor."""
    scene, _ = scene_of(settings, shown, factor)
    read = {name: read_object(data, name, settings.method) for name in shown}
    setup = load_setup(scene, {name: mesh for name, (mesh, *_) in read.items()}, made / "levels")
    return setup, {name: values for name, (*_, values) in read.items()}


def _rows(setup, ours, found, saliency, factor, seed):
    """All rows of the plans `found`; those of frames and objects only at the scene's own tolerance."""
    framed = _framed(found) if factor == 1 else []
    rows = [row for each in found for row in plan_rows(setup, each, saliency, factor == 1 and each.matched in MAIN)]
    rows += saved_rows(setup, ours, found, seed)
    rows += [row for each in framed for row in (*frame_rows(setup, each), *object_rows(setup, each))]
    return [row | {"factor": factor} for row in rows]


def _framed(found):
    return [each for each in found if each.matched in MAIN and each.method in FRAMED]


def _model(scene, data, others, seed):
    """The thesis's network for the scene; ValueError where there is none."""
    if scene.kind != "pixels":
        raise ValueError("the thesis's network has no perceptual tolerance")
    return fit_network(data, others, scene.cameras[0].focal, COMBINED, seed)


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


def pictures(setup: SceneSetup, found: Sequence[MethodPlan]) -> dict[str, np.ndarray]:
    """Arrays: frames (k,), methods (m,), rgb (k, m, h, w, 3) u1, displacement (k, m, h, w) f2 in pixels."""
    plans = {each.method: each.plan for each in found}
    methods = [method for method in SHOWN if method in plans]
    size = setup.frames.scale.mean(axis=1)
    frames = np.unique([0, int(np.argsort(size)[len(size) // 2]), int(size.argmax())])  # far, middle, and nearest
    rows = [(frame, [plans[method].shown(frame) for method in methods]) for frame in frames]
    return {
        "frames": frames,
        "methods": np.array(methods),
        "rgb": np.stack([[_rgb(setup, frame, levels) for levels in row] for frame, row in rows]),
        "displacement": np.stack([[_displacement(setup, frame, levels) for levels in row] for frame, row in rows]),
    }


def _rgb(setup, frame, levels):
    return shaded(setup.frames, frame, levels).clip(0, 255).astype(np.uint8)


def _displacement(setup, frame, levels):
    return displacement_picture(setup.frames, frame, levels).astype(np.float16)

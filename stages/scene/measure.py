"""The job of one tolerance: reads the levels, compares the ways to choose them, returns the rows."""

import numpy as np
import pandas as pd

from stages.kit.files import read_mesh, write_arrays, write_table
from stages.kit.run import DATA
from stages.salient_points import read_strong_points

from .compare import OURS, compare, contest
from .counts.judge import COMBINED
from .network import counts_wanted, learn
from .pictures import displacement_picture, shaded
from .read import read_object, scene_of
from .rows import frame_rows, object_rows, plan_rows, saved_rows

SHOWN = ("full", "uniform", OURS)  # methods of the pictures for the report
FRAMED = ("full", "uniform", "uniform_size", "network", OURS, "ours_plain")  # with rows of every frame
TABLE = "plan.csv"


def measure(job, folder, settings, factors, objects, seed):
    """Rows of the scene at its tolerance times factors[job]; at the factor 1 also the plan and pictures of frames."""
    factor = factors[job]
    scene, _ = scene_of(settings, objects, factor)
    known = {name: read_object(name, settings.method) for name in {placed.name for placed in scene.objects}}
    own = contest(scene, {name: mesh for name, (mesh, *_) in known.items()}, folder / "levels")
    saliency = {name: values for name, (*_, values) in known.items()}
    counts, note = _network(own, objects, seed)
    found = compare(own, counts, all_matches=factor == 1)
    shown = [factor == 1 and each.matched in ("", "error") for each in found]
    rows = [
        row for each, pictured in zip(found, shown, strict=True) for row in plan_rows(own, each, saliency, pictured)
    ]
    rows += saved_rows(own, found[0], found[1:], seed)
    if factor == 1:
        first = [each for each in found if each.matched in ("", "error") and each.method in FRAMED]
        rows += [row for each in first for row in (*frame_rows(own, each), *object_rows(own, each))]
        write_table(folder / TABLE, pd.DataFrame(plan_table(own, found[0].plan)))
        write_arrays(folder / "pictures.npz", **pictures(own, first))
    if note:
        missing = {"method": "network", "kind": scene.kind, "tolerance": scene.tolerance, "matched": "error"}
        rows.append(missing | {"frame": "all", "metric": "faces", "value": None, "note": note})
    return [row | {"scene": settings.name, "factor": factor} for row in rows]


def _network(own, objects, seed):
    """((frames, objects) faces that the thesis's network answers, or None; why there is none)."""
    scene, names = own.scene, {placed.name for placed in own.scene.objects}
    if scene.kind != "pixels":
        return None, "the thesis's network knows no perceptual tolerance"
    faces = {name: len(read_mesh(DATA / "meshes" / f"{name}.npz").faces) for name in objects}
    try:
        model = learn(faces, names, scene.cameras[0].focal, COMBINED, seed)
    except ValueError as error:
        return None, str(error)
    points = []
    for placed in scene.objects:
        strong = read_strong_points(DATA / "salient_points" / f"{placed.name}.npz")
        points.append({name: len(strong[name]) for name in model.regressors})
    diagonals = [own.meshes[placed.name].diagonal * pose.scale
                 for placed, pose in zip(scene.objects, own.frames.poses, strict=True)]  # fmt: skip
    return counts_wanted(model, own.frames, points, np.array(diagonals), scene.tolerance), ""


def plan_table(own, plan):
    """Rows of a plan: frame, item (its place in the scene), object, faces of its level, and its error in the frame."""
    return [
        {"frame": frame, "item": item, "object": own.scene.objects[item].name, "level": int(plan.levels[frame, item]),
         "faces": level.faces, "in_view": bool(own.frames.in_view[frame, item]),
         "error": round(float(plan.checks[frame].objects[item]), 6)}
        for frame in range(len(plan.levels))
        for item, level in enumerate(plan.shown(frame))
    ]  # fmt: skip


def pictures(own, found):
    """Arrays: frames (k,), methods (m,), rgb (k, m, h, w, 3) u1, displacement (k, m, h, w) f2 in pixels, NaN off."""
    plans = {each.method: each.plan for each in found}
    methods = [method for method in SHOWN if method in plans]
    size = own.frames.scale.mean(axis=1)
    frames = np.unique([0, int(np.argsort(size)[len(size) // 2]), int(size.argmax())])  # far, between, and nearest
    shown = [[plans[method].shown(frame) for method in methods] for frame in frames]
    return {
        "frames": frames,
        "methods": np.array(methods),
        "rgb": np.stack([[shaded(own.frames, frame, levels).clip(0, 255).astype(np.uint8) for levels in row]
                         for frame, row in zip(frames, shown, strict=True)]),
        "displacement": np.stack([[displacement_picture(own.frames, frame, levels).astype(np.float16) for levels in row]
                                  for frame, row in zip(frames, shown, strict=True)]),
    }  # fmt: skip

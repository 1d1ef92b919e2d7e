"""Finds the fewest faces with which each object is seen, felt and recognised as the full mesh is.

Reads data/SET/meshes, data/SET/salient_points and the levels of data/SET/scene. Writes data/SET/face_needs/NAME.npz
(what touches read on each level) and reports/measurements/SET/face_needs.csv.gz: a row an object, task and condition.
Seen: the picture is displaced by no more than a tolerance, from all round. Felt: imprints at the same places differ by
no more than a share of full scale. Recognised: touches of the real object are known by a model learned from the
simplified one, within some points of accuracy.
"""

import functools
from collections.abc import Mapping, Sequence
from pathlib import Path

import numpy as np
from sklearn.model_selection import StratifiedKFold

from haptic_glance.base.files import read_arrays, read_mesh, read_table, write_arrays
from haptic_glance.know import classifier, features
from haptic_glance.lod.scene import Camera, Frames, Level, Placed, Scene
from haptic_glance.lod.scene.chain import finest
from haptic_glance.mesh.mesh import Mesh
from haptic_glance.touch import Surface, press_at, sensor_axes, sensor_normals
from stages.engine.run import Rows, StageRun
from stages.engine.settings import Workspace, workspace_of_arguments
from stages.salient_points.measure import read_points
from stages.scene.compare import OURS, read_chain

from . import COLUMNS, Params

READS = ("meshes/{}.npz", "meshes/manifest.csv", "salient_points/{}.npz", "scene/levels/{}")
RISE = 25.0  # degrees above the horizon from which an object is seen


def process(name: str, folder: Path, data: Path, settings: Params) -> Rows:
    """Rows of the faces that an object needs to be seen and felt; writes NAME.npz, what its touches read on each level.

    Arrays: faces (levels,), finest first; features (levels, k, 41) of the imprints at the same k places.
    """
    mesh = read_mesh(data / f"meshes/{name}.npz")
    chain = read_chain(data / f"scene/levels/{name}", OURS, finest(mesh))
    size = read_table(data / "meshes/manifest.csv").set_index("object")["size"].to_dict()[name]
    faces = np.array([level.faces for level in chain])
    rows = [row(name, "full", None, faces[0])]
    for distance in settings.distances:
        errors = seen(mesh, chain, size, distance, settings)
        rows.append(row(name, "seen", distance, faces[coarsest(errors <= settings.tolerance)]))
    images = felt(mesh, chain, read_points(data / f"salient_points/{name}.npz")[settings.detector], settings)
    imprint_errors = differences(images)
    rows += [row(name, "felt", reading, faces[coarsest(imprint_errors <= reading)]) for reading in settings.readings]
    write_arrays(folder / f"{name}.npz", faces=faces, features=np.stack([features(imprints) for imprints in images]))
    return rows


def row(name: str | None, task: str, condition: float | None, faces: float) -> dict:
    """A row of the faces that an object needs; name: None for all together."""
    return {"item": name, "task": task, "condition": condition, "metric": "faces", "value": int(faces)}


def seen(mesh: Mesh, chain: Sequence[Level], size: float, distance: float, settings: Params) -> np.ndarray:
    """(levels,) largest error on the screen, in pixels, of an object `size` metres long over views all round."""
    azimuths = np.arange(settings.views) * 2 * np.pi / settings.views
    rise = np.radians(RISE)
    target = (0.0, 0.0, size * float(np.ptp(mesh.vertices[:, 2]) / np.ptp(mesh.vertices, axis=0).max()) / 2)
    along = np.stack([np.cos(azimuths) * np.cos(rise), np.sin(azimuths) * np.cos(rise),
                      np.full(len(azimuths), np.sin(rise))], axis=1)  # fmt: skip
    screen = settings.screen[0], settings.screen[1]
    cameras = tuple(Camera(tuple(target + distance * way), target, settings.angle, screen) for way in along)
    scene = Scene((Placed("object", (0.0, 0.0, 0.0), 0.0, size),), cameras, settings.tolerance)
    frames = Frames(scene, {"object": mesh}, [chain[0]])
    indices = range(len(cameras))
    frames.measure((frame, 0, chain[0], level) for level in chain for frame in indices)
    return np.array([max(frames.between(frame, 0, chain[0], level) for frame in indices) for level in chain])


def felt(mesh: Mesh, chain: Sequence[Level], places: np.ndarray, settings: Params) -> np.ndarray:
    """(levels, k, rows, columns) f4: the imprints on each level, the array held as at places (k,) of the full mesh."""
    places = places[: settings.touches]
    centres, axes = mesh.vertices[places], sensor_axes(sensor_normals(mesh, places))
    cells = settings.cells[0], settings.cells[1]
    return np.stack([press_at(Surface(level.mesh), centres, axes, cells, settings.pitch) for level in chain])


def differences(images: np.ndarray) -> np.ndarray:
    """(levels,) root mean square difference of imprints (levels, k, rows, columns) from those of the first level."""
    return np.sqrt(((images - images[0]).astype(np.float64) ** 2).mean(axis=(1, 2, 3)))


PRECISION = 1e-9  # of an accuracy


def recognise(item: str, folder: Path, made: Path, names: Sequence[str], settings: Params, seed: int) -> Rows:
    """Rows of the faces of the model with which each object's touches are recognised, and of the accuracy of full ones.

    The last row is of the level at which the mean of all objects is within the slack, far less a matter of chance: the
    median of the objects' faces there. made: the folder with what `process` wrote.
    """
    arrays_by_name = {name: read_arrays(made / f"{name}.npz") for name in names}
    shares = accuracies({name: arrays["features"] for name, arrays in arrays_by_name.items()}, settings, seed)
    rows = []
    for name, accuracy in shares.items():
        faces = arrays_by_name[name]["faces"]
        rows.append(row(name, "recognised", settings.slack, faces[_enough(accuracy[: len(faces)], settings)]))
        rows.append({"item": name, "task": "recognised", "metric": "accuracy", "value": float(accuracy[0])})
    level = _enough(np.mean(list(shares.values()), axis=0), settings)
    together = np.median([arrays["faces"][min(level, len(arrays["faces"]) - 1)] for arrays in arrays_by_name.values()])
    return [*rows, row(None, "recognised", settings.slack, together) | {"metric": "faces_together"}]


def _enough(accuracy, settings):
    return coarsest(accuracy >= accuracy[0] - settings.slack - PRECISION)


def accuracies(samples: Mapping[str, np.ndarray], settings: Params, seed: int) -> dict[str, np.ndarray]:
    """dict name -> (levels,) share of an object's real touches that kNN names, by the level that it was learned from.

    samples: dict name -> (levels, k, features), finest first. All objects are learned from the same level, one that has
    fewer levels from its last; asked about are touches of the full meshes. Each place is held out once a folding.
    """
    levels = max(len(stack) for stack in samples.values())
    learned = [
        np.concatenate([stack[min(level, len(stack) - 1)] for stack in samples.values()]) for level in range(levels)
    ]
    truth = np.repeat(np.arange(len(samples)), [stack.shape[1] for stack in samples.values()])
    right = np.zeros((levels, len(truth)))
    for repetition in range(settings.repetitions):
        folds = StratifiedKFold(settings.folds, shuffle=True, random_state=seed + repetition)
        for train, test in folds.split(truth, truth):
            for level, touches in enumerate(learned):
                model = classifier("knn").fit(touches[train], truth[train])
                right[level, test] += model.predict(learned[0][test]) == truth[test]
    share = right / settings.repetitions
    return {name: share[:, truth == number].mean(axis=1) for number, name in enumerate(samples)}


def coarsest(passes: np.ndarray) -> int:
    """The last level of those passes (levels,), finest first, that pass with all finer ones; 0 where the first fails.

    A coarse level that passes by luck, after a finer one that fails, is not enough.
    """
    failing = np.flatnonzero(~np.asarray(passes, dtype=bool))
    return max(int(failing[0]) - 1, 0) if len(failing) else len(passes) - 1


def run(workspace: Workspace) -> None:
    """Runs the stage on the data set of a workspace."""
    settings = workspace.settings(Params)
    with StageRun(workspace, "face_needs", COLUMNS, inputs=("meshes", "salient_points", "scene")) as stage:
        names = [name for name in stage.objects if (workspace.data / "scene/levels" / name).is_dir()]
        stage.each(functools.partial(process, data=workspace.data, settings=settings), names, READS)
        work = functools.partial(recognise, made=stage.folder, names=names, settings=settings, seed=stage.seed)
        stage.each(work, ["all objects"], ["face_needs"])
        medians = summary(stage.rows)
        stage.metrics(medians)
    text = ", ".join(f"{name} {value:.0f}" for name, value in medians.items())
    print(f"face_needs: {workspace.dataset}, {len(names)} objects; median faces: {text}")


def summary(rows: Rows) -> dict[str, float]:
    """{task, or task_condition: the median face count over the objects}."""
    counts: dict[str, list[float]] = {}
    for row in rows:
        if row["metric"] == "faces":
            name = row["task"] if row["condition"] is None else f"{row['task']}_{row['condition']:g}"
            counts.setdefault(name, []).append(row["value"])
    return {name: float(np.median(values)) for name, values in counts.items()}


if __name__ == "__main__":
    run(workspace_of_arguments(__doc__, "face_needs"))

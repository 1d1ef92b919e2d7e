"""Trains on simulated imprints, on real touches and on both, and tests on real touches of the same classes.

Reads the archive of pressure images that recorded.folder names, and data/SET/meshes: for some of its classes, objects
of like name and shape. Writes data/SET/simulated_to_real/NAME.npz (the simulated imprints of an object) and
reports/measurements/SET/simulated_to_real.csv.gz.
"""

import functools
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import trimesh
from sklearn.decomposition import PCA
from sklearn.pipeline import make_pipeline
from sklearn.preprocessing import StandardScaler
from threadpoolctl import threadpool_limits

from haptic_glance.base.files import read_arrays, read_mesh, read_table, write_arrays
from haptic_glance.base.rng import rng
from haptic_glance.base.timing import Stopwatch
from haptic_glance.know import CLASSIFIERS, features
from haptic_glance.know.classifiers import COMPONENTS
from haptic_glance.know.split import Split
from haptic_glance.mesh.mesh import Mesh, corner_sum
from haptic_glance.touch import Skin, Surface, distances_at, indent, press_many, sensor_axes, touchable
from stages.classification.touch_readers import read_pressure_images
from stages.engine.rows import named_means
from stages.engine.run import Rows, StageRun
from stages.engine.settings import Workspace, workspace_of_arguments
from stages.meshes.collect import read_classes
from stages.recorded import Params as RecordedParams
from stages.recorded.splits import block_split, split_number

from . import COLUMNS, Params


@dataclass(frozen=True)
class Touches:
    """Features (k, 41) and class (k,) of k touches."""

    samples: np.ndarray
    labels: np.ndarray


@dataclass(frozen=True)
class Training:
    """One way to train: columns of its rows, training touches, and all real features (k, 41) on the same scale."""

    columns: dict
    touches: Touches
    real: np.ndarray


def train(repetition: int, folder: Path, real: Touches, simulated: dict[str, Touches], counts: list[int],
            seed: int) -> Rows:  # fmt: skip
    """Rows of one split: a run of neighbouring real touches of each class is tested.

    real: in the order of recording; simulated: {simulation: its Touches}; counts: real touches of each class to train
    on, drawn from the rest. aligned: features scaled by the mean and deviation of their own kind: the simulated ones,
    and the real ones outside the test part, whatever their classes.
    """
    number = split_number(seed, repetition)
    pool, test = block_split(real.labels, number)
    rows = []
    with threadpool_limits(1):  # equal sums on any number of cores
        for count in counts:
            training_ids = _draw(real.labels, pool, count, number)
            for training in _trainings(real, simulated, training_ids, pool):
                common = {"split": Split.BLOCKS, "touches": count, "repetition": repetition}
                rows += [common | row for row in _test(training, real.labels, test, count, number)]
    return rows


def _trainings(
    real: Touches, simulated: dict[str, Touches], chosen: np.ndarray, pool: np.ndarray
) -> Iterator[Training]:
    labels = real.labels[chosen]
    if len(chosen):
        yield Training({"training": "real"}, Touches(real.samples[chosen], labels), real.samples)
    for kind, touches in simulated.items():
        for aligned in (False, True):
            samples, real_samples = touches.samples, real.samples
            if aligned:
                samples, real_samples = _scaled(samples, samples), _scaled(real_samples, real_samples[pool])
            columns = {"training": "both" if len(chosen) else "simulated", "simulation": kind, "aligned": aligned}
            mixture = Touches(np.concatenate([samples, real_samples[chosen]]), np.concatenate([touches.labels, labels]))
            yield Training(columns, mixture, real_samples)


def _test(training: Training, labels: np.ndarray, test: np.ndarray, count: int, number: int) -> Iterator[dict]:
    train, truth = training.touches, labels[test]
    for name in CLASSIFIERS:
        parts = min(COMPONENTS, len(train.samples))
        model = make_pipeline(StandardScaler(), PCA(parts, svd_solver="full"), CLASSIFIERS[name](number))
        with Stopwatch() as watch:
            answers = model.fit(train.samples, train.labels).predict(training.real[test])
        row = {**training.columns, "classifier": name, "metric": "accuracy", "seconds": watch.seconds}
        yield {**row, "group": "all", "value": float((answers == truth).mean())}
        if name == "knn" and count == 0:
            for label in dict.fromkeys(labels.tolist()):
                yield {**row, "group": label, "value": float((answers == label)[truth == label].mean())}


def _draw(labels: np.ndarray, pool: np.ndarray, count: int, number: int) -> np.ndarray:
    random = np.random.default_rng([number, count])
    classes = dict.fromkeys(labels.tolist())
    draws = [random.choice(pool[labels[pool] == label], count, replace=False) for label in classes]
    return np.concatenate(draws).astype(np.int64)


def _scaled(samples: np.ndarray, reference: np.ndarray) -> np.ndarray:
    spread = reference.std(axis=0)
    return (samples - reference.mean(axis=0)) / np.where(spread > 0, spread, 1)


PITCH = 1.9  # mm: Tekscan 6077, 27.6 sensels a square centimetre
LARGE_PITCH = 3.4  # mm, as if the objects were of 56 % of their size: most real ones are smaller than those simulated
DEPTHS = 0.5, 2.0  # mm that the object goes into the skin, drawn anew for each touch
ASIDE = 0.25  # of the array's sides, at most, from its middle to the middle of what the object stands on
TOUCHING = 1e-4  # of the object's size: vertices so near to the table stand on it
SKIN = Skin(blur=0.8, noise=0.02)
# Chosen after the first results of the others were seen, by what the real touches are like:
SOFT, GAINS, GRAIN = Skin(blur=0.6), (0.3, 1.0), 0.3  # how hard it is pressed; deviation of a cell from its neighbours


def simulate(
    kind: str, mesh: Mesh, count: int, cells: tuple[int, int], size: float, random: np.random.Generator
) -> np.ndarray:
    """(count, rows, cols) pressure in 0..1, 1 the highest, of an object whose longest side is `size` metres.

    kind: a name of SIMULATIONS; random: the draws of places, poses and depths.
    """
    millimetre = np.ptp(mesh.vertices, axis=0).max() / (1000 * size)
    return 1.0 - SIMULATIONS[kind](mesh, count, cells, millimetre, random)


def _array(mesh, count, cells, millimetre, random):
    """The thesis's array at vertices drawn by area, upright, its middle on the vertex, feeling as far as it is wide."""
    areas = corner_sum(mesh, np.repeat(mesh.face_areas[:, None], 3, axis=1))
    areas = areas * touchable(mesh, np.arange(len(areas)))
    vertices = random.choice(len(areas), count, p=areas / areas.sum())
    return press_many(mesh, vertices, cells, PITCH * millimetre)


def _resting(mesh, count, cells, millimetre, random, pitch=PITCH):
    """The object lies on the array as on a table, one of its stable poses by their probability, turned anyhow."""
    pitch, (normals, chances) = pitch * millimetre, _stable(mesh)
    poses = random.choice(len(normals), count, p=chances / chances.sum())
    places = np.array([_support(mesh, normal) for normal in normals[poses]])
    right, up, normal = sensor_axes(normals[poses]).transpose(1, 0, 2)
    angles = random.uniform(0, 2 * np.pi, (count, 1))
    cos, sin = np.cos(angles), np.sin(angles)
    axes = np.stack([cos * right + sin * up, cos * up - sin * right, normal], axis=1)
    shifts = (random.uniform(-ASIDE, ASIDE, (count, 2)) * (cells[1], cells[0]) * pitch)[:, :, None]
    distances = distances_at(Surface(mesh), places + np.sum(shifts * axes[:, :2], axis=1), axes, cells, pitch)
    depths = random.uniform(*DEPTHS, count) * millimetre
    return np.concatenate([indent(distances[k : k + 1], depth) for k, depth in enumerate(depths)])


def _stable(mesh):
    """(directions that look down (k, 3), their probabilities (k,)) of the stable poses on a table (Goldberg 1999)."""
    hull = trimesh.Trimesh(mesh.vertices, mesh.faces, process=False).convex_hull
    poses, chances = trimesh.poses.compute_stable_poses(hull, center_mass=hull.center_mass)
    return -poses[:, 2, :3], chances


def _support(mesh, down):
    """The middle of the vertices that an object stands on."""
    heights = mesh.vertices @ down
    return mesh.vertices[heights > heights.max() - TOUCHING].mean(axis=0)


def _skin(mesh, count, cells, millimetre, random):
    return SKIN(_resting(mesh, count, cells, millimetre, random))


def _grain(mesh, count, cells, millimetre, random):
    load = 1 - SOFT(_resting(mesh, count, cells, millimetre, random))
    load = load * random.uniform(*GAINS, (count, 1, 1)) * random.normal(1, GRAIN, load.shape)
    return 1 - np.clip(load, 0, 1)


def _smaller(mesh, count, cells, millimetre, random):
    return _resting(mesh, count, cells, millimetre, random, LARGE_PITCH)


SIMULATIONS = {
    "array": _array, "resting": _resting, "resting_skin": _skin, "resting_grain": _grain, "resting_small": _smaller,
}  # fmt: skip


def press(
    name: str, folder: Path, data: Path, counts: dict[str, int], cells: tuple[int, int], simulations: list[str],
    seed: int,
) -> Rows:  # fmt: skip
    """Presses one object in every way and writes the imprints: an array (counts[name], rows, cols) per simulation."""
    mesh = read_mesh(data / "meshes" / f"{name}.npz")
    size = read_table(data / "meshes/manifest.csv").set_index("object").loc[name, "size"]
    imprints = {
        kind: simulate(kind, mesh, counts[name], cells, size, rng(seed, f"{kind} {name}"))  # type: ignore[arg-type]
        for kind in simulations  # the size is a number
    }
    write_arrays(folder / f"{name}.npz", **imprints)
    return []


def shares(members: dict[str, list[str]], count: int) -> dict[str, int]:
    """{object: how many imprints of its class it gives}; members: {class: its objects}."""
    counts = {}
    for objects in members.values():
        parts = np.diff(np.linspace(0, count, len(objects) + 1).astype(int))
        counts |= dict(zip(objects, parts.tolist(), strict=True))
    return counts


def run(workspace: Workspace) -> None:
    """Runs the stage on the data set of a workspace."""
    settings = workspace.settings(Params)
    images = read_pressure_images(workspace.settings(RecordedParams).path(workspace.root))
    with StageRun(workspace, "simulated_to_real", COLUMNS, inputs=("meshes",)) as stage:
        members = read_classes(workspace.data / "meshes")
        absent_objects = sorted(set(members) - set(images))
        if absent_objects:
            raise ValueError(f"meshes.classes: {absent_objects[0]} is not a class of the pressure images")
        cells, counts = images[next(iter(members))].shape[1:], shares(members, settings.simulated)
        simulating = functools.partial(
            press, data=workspace.data, counts=counts, cells=cells, simulations=settings.simulations, seed=stage.seed
        )
        stage.each(simulating, list(counts), reads=("meshes/{}.npz", "meshes/manifest.csv"))
        with threadpool_limits(1):  # equal sums on any number of cores
            real = described({name: images[name] for name in members})
            simulated = {
                kind: described({name: gather(stage.folder, objects, kind) for name, objects in members.items()})
                for kind in settings.simulations
            }
        training = functools.partial(train, real=real, simulated=simulated, counts=settings.real, seed=stage.seed)
        stage.each(training, {str(k): k for k in range(settings.repetitions)})
        stage.metrics(summary(stage.rows))
    print(f"simulated_to_real: {len(members)} classes, {settings.repetitions} splits")


def gather(folder: Path, objects: list[str], kind: str) -> np.ndarray:
    """(k, rows, cols): the simulated imprints of the objects of one class."""
    return np.concatenate([read_arrays(folder / f"{name}.npz")[kind] for name in objects])


def described(images: dict[str, np.ndarray]) -> Touches:
    """The Touches of {class: (k, rows, cols)}."""
    samples = np.concatenate([features(touches) for touches in images.values()])
    return Touches(samples, np.repeat(list(images), [len(touches) for touches in images.values()]))


def summary(rows: Rows) -> dict[str, float]:
    """{training.simulation: the mean accuracy of kNN over all numbers of real touches and splits}."""
    selected = (row for row in rows if row["classifier"] == "knn" and row["group"] == "all")
    return named_means((".".join([row["training"], row.get("simulation", "none")]), row["value"]) for row in selected)


if __name__ == "__main__":
    run(workspace_of_arguments(__doc__, "simulated_to_real"))

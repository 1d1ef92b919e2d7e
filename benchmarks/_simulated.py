"""How far simulated imprints help to recognise real touches: of the classes that both have."""

from pathlib import Path

import numpy as np
import trimesh
from sklearn.decomposition import PCA
from sklearn.pipeline import make_pipeline
from sklearn.preprocessing import StandardScaler

from benchmarks._recorded import blocked
from stages.classification import CLASSIFIERS, features
from stages.classification.classifiers import COMPONENTS
from stages.imprints import Skin, Surface, distances_at, indent, press_many, sensor_axes, touchable
from stages.kit import Stopwatch
from stages.kit.files import read_mesh, read_table
from stages.kit.mesh import corner_sum
from stages.kit.rng import rng

COUNTERPARTS = {  # real class -> simulated objects: chosen by name and shape, before any result was seen
    "ball": ["spheresmall", "spheremedium", "spherelarge"], "bottle": ["waterbottle"],
    "box": ["cubemedium", "cubelarge"], "can": ["cylindermedium", "cylinderlarge"], "hand": ["hand"],
    "pen": ["toothbrush"], "rubber": ["cubesmall"], "scissors": ["scissors"],
    "sticky_tape": ["torussmall", "torusmedium"], "tube": ["flute"],
}  # fmt: skip
PITCH = 1.9  # mm: Tekscan 6077, 27.6 sensels a square centimetre
LARGE_PITCH = 3.4  # mm, as if the objects had 56 % of their size: most real ones are smaller than those simulated
DEPTHS = 0.5, 2.0  # mm that the object goes into the skin, drawn anew for each touch
ASIDE = 0.25  # of the array's sides, at most, from its middle to the middle of what the object stands on
TOUCHING = 1e-4  # of the object's size: vertices so near to the table stand on it
SKIN = Skin(blur=0.8, noise=0.02)
# Set once, by the look of the real touches, after the first results of the others were known:
SOFT, GAINS, GRAIN = Skin(blur=0.6), (0.3, 1.0), 0.3  # how hard it is pressed; deviation of a cell from its neighbours
TOUCHES = 48  # simulated, a class, shared by its objects
REAL = (0, 1, 2, 5, 10, 20)  # touches of each class that are trained on
REPETITIONS = 20


def transfer_rows(images, meshes, seed=0):
    """Rows training (simulated, real, both), simulation, aligned, touches (real, a class), classifier, value.

    images: {class: (k, rows, cols)} real touches; meshes: folder of normalised meshes with manifest.csv. The test part
    is a run of neighbouring numbers a class; the real touches to train on are drawn from the rest. aligned: features
    scaled by the mean and deviation of their own kind: the simulated ones, and the real ones outside the test part,
    whose classes are not looked at.
    """
    real = np.concatenate([features(images[name]) for name in COUNTERPARTS])
    labels = np.repeat(list(COUNTERPARTS), [len(images[name]) for name in COUNTERPARTS])
    cells = images["ball"].shape[1:]
    simulated = {kind: _described(kind, meshes, cells, seed) for kind in SIMULATIONS}
    for repetition in range(REPETITIONS):
        number = int(rng(seed, f"repetition {repetition}").integers(2**31))
        pool, test = blocked(labels, number)
        for touches in REAL:
            train = _draw(labels, pool, touches, number)
            for said, samples, answers in _trainings(real, labels, simulated, train, pool):
                yield from _asked(
                    said | {"touches": touches, "repetition": repetition}, samples, answers, (test, labels), number
                )


def _trainings(real, labels, simulated, train, pool):
    """(what it is, (samples to train on, all real samples on the same scale), their labels) of each way to train."""
    if len(train):
        yield {"training": "real"}, (real[train], real), labels[train]
    for kind, (samples, classes) in simulated.items():
        for aligned in (False, True):
            own, there = (_scaled(samples, samples), _scaled(real, real[pool])) if aligned else (samples, real)
            said = {"training": "both" if len(train) else "simulated", "simulation": kind, "aligned": aligned}
            yield said, (np.concatenate([own, there[train]]), there), np.concatenate([classes, labels[train]])


def _asked(said, samples, classes, test, number):
    (train, real), (held, labels) = samples, test
    for name in CLASSIFIERS:
        parts = min(COMPONENTS, len(train))
        model = make_pipeline(StandardScaler(), PCA(parts, svd_solver="full"), CLASSIFIERS[name](number))
        with Stopwatch() as watch:
            answers = model.fit(train, classes).predict(real[held])
        row = {**said, "classifier": name, "metric": "accuracy", "seconds": watch.seconds}
        yield {**row, "object": "all", "value": (answers == labels[held]).mean()}
        if name == "knn" and said["touches"] == 0:
            for one in COUNTERPARTS:
                yield {**row, "object": one, "value": (answers == one)[labels[held] == one].mean()}


def _draw(labels, pool, touches, number):
    random = np.random.default_rng([number, touches])
    drawn = [random.choice(pool[labels[pool] == one], touches, replace=False) for one in COUNTERPARTS]
    return np.concatenate(drawn).astype(np.int64)


def _scaled(samples, reference):
    spread = reference.std(axis=0)
    return (samples - reference.mean(axis=0)) / np.where(spread > 0, spread, 1)


def _described(kind, meshes, cells, seed):
    images = simulate(kind, meshes, cells, seed)
    return np.concatenate([features(touches) for touches in images.values()]), np.repeat(list(images), TOUCHES)


def simulate(kind, meshes, cells, seed=0):
    """{class: (TOUCHES, rows, cols) pressure in 0..1, 1 the highest} of the counterparts, of a kind in SIMULATIONS."""
    table, found = read_table(Path(meshes) / "manifest.csv").set_index("object"), {}
    for one, objects in COUNTERPARTS.items():
        found[one] = []
        for name, count in zip(objects, np.diff(np.linspace(0, TOUCHES, len(objects) + 1).astype(int)), strict=True):
            mesh = read_mesh(Path(meshes) / f"{name}.npz")
            millimetre = np.ptp(mesh.vertices, axis=0).max() / (1000 * table.loc[name, "size"])
            found[one].append(1.0 - SIMULATIONS[kind](mesh, count, cells, millimetre, rng(seed, f"{kind} {name}")))
    return {one: np.concatenate(parts) for one, parts in found.items()}


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
    aside = (random.uniform(-ASIDE, ASIDE, (count, 2)) * (cells[1], cells[0]) * pitch)[:, :, None]
    found = distances_at(Surface(mesh), places + np.sum(aside * axes[:, :2], axis=1), axes, cells, pitch)
    depths = random.uniform(*DEPTHS, count) * millimetre
    return np.concatenate([indent(found[k : k + 1], depth) for k, depth in enumerate(depths)])


def _stable(mesh):
    """(directions that look down (k, 3), their probabilities (k,)) of the stable poses on a table (Goldberg 1999)."""
    hull = trimesh.Trimesh(mesh.vertices, mesh.faces, process=False).convex_hull
    turned, chances = trimesh.poses.compute_stable_poses(hull, center_mass=hull.center_mass)
    return -turned[:, 2, :3], chances


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

"""Trains on simulated imprints, on real touches and on both, and tests on real touches of the same classes.

Reads the archive of pressure images that recorded.folder names, and data/SET/meshes: for some of its classes, objects
of like name and shape. Writes data/SET/simulated_to_real/NAME.npz (the simulated imprints of an object) and
reports/measurements/SET/simulated_to_real.csv.gz.
"""

import functools
from pathlib import Path

import numpy as np
from threadpoolctl import threadpool_limits

from haptic_glance.base.files import read_arrays, read_mesh, read_table, write_arrays
from haptic_glance.base.rng import rng
from haptic_glance.know import features
from stages.classification.recorded import read_pressure_images
from stages.engine.rows import named_means
from stages.engine.run import Rows, StageRun
from stages.engine.settings import Workspace, workspace_of_arguments
from stages.meshes.collect import read_classes
from stages.recorded import Params as RecordedParams

from . import COLUMNS, Params, trial
from .trial import simulate


def process(name: str, folder: Path, data: Path, counts: dict[str, int], cells: tuple[int, int], simulations: list[str],
            seed: int) -> Rows:  # fmt: skip
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
        press = functools.partial(
            process, data=workspace.data, counts=counts, cells=cells, simulations=settings.simulations, seed=stage.seed
        )
        stage.each(press, list(counts), reads=("meshes/{}.npz", "meshes/manifest.csv"))
        with threadpool_limits(1):  # equal sums on any number of cores
            real = described({name: images[name] for name in members})
            simulated = {
                kind: described({name: gather(stage.folder, objects, kind) for name, objects in members.items()})
                for kind in settings.simulations
            }
        train = functools.partial(trial.process, real=real, simulated=simulated, counts=settings.real, seed=stage.seed)
        stage.each(train, {str(k): k for k in range(settings.repetitions)})
        stage.metrics(summary(stage.rows))
    print(f"simulated_to_real: {len(members)} classes, {settings.repetitions} splits")


def gather(folder: Path, objects: list[str], kind: str) -> np.ndarray:
    """(k, rows, cols): the simulated imprints of the objects of one class."""
    return np.concatenate([read_arrays(folder / f"{name}.npz")[kind] for name in objects])


def described(images: dict[str, np.ndarray]) -> trial.Touches:
    """The Touches of {class: (k, rows, cols)}."""
    samples = np.concatenate([features(touches) for touches in images.values()])
    return trial.Touches(samples, np.repeat(list(images), [len(touches) for touches in images.values()]))


def summary(rows: Rows) -> dict[str, float]:
    """{training.simulation: the mean accuracy of kNN over all numbers of real touches and splits}."""
    selected = (row for row in rows if row["classifier"] == "knn" and row["group"] == "all")
    return named_means((".".join([row["training"], row.get("simulation", "none")]), row["value"]) for row in selected)


if __name__ == "__main__":
    run(workspace_of_arguments(__doc__, "simulated_to_real"))

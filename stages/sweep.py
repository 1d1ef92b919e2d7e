"""Sweeps recognition by touch over channels, classifiers, sensors or any setting, by Hydra multirun.

`python -m stages.sweep -m channels=itti,all classifier=knn,svm`
`python -m stages.sweep -m sensor=fsr_16,fsr_32 classifier=knn hydra/launcher=joblib`

Every job finds the points, presses the array and recognises the objects of classification.sets, on the meshes and
conspicuity maps that `dvc repro` left in data/SET; SET is household, or `data=SET`. Rows are appended to
reports/sweeps/recognition.csv (a repeated job replaces its rows), and a table of the jobs ends the sweep.
"""

import sys
from pathlib import Path
from typing import Any

import hydra
import numpy as np
import pandas as pd
from filelock import FileLock
from hydra.core.hydra_config import HydraConfig
from hydra.experimental.callback import Callback
from omegaconf import DictConfig, OmegaConf

from stages.classification import evaluate
from stages.conspicuity import read_view_maps
from stages.imprints import press_many, touchable
from stages.kit import Stopwatch
from stages.kit.conf import conf_folder
from stages.kit.files import read_mesh, read_table, write_table
from stages.kit.packs import is_there
from stages.kit.params import ParamsError, check_section, schema_of
from stages.kit.split import Split
from stages.kit.stats import interval
from stages.salient_points.methods import find_all, method_named, split_runnable
from stages.salient_points.options import Options
from stages.weights import read_learned_weights

OUT = Path("reports/sweeps/recognition.csv")
ROWS = "rows.csv"  # what each job leaves in its own folder
KEYS = ["job", "dataset", "group", "method", "classifier", "seed"]  # rows that agree in these are the same measurement


def recognise(config: dict[str, Any], data: Path) -> list[dict[str, Any]]:
    """Rows of one job: every set, method and classifier of a composed configuration. data: data/SET."""
    sections = ("salient_points", "imprints", "classification")
    chosen = {name: check_section(schema_of(name), config[name]) for name in sections}
    rows = []
    touched = {}
    for objects in chosen["classification"].sets.values():
        for name in objects:
            if name not in touched:
                touched[name] = _touch(name, config, chosen, data)
    for set_name, objects in chosen["classification"].sets.items():
        for method in chosen["imprints"].methods:
            images = {name: touched[name][method] for name in objects}
            for classifier in chosen["classification"].classifiers:
                found = evaluate(images, classifier, chosen["classification"].repetitions, config["seed"])
                rows += [{"group": set_name, "method": method, **row, "seed": config["seed"]} for row in found]
    return rows


def _touch(name: str, config: dict[str, Any], chosen: dict[str, Any], data: Path) -> dict[str, np.ndarray]:
    """{method: imprints (k, rows, columns)} of one object."""
    settings = chosen["salient_points"]
    for folder, file in (("meshes", f"{name}.npz"), ("conspicuity", f"{name}.npz"), ("weights", "weights.csv")):
        if not is_there(data / folder / file):
            sys.exit(f"sweep: {data / folder / file} is not there: run `dvc repro {folder}@{data.name}` first")
    mesh = read_mesh(data / "meshes" / f"{name}.npz")
    looking = any(method_named(method).channels for method in settings.methods)
    sight = read_view_maps(data / "conspicuity" / f"{name}.npz", mesh) if looking else None
    learned = read_learned_weights(data / "weights", name, mesh)
    methods, _ = split_runnable(settings.methods, learned)
    options = Options(learned, settings.selection, settings.radius, settings.smoothing, config["seed"], name)
    found, _ = find_all(mesh, sight, methods, options, settings.count)
    sensor = chosen["imprints"]
    return {
        method: press_many(
            mesh, result.points[touchable(mesh, result.points)], sensor.cells, sensor.pitch, contact=sensor.contact
        )
        for method, result in found.items()
        if method in sensor.methods
    }


@hydra.main(version_base=None, config_path=str(conf_folder()), config_name="config")
def job(config: DictConfig) -> None:
    """One job of the sweep."""
    values: dict[str, Any] = OmegaConf.to_container(config, resolve=True)  # type: ignore[assignment]  # a dict
    dataset = HydraConfig.get().runtime.choices["data"]
    name = " ".join(sorted(HydraConfig.get().overrides.task)) or "defaults"
    try:
        with Stopwatch() as watch:
            rows = recognise(values, Path("data") / dataset)
    except (ParamsError, ValueError) as error:
        sys.exit(f"sweep: {name}: {error}")
    frame = pd.DataFrame(rows)
    frame.insert(0, "job", name)
    frame.insert(1, "dataset", dataset)
    frame["job_seconds"] = watch.seconds
    write_table(Path(HydraConfig.get().runtime.output_dir) / ROWS, frame)


class Gather(Callback):
    """Collects what the jobs left, when the last one has ended."""

    def on_run_end(self, config: DictConfig, **_: Any) -> None:
        gather(Path(config.hydra.runtime.output_dir))

    def on_multirun_end(self, config: DictConfig, **_: Any) -> None:
        gather(Path(config.hydra.sweep.dir))


def gather(folder: Path, out: Path = OUT) -> None:
    """Appends the jobs' rows to `out` and prints one line per job."""
    parts = [read_table(path) for path in sorted(folder.rglob(ROWS))]
    if not parts:
        return
    new = pd.concat(parts, ignore_index=True)
    out.parent.mkdir(parents=True, exist_ok=True)
    with FileLock(out.with_suffix(".lock")):  # two sweeps may end at once
        old = read_table(out) if out.exists() else new.iloc[:0]
        repeated = old.set_index(KEYS).index.isin(new.set_index(KEYS).index)
        write_table(out, pd.concat([old.loc[~repeated], new], ignore_index=True))
    print(table(new).to_string(index=False))
    print(f"sweep: {len(parts)} jobs, {len(new)} rows appended to {out}")


def table(frame: pd.DataFrame) -> pd.DataFrame:
    """One line per job, set, method and classifier: mean hold-out accuracy with its 95 % interval, and its cost."""
    kept = frame[(frame.metric == "accuracy") & (frame.split == Split.RANDOM)]
    lines = []
    for key, group in kept.groupby(["job", "group", "method", "classifier"], sort=False):
        mean, low, high = interval(group.value)
        cells = dict(zip(("job", "set", "method", "classifier"), list(key), strict=True))  # type: ignore[arg-type]
        lines.append(
            cells | {"accuracy": f"{mean:.3f} [{low:.3f}, {high:.3f}]", "fit ms": f"{1e3 * group.seconds.mean():.1f}"}
        )
    return pd.DataFrame(lines)


if __name__ == "__main__":
    job()

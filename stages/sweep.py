"""Sweeps recognition by touch over channels, classifiers, sensors or any setting, by Hydra multirun.

`python -m stages.sweep -m channels=itti,all classifier=knn,svm`
`python -m stages.sweep -m sensor=fsr_16,fsr_32 classifier=knn hydra/launcher=joblib`

Every job finds the points, presses the array and tells the objects of classification.sets apart, on the meshes and
conspicuity maps that `dvc repro` left in data/. Rows are appended to reports/sweeps/recognition.csv (a repeated job
replaces its rows) and a table of the jobs ends the sweep.
"""

import sys
from pathlib import Path

import hydra
import pandas as pd
from filelock import FileLock
from hydra.core.hydra_config import HydraConfig
from hydra.experimental.callback import Callback
from omegaconf import OmegaConf

from stages.classification import evaluate
from stages.conspicuity import read_sight
from stages.imprints import press_many, touchable
from stages.kit import Stopwatch
from stages.kit.files import read_mesh, read_table, write_table
from stages.kit.params import ParamsError, check, check_section
from stages.kit.run import DATA
from stages.kit.stats import bootstrap_interval
from stages.salient_points.methods import find_all, method_named, teachable
from stages.salient_points.options import Options
from stages.weights import learned_for

OUT = Path("reports/sweeps/recognition.csv")
ROWS = "rows.csv"  # what each job leaves in its own folder
KEYS = ["job", "dataset", "object", "method", "classifier", "seed"]  # rows that agree in these are the same measurement


def recognise(config):
    """Rows of one job: every set, method and classifier of a composed configuration (plain dicts)."""
    check(config)
    chosen = {name: check_section(name, config[name]) for name in ("salient_points", "imprints", "classification")}
    rows = []
    touched = {}
    for objects in chosen["classification"].sets.values():
        for name in objects:
            if name not in touched:
                touched[name] = _touch(name, config, chosen)
    for set_name, objects in chosen["classification"].sets.items():
        for method in chosen["imprints"].methods:
            images = {name: touched[name][method] for name in objects}
            for classifier in chosen["classification"].classifiers:
                found = evaluate(images, classifier, chosen["classification"].repetitions, config["seed"])
                rows += [{"object": set_name, "method": method, **row, "seed": config["seed"]} for row in found]
    return rows


def _touch(name, config, chosen):
    """{method: imprints (k, rows, columns)} of one object."""
    settings = chosen["salient_points"]
    for folder, file in (("meshes", f"{name}.npz"), ("conspicuity", f"{name}.npz"), ("weights", "weights.csv")):
        if not (DATA / folder / file).exists():
            sys.exit(f"sweep: no data/{folder}/{file}: run `dvc repro {folder}` first")
    mesh = read_mesh(DATA / "meshes" / f"{name}.npz")
    looking = any(method_named(method).channels for method in settings.methods)
    sight = read_sight(DATA / "conspicuity" / f"{name}.npz", mesh) if looking else None
    learned = learned_for(DATA / "weights", name, mesh)
    methods, _ = teachable(settings.methods, learned)
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


@hydra.main(version_base=None, config_path="../conf", config_name="config")
def job(config):
    """One job of the sweep."""
    values = OmegaConf.to_container(config, resolve=True)
    name = " ".join(sorted(HydraConfig.get().overrides.task)) or "defaults"
    try:
        with Stopwatch() as watch:
            rows = recognise(values)
    except (ParamsError, ValueError) as error:
        sys.exit(f"sweep: {name}: {error}")
    frame = pd.DataFrame(rows)
    frame.insert(0, "job", name)
    frame.insert(1, "dataset", values["meshes"]["source"])
    frame["job_seconds"] = watch.seconds
    write_table(Path(HydraConfig.get().runtime.output_dir) / ROWS, frame)


class Gather(Callback):
    """Collects what the jobs left, when the last one has ended."""

    def on_run_end(self, config, **_):
        gather(Path(config.hydra.runtime.output_dir))

    def on_multirun_end(self, config, **_):
        gather(Path(config.hydra.sweep.dir))


def gather(folder):
    """Appends the jobs' rows to OUT and prints one line a job."""
    parts = [read_table(path) for path in sorted(folder.rglob(ROWS))]
    if not parts:
        return
    new = pd.concat(parts, ignore_index=True)
    OUT.parent.mkdir(parents=True, exist_ok=True)
    with FileLock("build/sweeps.lock"):  # two sweeps may end at once
        old = read_table(OUT) if OUT.exists() else new.iloc[:0]
        repeated = pd.MultiIndex.from_frame(old[KEYS]).isin(pd.MultiIndex.from_frame(new[KEYS]))
        write_table(OUT, pd.concat([old[~repeated], new], ignore_index=True))
    print(table(new).to_string(index=False))
    print(f"sweep: {len(parts)} jobs, {len(new)} rows appended to {OUT}")


def table(frame):
    """One line a job, set, method and classifier: mean hold-out accuracy with its 95 % interval, and its cost."""
    kept = frame[frame.metric == "accuracy_holdout"]
    lines = []
    for key, group in kept.groupby(["job", "object", "method", "classifier"], sort=False):
        mean, low, high = bootstrap_interval(group.value)
        cells = dict(zip(("job", "set", "method", "classifier"), key, strict=True))
        lines.append(
            cells | {"accuracy": f"{mean:.3f} [{low:.3f}, {high:.3f}]", "fit ms": f"{1e3 * group.seconds.mean():.1f}"}
        )
    return pd.DataFrame(lines)


if __name__ == "__main__":
    job()

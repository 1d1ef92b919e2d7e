"""Sweeps recognition by touch over channels, classifiers, sensors or any setting, by Hydra multirun.

examples:
  python -m stages.sweep -m channels=itti,all classifier=knn,svm
  python -m stages.sweep -m sensor=fsr_16,fsr_32 classifier=knn hydra/launcher=joblib
  python -m stages.sweep -m data=folder '+classification.sets.mine=[cup,spoon]' classifier=knn,svm

Every job finds the points, presses the array and recognises the objects of classification.sets, on the meshes and
conspicuity maps of data/SET; SET is household, or `data=SET`. Where these are not there, or their inputs have changed,
`dvc repro` makes them first.
A group of classification.sets with objects that SET does not have is left out. Settings are those of params.yaml,
where it has the set, but for what the command line says. The rows of a job are appended to
runs/sweeps/recognition.csv when it ends (a repeated job replaces its rows), so that a sweep that is stopped loses the
job in work alone. A job that fails is named, and the others go on. A table of the jobs ends the sweep.
"""

import json
import re
import signal
import subprocess
import sys
from collections.abc import Iterator, Mapping, Sequence
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import hydra
import numpy as np
import pandas as pd
from filelock import FileLock
from hydra.core.hydra_config import HydraConfig
from hydra.experimental.callback import Callback
from omegaconf import DictConfig, OmegaConf

from haptic_glance.base.errors import errors_in_one_line
from haptic_glance.base.files import read_json, read_mesh, read_table, write_json, write_table, write_text
from haptic_glance.base.timing import Stopwatch
from haptic_glance.know import evaluate
from haptic_glance.know.split import Split, shared_by
from haptic_glance.lod.task import number
from haptic_glance.look.points.methods import find_all, method_named, split_runnable
from haptic_glance.look.points.options import Options
from haptic_glance.look.weights import read_learned_weights
from haptic_glance.touch import press_many, touchable
from stages.charts.tables import with_interval, within
from stages.compose import composed, quoted
from stages.conspicuity.measure import read_view_maps
from stages.engine.settings import FILE, ParamsError, check_clone, check_section, conf_folder, load_params
from stages.pipeline import schema_of

OUT = Path("runs/sweeps/recognition.csv")
BASES = Path("build/sweeps/bases.json")  # {set: its settings in params.yaml, and those of conf/}, for all jobs
BEFORE = Path("build/sweeps/params.yaml")  # params.yaml as it was, while a sweep makes what its jobs read
SECTIONS = ("salient_points", "imprints", "classification")
NEEDED = "meshes", "conspicuity", "weights"  # stages whose results the jobs read
ROWS, FAILURE = "rows.csv", "failure.txt"  # a job leaves one of them in its own folder
KEYS = ["job", "dataset", "group", "method", "classifier", "seed"]  # rows that agree in these are the same measurement


def recognise(config: dict[str, Any], data: Path) -> list[dict[str, Any]]:
    """Rows of one job: every set, method and classifier of a composed configuration. data: data/SET."""
    sections = {name: check_section(schema_of(name), config[name]) for name in SECTIONS}
    rows = []
    touched = {}
    sets = sets_there(sections["classification"].sets, data)
    for objects in sets.values():
        for name in objects:
            if name not in touched:
                touched[name] = _touch(name, config, sections, data)
    for set_name, objects in sets.items():
        for method in sections["imprints"].methods:
            images = {name: touched[name][method] for name in objects}
            for classifier in sections["classification"].classifiers:
                scores = evaluate(images, classifier, sections["classification"].repetitions, config["seed"])
                rows += [{"group": set_name, "method": method, **row, "seed": config["seed"]} for row in scores]
    return rows


def sets_there(sets: Mapping[str, Sequence[str]], data: Path) -> dict[str, Sequence[str]]:
    """The sets of objects that all lie in data; ParamsError with the names that lie there, where there is no such set.

    All sets where data has no mesh at all: its stages have not run.
    """
    present = sorted(path.stem for path in (data / "meshes").glob("*.npz"))
    if not present:
        return dict(sets)
    missing_by_set = {name: [item for item in objects if item not in present] for name, objects in sets.items()}
    whole = {name: objects for name, objects in sets.items() if not missing_by_set[name]}
    left_out = "; ".join(f"{name} ({', '.join(missing)})" for name, missing in missing_by_set.items() if missing)
    if not whole:
        raise ParamsError(
            f"{data.name} does not have all objects of any set of classification.sets: {left_out}; "
            f"name some of these in +classification.sets.NAME=[...]: {', '.join(present)}"
        )
    if left_out:
        print(f"sweep: sets with objects that {data.name} does not have are left out: {left_out}", file=sys.stderr)
    return whole


def _touch(name: str, config: dict[str, Any], sections: dict[str, Any], data: Path) -> dict[str, np.ndarray]:
    """{method: imprints (k, rows, columns)} of one object."""
    settings = sections["salient_points"]
    for folder, file in (("meshes", f"{name}.npz"), ("conspicuity", f"{name}.npz"), ("weights", "weights.csv")):
        if not (data / folder / file).exists():
            raise ParamsError(f"{data / folder / file} is not there: run `dvc repro {folder}@{data.name}` first")
    mesh = read_mesh(data / "meshes" / f"{name}.npz")
    looking = any(method_named(method).channels for method in settings.methods)
    sight = read_view_maps(data / "conspicuity" / f"{name}.npz", mesh) if looking else None
    learned = read_learned_weights(data / "weights", name, mesh)
    methods, _ = split_runnable(settings.methods, learned)
    options = Options(learned, settings.selection, settings.radius, settings.smoothing, config["seed"], name)
    detections, _ = find_all(mesh, sight, methods, options, settings.count)
    sensor = sections["imprints"]
    return {
        method: press_many(
            mesh, result.points[touchable(mesh, result.points)], sensor.cells, sensor.pitch, contact=sensor.contact
        )
        for method, result in detections.items()
        if method in sensor.methods
    }


def based(values: dict[str, Any], dataset: str) -> dict[str, Any]:
    """The settings of a job: those of params.yaml, but where the command line differs from what conf/ has."""
    bases = read_json(BASES).get(dataset) if BASES.exists() else None
    if bases is None:
        return values
    return values | {
        name: _laid_over(bases["params"][name], bases["conf"][name], values[name]) for name in bases["conf"]
    }


def _laid_over(base: Any, default: Any, chosen: Any) -> Any:
    """`chosen` where it differs from the default, else the base; dicts key by key, also those of one side alone."""
    if not (isinstance(base, dict) and isinstance(default, dict) and isinstance(chosen, dict)):
        return base if chosen == default else chosen
    added = {key: value for key, value in base.items() if key not in default}
    new = {key: value for key, value in chosen.items() if key not in base and value != default.get(key)}
    both = {key: _laid_over(base[key], default.get(key), chosen[key]) for key in base if key in chosen}
    return added | new | both


def prepare(argv: Sequence[str]) -> None:
    """Checks the overrides of a command line, keeps the settings of params.yaml, and makes what the jobs will read.

    Raises ParamsError that names the nearest right name, and for a set that params.yaml does not switch on.
    """
    options = dict(word.split("=", 1) for word in argv if is_override(word) and not word.startswith("hydra"))
    unused = composed([]).keys() - {*SECTIONS, "profile", "seed"}
    for key, values in options.items():
        if key.lstrip("+~").partition(".")[0] in unused:
            raise ParamsError(f"{key} does not change a sweep: its jobs read {', '.join(SECTIONS)} and seed")
        for value in split_values(values):
            values_of = composed([quoted(f"{key}={value}")])
            for section in SECTIONS:
                check_section(schema_of(section), values_of[section])
    params, bases = load_params(), {}
    for dataset in split_values(options.get("data", "household")):
        if dataset in params.get("sets", []):
            conf = composed([f"data={dataset}"])
            sections = [name for name in SECTIONS if name in params[dataset]]  # a folder is not classified
            bases[dataset] = {
                "params": params[dataset] | {"seed": params["seed"]},
                "conf": {name: conf[name] for name in (*sections, "seed")},
            }
        needed = [f"{stage}@{dataset}" for stage in NEEDED]
        present = all(any(Path("data", dataset, stage).glob("*")) for stage in NEEDED)
        if not present or (dataset in bases and inputs_changed(needed)):
            if dataset not in params.get("sets", []):
                raise ParamsError(
                    f"{dataset} is not switched on: `python -m stages.compose 'sets=[{dataset}]'` does so, "
                    "and data=SET sweeps another set"
                )
            print(f"sweep: {', '.join(needed)} first: `dvc repro` makes them", file=sys.stderr, flush=True)
            with results_in(OUT.parent):
                exit_status = subprocess.run([sys.executable, "-m", "dvc", "repro", *needed]).returncode
            if exit_status:
                raise ParamsError(f"dvc repro {' '.join(needed)} failed, as said above")
    write_json(BASES, bases)


def inputs_changed(stages: Sequence[str]) -> bool:
    """Whether stages, or those before them, last ran on other files or settings; False where DVC cannot tell."""
    command = [sys.executable, "-m", "dvc", "status", "--json", "--with-deps", *stages]
    completed = subprocess.run(command, capture_output=True, text=True)
    changes = json.loads(completed.stdout).values() if completed.returncode == 0 else ()
    return any("changed deps" in change for stage_changes in changes for change in stage_changes)


@contextmanager
def results_in(folder: Path) -> Iterator[None]:
    """Inside, params.yaml sends the rows of stages to a folder, and not to the published results.

    Settings that a killed sweep has left there are put back first.
    """
    out_line = f"out: {folder.as_posix()}"
    text = FILE.read_text()
    if BEFORE.exists() and out_line in text.splitlines():
        text = BEFORE.read_text()
    write_text(BEFORE, text)
    write_text(FILE, re.sub(r"^out: .*$", out_line, text, flags=re.MULTILINE))
    try:
        yield
    finally:
        write_text(FILE, text)
        BEFORE.unlink()


def is_override(word: str) -> bool:
    """Whether a word of the command line sets something, and is no option."""
    return "=" in word and not word.startswith("-")


def split_values(text: str) -> list[str]:
    """The values of a sweep `a,b`; a comma inside brackets splits nothing."""
    return re.split(r",(?![^\[{]*[\]}])", text)


@hydra.main(version_base=None, config_path=str(conf_folder()), config_name="config")
def job(config: DictConfig) -> None:
    """One job of the sweep."""
    values: dict[str, Any] = OmegaConf.to_container(config, resolve=True)  # type: ignore[assignment]  # a dict
    dataset = HydraConfig.get().runtime.choices["data"]
    name = " ".join(sorted(HydraConfig.get().overrides.task)) or "defaults"
    folder = Path(HydraConfig.get().runtime.output_dir)
    try:
        with Stopwatch() as watch:
            rows = recognise(based(values, dataset), Path("data") / dataset)
    except (ParamsError, ValueError) as error:
        print(f"sweep: {name}: {error}", file=sys.stderr, flush=True)
        write_text(folder / FAILURE, name)
        return
    frame = pd.DataFrame(rows)
    frame.insert(0, "job", name)
    frame.insert(1, "dataset", dataset)
    frame["job_seconds"] = watch.seconds
    write_table(folder / ROWS, frame)


class Gather(Callback):
    """Collects the rows of each job when it has ended, and prints a table of all when the last one has."""

    def on_job_end(self, config: DictConfig, **_: Any) -> None:
        gather(Path(config.hydra.runtime.output_dir))

    def on_run_end(self, config: DictConfig, **_: Any) -> None:
        conclude(Path(config.hydra.runtime.output_dir))

    def on_multirun_end(self, config: DictConfig, **_: Any) -> None:
        conclude(Path(config.hydra.sweep.dir))


def gather(folder: Path, out: Path = OUT) -> None:
    """Appends the rows of the job that worked in a folder to `out`."""
    if not (folder / ROWS).exists():
        return
    new = read_table(folder / ROWS)
    out.parent.mkdir(parents=True, exist_ok=True)
    with FileLock(out.with_suffix(".lock")):  # two sweeps may end at once
        old = read_table(out) if out.exists() else new.iloc[:0]
        repeated = old.set_index(KEYS).index.isin(new.set_index(KEYS).index)
        write_table(out, pd.concat([old.loc[~repeated], new], ignore_index=True))
    print(f"sweep: {new['job'].iloc[0]}: {number(len(new), 'row')} appended to {out}", flush=True)


def conclude(folder: Path) -> None:
    """Prints one line for each job below a folder; ends the process with an error where a job has failed."""
    parts = [read_table(path) for path in sorted(folder.rglob(ROWS))]
    if parts:
        print(table(pd.concat(parts, ignore_index=True)).to_string(index=False))
    texts = [path.read_text().strip() for path in sorted(folder.rglob(FAILURE))]
    if texts:
        sys.exit(f"sweep: {len(texts)} of {number(len(parts) + len(texts), 'job')} failed: {'; '.join(texts)}")


def table(frame: pd.DataFrame) -> pd.DataFrame:
    """One line per job, set, method and classifier: mean hold-out accuracy with its 95 % interval, and its cost."""
    rows = frame[(frame.metric == "accuracy") & (frame.split == Split.RANDOM)]
    lines = []
    for key, group in rows.groupby(["job", "group", "method", "classifier"], sort=False):
        accuracy = with_interval(*within(group.value, shared_by(Split.RANDOM)), places=3)
        cells = dict(zip(("job", "set", "method", "classifier"), list(key), strict=True))  # type: ignore[arg-type]
        lines.append(cells | {"accuracy": accuracy, "fit ms": f"{1e3 * group.seconds.mean():.1f}"})
    return pd.DataFrame(lines)


def main() -> None:
    """Checks and prepares, then runs the jobs."""
    errors_in_one_line("sweep")
    if {"-h", "--help"} & set(sys.argv):
        print(__doc__)  # before Hydra's own help, which lists every group and setting
    else:
        check_clone()
        for name in ("SIGTERM", "SIGHUP"):  # as Ctrl-C, so that params.yaml is put back
            if hasattr(signal, name):
                signal.signal(getattr(signal, name), lambda number, _: sys.exit(128 + number))
        prepare(sys.argv[1:])
        sys.argv[1:] = [quoted(word) if is_override(word) else word for word in sys.argv[1:]]
    job()


if __name__ == "__main__":
    main()

"""The run of one stage: its scratch folder, its measurements, and the move into place at the end."""

import argparse
import functools
import hashlib
import os
import shutil
import sys
import traceback
from pathlib import Path

import pandas as pd

from .fetch import FetchError
from .files import PART, read_json, sha256, write_json, write_table
from .parallel import parallel_map, progress
from .params import load_params

DATA = Path("data")
PARTIAL = DATA / ".partial"
MEASUREMENTS = Path("reports/measurements")
METRICS = Path("reports/metrics")
FIRST, LAST = ("dataset", "object", "method"), ("metric", "value", "seconds", "seed")  # columns of every table


class StageRun:
    """Where one run of a stage works, so that `data/STAGE` is whole or absent and a killed run goes on.

    Everything is written to a scratch folder whose name holds a digest of the settings, the code and the inputs.
    `each` skips the items that an interrupted run with the same digest has finished. When the block ends well, the
    folder becomes `data/STAGE`, and the rows become `reports/measurements/STAGE.csv`: the seconds in them differ from
    run to run, so they stay out of `data/`, whose bytes do not.

        with StageRun("lod", inputs=("meshes", "salient_points")) as run:
            run.each(functools.partial(process, settings=settings), run.objects)
    """

    def __init__(self, stage, inputs=()):
        settings = load_params()
        self.stage = stage
        self.target = DATA / stage
        self.dataset = settings.get("meshes", {}).get("source", "none")
        self.seed = settings.get("seed", 0)
        chosen = {key: value for key, value in settings.items() if key != "parallel"}  # it may read others' sections
        self.inputs = [DATA / name for name in inputs]
        self.folder = PARTIAL / f"{stage}-{_digest(chosen, self.inputs)}"
        self.rows = []

    def __enter__(self):
        for folder in self.inputs:
            if not folder.is_dir() or not any(folder.iterdir()):
                raise ValueError(f"{folder} is not there: run `dvc repro {folder.name}` first")
        self.folder.mkdir(parents=True, exist_ok=True)
        self._sweep()
        return self

    def _sweep(self):
        """Removes the files that a killed run, or a worker that outlived it, was about to write."""
        for half in self.folder.rglob(f"{PART}*"):
            half.unlink(missing_ok=True)

    @property
    def objects(self):
        """The names of all objects that the meshes stage accepted, in alphabetical order."""
        return object_names()

    def each(self, process, names):
        """Runs process(name, folder) -> list of row dicts over the names, side by side; returns all rows in order.

        `process` writes its files below `folder` through kit.files, and is a function of a module (or a partial of
        one), since it travels to other processes.
        """
        done = functools.partial(_process_once, process, self.folder)
        rows = [row for found in parallel_map(done, list(names), desc=self.stage) for row in found]
        self.rows += rows
        return rows

    def progress(self, items):
        """The items, with a progress bar; silent when stderr is no terminal."""
        return progress(items, self.stage)

    def metrics(self, values):
        """Writes the small numbers that the gate and `dvc metrics` look at."""
        write_json(METRICS / f"{self.stage}.json", values)

    def __exit__(self, error, *_):
        if error is not None:
            return
        frame = pd.DataFrame(self.rows) if self.rows else pd.DataFrame(columns=[*FIRST, *LAST])
        frame["dataset"], frame["seed"] = self.dataset, self.seed
        others = [name for name in frame if name not in (*FIRST, *LAST)]
        order = [name for name in (*FIRST, *others, *LAST) if name in frame]
        write_table(MEASUREMENTS / f"{self.stage}.csv", frame[order])
        shutil.rmtree(self.folder / ".rows", ignore_errors=True)
        self._sweep()
        shutil.rmtree(self.target, ignore_errors=True)
        self.folder.rename(self.target)
        for left in PARTIAL.glob(f"{self.stage}-*"):
            shutil.rmtree(left, ignore_errors=True)


def object_names():
    """The names of all objects that the meshes stage accepted, in alphabetical order."""
    return sorted(path.stem for path in (DATA / "meshes").glob("*.npz"))


def arguments(doc):
    """Answers --help with the stage's docstring, and lets errors of input and settings end in one line.

    A stage has no other argument: its settings live in params.yaml.
    """
    first, _, rest = (doc or "").partition("\n")
    form = argparse.RawDescriptionHelpFormatter
    stage = Path(sys.argv[0]).parent.name
    program = f"python -m stages.{stage}"
    argparse.ArgumentParser(prog=program, description=first, epilog=rest, formatter_class=form).parse_args()
    errors_in_one_line(stage)


def errors_in_one_line(name):
    """From now on what a person did (ValueError, a missing file, no network, Ctrl-C) ends in one line, no traceback.

    A fault of ours keeps its traceback. After Ctrl-C Python ends by the signal itself, which shells report as 130, and
    which stops a loop of theirs as well.
    """

    def show(kind, error, trace):
        if issubclass(kind, KeyboardInterrupt):
            return print(f"{name}: stopped", file=sys.stderr)
        if not issubclass(kind, ValueError | FetchError | OSError):
            return sys.__excepthook__(kind, error, trace)
        ours = [place for place in traceback.extract_tb(trace) if f"{os.sep}stages{os.sep}" in place.filename]
        where = f" [{Path(ours[-1].filename).name}:{ours[-1].lineno}]" if ours else ""
        print(f"{name}: {error}{where}", file=sys.stderr)

    sys.excepthook = show


def _process_once(process, folder, name):
    finished = folder / ".rows" / f"{name}.json"
    if not finished.exists():
        try:
            write_json(finished, process(name, folder))
        except ValueError as error:
            raise ValueError(f"{name}: {error}") from error
    return read_json(finished)


def _digest(settings, inputs):
    """Twelve hex digits of the settings, the code of all stages and the input folders."""
    digest = hashlib.sha256(repr(settings).encode())
    code = sorted(
        path for path in Path(__file__).parents[1].rglob("*.*") if path.is_file() and "__pycache__" not in path.parts
    )
    data = [path for folder in inputs for path in sorted(folder.rglob("*")) if path.is_file()]
    for path in [*code, *data]:
        digest.update(str(path.name).encode() + sha256(path).encode())
    return digest.hexdigest()[:12]

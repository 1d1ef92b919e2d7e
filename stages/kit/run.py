"""The run of one stage on one data set: its inputs, its rows, its objects, and the move into place at the end."""

import functools
import shutil
from collections.abc import Callable, Iterable, Mapping, Sequence
from pathlib import Path
from types import TracebackType
from typing import Any, TypeVar

from .code import stage_digest
from .files import write_json
from .guard import only_reads
from .objects import Objects, key_of
from .parallel import parallel_map, progress
from .rows import SUFFIX, write_rows
from .workspace import Workspace

Rows = list[dict[str, Any]]
Item = TypeVar("Item")
Result = TypeVar("Result")


class StageRun:
    """Where one run of a stage works, so that `data/SET/STAGE` is whole or absent and a killed run goes on.

    Everything is written to a scratch folder. `each` keeps what it makes of an object in a cache, and takes from there
    what an earlier or killed run has made of the same inputs. When the block ends well, the folder becomes
    `data/SET/STAGE`, and the rows become `reports/measurements/SET/STAGE.csv.gz`: the seconds in them differ from run
    to run, so they stay out of `data/`, whose bytes do not.

        with StageRun(workspace, "lod", COLUMNS, inputs=("meshes", "salient_points")) as run:
            work = functools.partial(process, data=workspace.data, settings=settings, seed=run.seed)
            run.each(work, run.objects, reads=("meshes/{}.npz", "salient_points/{}.npz"))

    columns: those of the stage's rows beside the common ones, each with a word on it (see stages.kit.rows).
    inputs: the stages of the same data set whose folders it reads.
    """

    def __init__(
        self, workspace: Workspace, stage: str, columns: Mapping[str, str] | None = None, inputs: Sequence[str] = ()
    ) -> None:
        self.workspace = workspace
        self.stage = stage
        self.columns = columns or {}
        self.seed = workspace.seed
        self.dataset = workspace.dataset
        self.target = workspace.data / stage
        self.inputs = [workspace.data / name for name in inputs]
        self.folder = workspace.build / "partial" / workspace.dataset / stage
        self.rows: Rows = []
        self._before = ""  # what the objects of earlier calls of `each` came from: later calls may build on them

    def __enter__(self) -> "StageRun":
        for folder in self.inputs:
            if not folder.is_dir() or not any(folder.iterdir()):
                stage = f"{folder.name}@{self.dataset}" if folder.parent.name == self.dataset else folder.name
                raise ValueError(f"{folder} is not there: run `dvc repro {stage}` first")
        shutil.rmtree(self.folder, ignore_errors=True)
        self.folder.mkdir(parents=True)
        return self

    @property
    def objects(self) -> list[str]:
        """The names of all objects of the data set that the meshes stage accepted, in alphabetical order."""
        return object_names(self.workspace)

    def each(
        self,
        process: Callable[[Any, Path], Rows],
        names: Iterable[str] | Mapping[str, Any],
        reads: Sequence[str] = (),
        made_of: Mapping[str, str] | None = None,
    ) -> Rows:
        """Runs process(name, folder) -> rows over the names, side by side; returns all rows in order.

        names: a mapping hands its values to `process` instead of the names; made_of must then tell the values apart.

        `process` is a function of a module, or a functools.partial of one. What it makes depends on nothing but the
        code of the stage, its other arguments, the files that it reads and earlier calls of `each` in this run: what
        agrees in all of them is taken from the cache. It writes its files below its `folder` through kit.files, and
        may leave there what a killed run goes on from.

        reads: files or folders relative to data/SET, `{}` stands for the name; opening another file below data/ is an
        error. made_of: for each name what else tells its input apart, such as the hash of a source file.
        """
        values: Mapping[str, Any] = names if isinstance(names, Mapping) else {name: name for name in names}
        given = process.keywords if isinstance(process, functools.partial) else {}
        function = process.func if isinstance(process, functools.partial) else process
        code = f"{stage_digest(self.stage)} {self._before}" if _is_of_stages(function) else self._before
        keys = {}
        for name in values:
            read = [self.workspace.data / pattern.format(name) for pattern in reads]
            identity = f"{function.__module__}.{function.__qualname__}"
            keys[name] = key_of(code, identity, given, name, read, (made_of or {}).get(name, ""))
        objects = Objects(self.workspace.build / "objects")
        done = {name: objects.take(key, self.folder) for name, key in keys.items()}  # before any worker starts
        missing = [(name, value) for name, value in values.items() if done[name] is None]
        work = functools.partial(_make, process, self.workspace, self.folder, tuple(reads), keys)
        done |= zip((name for name, _ in missing), self.map(work, missing), strict=True)
        rows = [row for name in values for row in done[name] or ()]
        self._before = "".join([self._before, *(key[:8] for key in keys.values())])
        self.rows += rows
        return rows

    def map(self, function: Callable[[Item], Result], items: Iterable[Item]) -> list[Result]:
        """[function(item) for item in items], side by side as params.yaml says, in the order of the items."""
        return parallel_map(function, items, f"{self.stage} {self.dataset}", **self.workspace.parallel)

    def progress(self, items: Iterable[Item]) -> Iterable[Item]:
        """The items, with a progress bar; silent when stderr is not a terminal."""
        return progress(items, f"{self.stage} {self.dataset}")

    def metrics(self, values: Mapping[str, Any]) -> None:
        """Writes the small numbers that the gate and `dvc metrics` look at."""
        write_json(self.workspace.metrics / f"{self.stage}.json", values)

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        if error is not None:
            return
        path = self.workspace.measurements / f"{self.stage}{SUFFIX}"
        write_rows(path, self.rows, self.columns, self.dataset, self.seed)
        shutil.rmtree(self.target, ignore_errors=True)
        self.target.parent.mkdir(parents=True, exist_ok=True)
        self.folder.rename(self.target)


def object_names(workspace: Workspace) -> list[str]:
    """The names of all objects that the meshes stage accepted, in alphabetical order."""
    return sorted(path.stem for path in (workspace.data / "meshes").glob("*.npz"))


def _make(
    process: Callable[[Any, Path], Rows],
    workspace: Workspace,
    folder: Path,
    reads: tuple[str, ...],
    keys: Mapping[str, str],
    named: tuple[str, Any],
) -> Rows:
    """The rows of one object, which is made and kept in the cache; its files are then below `folder`."""
    name, value = named
    objects = Objects(workspace.build / "objects")
    scratch = workspace.build / "scratch" / keys[name][:32]  # by what it is made of: a killed run finds it again
    scratch.mkdir(parents=True, exist_ok=True)
    try:
        with only_reads(workspace.root / "data", [workspace.data / pattern.format(name) for pattern in reads]):
            made = process(value, scratch)
    except ValueError as error:
        raise ValueError(f"{name}: {error}") from error
    objects.keep(keys[name], made, scratch)
    shutil.rmtree(scratch)
    rows = objects.take(keys[name], folder)
    if rows is None:
        raise OSError(f"{objects.folder} does not keep what is written to it: is the disk full?")
    return rows


def _is_of_stages(function: Callable[..., Any]) -> bool:
    return function.__module__.split(".")[0] in ("stages", "__main__")

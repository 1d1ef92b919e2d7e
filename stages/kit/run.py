"""The run of one stage on one data set: its inputs, its rows, its objects, and the move into place at the end."""

import functools
import os
import shutil
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from pathlib import Path
from types import TracebackType
from typing import Any, TypeVar

from haptic_glance.base.files import files_below, object_files, replace_folder, sha256, write_json

from .alone import alone
from .code import stage_digest
from .kept_rows import ItemRows, KeptRows
from .make import make, scratch
from .objects import Objects, item_key, key_of
from .parallel import Task, finished, parallel_map, progress
from .rows import SUFFIX, write_rows
from .workspace import Workspace

Rows = Sequence[dict[str, Any]]
Item = TypeVar("Item")
Result = TypeVar("Result")


class StageRun:
    """Where one run of a stage works, so that `data/SET/STAGE` is whole or absent and a killed run goes on.

    Everything is written to a scratch folder. `each` keeps what it makes of an object in a cache, and takes from there
    what an earlier or killed run has made of the same inputs. A second run of the same stage and set waits for the
    first. When the block ends well, the folder becomes
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
        self._alone = alone(self.folder.with_name(f"{stage}.lock"), f"{stage} {workspace.dataset}")
        self.rows = KeptRows()

    def __enter__(self) -> "StageRun":
        for folder in self.inputs:
            if not folder.is_dir() or not any(folder.iterdir()):
                stage = f"{folder.name}@{self.dataset}" if folder.parent.name == self.dataset else folder.name
                raise ValueError(f"{folder} is not there: run `dvc repro {stage}` first")
        self.target.parent.mkdir(parents=True, exist_ok=True)
        if not os.access(self.target.parent, os.W_OK):  # said before hours of work, not after them
            raise ValueError(f"{self.target.parent} cannot be written to: make it writable, or mount it so")
        self._alone.__enter__()
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
    ) -> KeptRows:
        """Runs process(name, folder) -> rows over the names, side by side; returns all rows in order, from the disk.

        names: a mapping hands its values to `process` instead of the names; made_of must then tell the values apart.

        `process` is a function of a module, or a functools.partial of one. What it makes depends on nothing but the
        code of the stage, its other arguments and the files that it reads: what agrees in all of them is taken from the
        cache. It writes its files below its `folder` through kit.files, and may leave there what a killed run goes on
        from. It may run on another machine, so everything it works on is among its arguments or in these files.

        reads: files or folders relative to data/SET, `{}` stands for the name. Below the stage's own name lies what
        earlier calls of this run have made. Opening another file of either is an error. made_of: for each name what
        else tells its input apart, such as the hash of a source file.
        """
        values: Mapping[str, Any] = names if isinstance(names, Mapping) else {name: name for name in names}
        given = process.keywords if isinstance(process, functools.partial) else {}
        function = process.func if isinstance(process, functools.partial) else process
        stage = self.stage if _is_of_stages(function) else ""
        call = key_of(stage and stage_digest(stage), f"{function.__module__}.{function.__qualname__}", given)
        tasks = self._tasks(call, values, reads, made_of or {})
        root, desc = self.workspace.root, f"{self.stage} {self.dataset}"
        work = functools.partial(make, process, root, self.dataset)
        with Objects(self.workspace.build / "objects") as objects:
            rows = ItemRows(self.folder.parent, values)
            missing = [task for task in tasks if not self._taken(task, objects, rows)]  # before any worker starts
            for task, content in finished(work, missing, root, desc, stage=stage, **self.workspace.parallel):
                objects.keep(task.key, content)
                shutil.rmtree(scratch(root, self.dataset, task), ignore_errors=True)
                if not self._taken(task, objects, rows):
                    raise OSError(f"{objects.folder} does not keep what is written to it: is the disk full?")
        self.rows += rows
        return rows

    def map(self, function: Callable[[Item], Result], items: Iterable[Item]) -> list[Result]:
        """[function(item) for item in items], side by side as params.yaml says, in the order of the items."""
        return parallel_map(function, items, f"{self.stage} {self.dataset}", **self.workspace.parallel)

    def progress(self, items: Iterable[Item]) -> Iterable[Item]:
        """The items, with a progress bar; silent when stderr is not a terminal."""
        return progress(items, f"{self.stage} {self.dataset}")

    def _taken(self, task: Task, objects: Objects, rows: ItemRows) -> bool:
        """Whether an item's files and rows are kept; then they are taken from there."""
        found = objects.take(task.key, self.folder)
        if found is not None:
            rows.put(task.name, found)
        return found is not None

    def _tasks(
        self, call: str, values: Mapping[str, Any], reads: Sequence[str], made_of: Mapping[str, str]
    ) -> list[Task]:
        digest = functools.cache(lambda path: sha256(path) if path.exists() else "")  # many items read the same files
        tasks = []
        for name, value in values.items():
            files = {declared: path for pattern in reads for declared, path in self._files(pattern.format(name))}
            key = item_key(call, name, {one: digest(path) for one, path in files.items()}, made_of.get(name, ""))
            below = {os.path.relpath(path, self.workspace.root): digest(path) for path in files.values()}
            tasks.append(Task(name, value, below, key))
        return tasks

    def _files(self, declared: str) -> Iterator[tuple[str, Path]]:
        """(name, path) of a file that an item reads, be it there or not, or of all files of a folder."""
        stage, _, rest = declared.partition("/")
        path = self.folder / rest if stage == self.stage else self.workspace.data / declared
        if not path.is_dir():
            yield declared, path
            return
        for file in files_below(path):
            yield f"{declared}/{file.relative_to(path).as_posix()}", file

    def metrics(self, values: Mapping[str, Any]) -> None:
        """Writes the small numbers that the gate and `dvc metrics` look at."""
        write_json(self.workspace.metrics / f"{self.stage}.json", values)

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        try:
            if error is None:
                path = self.workspace.measurements / f"{self.stage}{SUFFIX}"
                write_rows(path, self.rows, self.columns, self.dataset, self.seed)
                replace_folder(self.folder, self.target)
        finally:
            self._alone.__exit__(None, None, None)


def object_names(workspace: Workspace) -> list[str]:
    """The names of all objects that the meshes stage accepted, in alphabetical order."""
    return object_files(workspace.data / "meshes")


def _is_of_stages(function: Callable[..., Any]) -> bool:
    return function.__module__.split(".")[0] in ("haptic_glance", "stages", "__main__")

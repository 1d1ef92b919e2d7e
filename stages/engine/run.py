"""Runs a stage over the items of a data set, and caches the archive of each item.

An item is computed in this process, in another process or on another machine that shares the folder. Its function may
read only the files that it declares, so that its hash misses none. A killed run leaves its place free.
"""

import fcntl
import functools
import os
import shutil
import sys
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from contextvars import ContextVar
from dataclasses import dataclass
from pathlib import Path
from types import TracebackType
from typing import Any, TypeVar

from haptic_glance.base.files import files_below, object_files, replace_folder, sha256, write_json

from .code import stage_digest
from .objects import Objects, archive, item_key, key_of
from .parallel import finished, parallel_map
from .rows import SUFFIX, write_rows
from .settings import Workspace

Rows = Sequence[dict[str, Any]]
Item = TypeVar("Item")
Result = TypeVar("Result")


@dataclass(frozen=True)
class Task:
    """An item of a call of `StageRun.each`.

    name: another one for each item. value: what the function works on. files: all that it may read of data/ and of its
    stage. key: the hash of all that it comes from.
    """

    name: str
    value: Any
    files: tuple[Path, ...]
    key: str


class StageRun:
    """The folder of one run of a stage, so that `data/SET/STAGE` is whole or absent and a killed run goes on.

    Everything is written to a scratch folder. `each` keeps what it makes of an object in a cache, and takes from there
    what an earlier or killed run has made of the same inputs. A second run of the same stage and set waits for the
    first. When the block ends well, the folder becomes
    `data/SET/STAGE`, and the rows become `reports/measurements/SET/STAGE.csv.gz`: the seconds in them differ from run
    to run, so they stay out of `data/`, whose bytes do not.

        with StageRun(workspace, "lod", COLUMNS, inputs=("meshes", "salient_points")) as run:
            work = functools.partial(process, data=workspace.data, settings=settings, seed=run.seed)
            run.each(work, run.objects, reads=("meshes/{}.npz", "salient_points/{}.npz"))

    columns: those of the stage's rows beside the common ones, each with a word on it (see stages.engine.rows).
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
        self._lock = exclusive_lock(self.folder.with_name(f"{stage}.lock"), f"{stage} {workspace.dataset}")
        self.rows: list[dict[str, Any]] = []

    def __enter__(self) -> "StageRun":
        for folder in self.inputs:
            if not folder.is_dir() or not any(folder.iterdir()):
                stage = f"{folder.name}@{self.dataset}" if folder.parent.name == self.dataset else folder.name
                raise ValueError(f"{folder} is not there: run `dvc repro {stage}` first")
        self.target.parent.mkdir(parents=True, exist_ok=True)
        if not os.access(self.target.parent, os.W_OK):  # said before hours of work, not after them
            raise ValueError(f"{self.target.parent} cannot be written to: make it writable, or mount it so")
        self._lock.__enter__()
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
    ) -> list[dict[str, Any]]:
        """Runs process(name, folder) -> rows over the names, in parallel; returns all rows in order.

        names: a mapping hands its values to `process` instead of the names; made_of must then tell the values apart.

        `process` is a function of a module, or a functools.partial of one. What it makes depends on nothing but the
        code of the stage, its other arguments and the files that it reads: what agrees in all of them is taken from the
        cache. It writes its files below its `folder` through haptic_glance.base.files, and may leave there what a
        killed run goes on from. It may run on another machine, so everything it works on is among its arguments or in
        these files.

        reads: files or folders relative to data/SET, `{}` stands for the name. Below the stage's own name lies what
        earlier calls of this run have made. Opening another file of either is an error. made_of: for each name what
        else tells its input apart, such as the hash of a source file.
        """
        values: Mapping[str, Any] = names if isinstance(names, Mapping) else {name: name for name in names}
        arguments = process.keywords if isinstance(process, functools.partial) else {}
        function = process.func if isinstance(process, functools.partial) else process
        code = stage_digest(self.stage) if _is_of_stages(function) else ""
        call = key_of(code, f"{function.__module__}.{function.__qualname__}", arguments)
        tasks = self._tasks(call, values, reads, made_of or {})
        objects = Objects(self.workspace.build / "objects")
        rows = {task.name: objects.take(task.key, self.folder) for task in tasks}
        missing = [task for task in tasks if rows[task.name] is None]
        work = functools.partial(make, process, self.workspace.root, self.dataset)
        for task, content in finished(work, missing, f"{self.stage} {self.dataset}", **self.workspace.parallel):
            objects.keep(task.key, content)
            shutil.rmtree(scratch(self.workspace.root, self.dataset, task), ignore_errors=True)
            rows[task.name] = objects.take(task.key, self.folder)
            if rows[task.name] is None:
                raise OSError(f"{objects.folder} does not keep what is written to it")
        objects.trim()
        listed = [row for task in tasks for row in rows[task.name] or ()]
        self.rows += listed
        return listed

    def map(self, function: Callable[[Item], Result], items: Iterable[Item]) -> list[Result]:
        """[function(item) for item in items], in parallel as params.yaml says, in the order of the items."""
        return parallel_map(function, items, f"{self.stage} {self.dataset}", **self.workspace.parallel)

    def _tasks(
        self, call: str, values: Mapping[str, Any], reads: Sequence[str], made_of: Mapping[str, str]
    ) -> list[Task]:
        digest = functools.cache(lambda path: sha256(path) if path.exists() else "")  # many items read the same files
        tasks = []
        for name, value in values.items():
            files = {declared: path for pattern in reads for declared, path in self._files(pattern.format(name))}
            key = item_key(call, name, {file: digest(path) for file, path in files.items()}, made_of.get(name, ""))
            tasks.append(Task(name, value, tuple(files.values()), key))
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
            self._lock.__exit__(None, None, None)


def object_names(workspace: Workspace) -> list[str]:
    """The names of all objects that the meshes stage accepted, in alphabetical order."""
    return object_files(workspace.data / "meshes")


def _is_of_stages(function: Callable[..., Any]) -> bool:
    return function.__module__.split(".")[0] in ("haptic_glance", "stages", "__main__")


DATA, PARTIAL, SCRATCH = "data", "build/partial", "build/scratch"  # below the root


def make(process: Callable[[Any, Path], Sequence[dict[str, Any]]], root: Path, dataset: str, task: Task) -> bytes:
    """The archive (stages.engine.objects) of the rows and files of process(task.value, folder).

    The folder is named by what the item comes from, so that a killed run finds again what it left there, and by the
    data set: two sets with an object in common may run the same stage at the same time.
    """
    folder = scratch(root, dataset, task)
    folder.mkdir(parents=True, exist_ok=True)
    try:
        with only_reads([root / DATA, root / PARTIAL], task.files):
            rows = process(task.value, folder)
    except ValueError as error:
        raise ValueError(f"{task.name}: {error}") from error
    return archive(rows, folder)


def scratch(root: Path, dataset: str, task: Task) -> Path:
    """The folder that one item of one data set is made in."""
    return root / SCRATCH / dataset / task.key


_allowed: ContextVar[tuple[list[Path], set[Path]] | None] = ContextVar("allowed", default=None)
_hooked: list[bool] = []


class UndeclaredRead(RuntimeError):
    """A stage read a file, of data/ or of its own, that it did not declare for this object."""


@contextmanager
def only_reads(guarded: Sequence[Path], declared: Sequence[Path]) -> Iterator[None]:
    """Inside the block, opening a file below the `guarded` folders that is not `declared` raises UndeclaredRead.

    It sees what Python opens, not what compiled libraries read by themselves.
    """
    if not _hooked:
        sys.addaudithook(_check)  # cannot be taken out again, so it is put in once
        _hooked.append(True)
    token = _allowed.set(([path.resolve() for path in guarded], {path.resolve() for path in declared}))
    try:
        yield
    finally:
        _allowed.reset(token)


def _check(event: str, arguments: tuple[Any, ...]) -> None:
    limits = _allowed.get() if event == "open" else None
    if limits is None or not isinstance(arguments[0], str | os.PathLike):
        return
    guarded, declared = limits
    path = Path(arguments[0]).resolve()
    if path not in declared and any(path.is_relative_to(folder) for folder in guarded):
        raise UndeclaredRead(f"{path} is read, but not declared: name it in `reads` of StageRun.each")


@contextmanager
def exclusive_lock(path: Path, owner: str) -> Iterator[None]:
    """Inside the block no other process is in a block of the same lock file; a second one says so, and waits.

    Where DVC was killed, the stage that it started may still run while the next run of DVC starts the same stage.
    owner: names the waiting run on the screen. The system frees the lock when its process and all forks of it have
    ended.
    """
    path.parent.mkdir(parents=True, exist_ok=True)
    lock = os.open(path, os.O_RDWR | os.O_CREAT, 0o644)  # not filelock, which lets go of it in forked processes
    try:
        try:
            fcntl.flock(lock, fcntl.LOCK_EX | fcntl.LOCK_NB)
        except BlockingIOError:
            print(f"{owner}: waits for another run of the same to end", file=sys.stderr)
            fcntl.flock(lock, fcntl.LOCK_EX)
        yield
        fcntl.flock(lock, fcntl.LOCK_UN)
    finally:
        os.close(lock)

"""What a stage makes of one item, wherever that runs: in this process, in one beside it, or on another machine."""

import functools
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Any

from .guard import only_reads
from .objects import archive
from .parallel import Task

DATA, PARTIAL, SCRATCH = "data", "build/partial", "build/scratch"  # below the root


def make(
    process: Callable[[Any, Path], Sequence[dict[str, Any]]], home: Path, dataset: str, task: Task, root: Path
) -> bytes:
    """The archive (stages.kit.objects) of the rows and files of process(task.value, folder).

    home: the root that paths among the arguments of `process` lie below; they are moved to `root`. The folder is named
    by what the item comes from, so that a killed run finds again what it left there, and by the data set: two sets with
    an object in common may run the same stage at the same time.
    """
    folder = scratch(root, dataset, task)
    folder.mkdir(parents=True, exist_ok=True)
    try:
        with only_reads([root / DATA, root / PARTIAL], [root / path for path in task.files]):
            rows = _moved(process, home, root)(task.value, folder)
    except ValueError as error:
        raise ValueError(f"{task.name}: {error}") from error
    return archive(rows, folder)


def scratch(root: Path, dataset: str, task: Task) -> Path:
    """The folder that one item of one data set is made in."""
    return root / SCRATCH / dataset / task.key


def _moved(process, home, root):
    if root == home or not isinstance(process, functools.partial):
        return process
    paths = {name: value for name, value in process.keywords.items() if isinstance(value, Path)}
    moved = {name: root / path.relative_to(home) for name, path in paths.items() if path.is_relative_to(home)}
    return functools.partial(process, **moved)

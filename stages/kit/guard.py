"""Holds a function to the data files that it declares, so that nothing it depends on is missing from its hash."""

import os
import sys
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from contextvars import ContextVar
from pathlib import Path
from typing import Any

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

"""Parts of the report from an earlier run, used again while their inputs are unchanged.

A part is one kind of a topic (its claims, tables, figures or charts), or the meshes of the viewer. A part is built
again where a file that it opened or wrote is no longer the same: rows, benchmarks, data, or the code digests of other
stages. It is also built again where its key is another one. The key hashes the names of all such files, the settings,
the code behind the part and its prose.
"""

import hashlib
import os
import pickle
import sys
from collections.abc import Callable, Iterable, Iterator
from contextlib import contextmanager
from functools import cache
from pathlib import Path
from typing import Any

import cloudpickle

from haptic_glance.base.files import sha256, whole_file
from stages.engine.code import file_digest, files_behind

from .items import Built
from .records import versions
from .results import Results

FOLDER = "report"  # below build/
HERE = Path(__file__).parent
COMMON = ("items.py", "page.py", "records.py", "verdict.py")  # run for each topic, with all they import
BESIDE = ("topics.py", "reuse.py")  # run, too; what they import does not count: all topics
VIEWER = (HERE / "page.py",)


def key_of(part_files: Iterable[Path], results: Results) -> str:
    """Hashes what a part depends on, but for the content of the files that it opens.

    part_files: the code and the prose of the part alone, such as the files of its topic.
    """
    code = tuple(sorted(path for path in part_files if path.suffix == ".py"))
    behind = results.once(code, lambda: files_behind([*code, *(HERE / name for name in COMMON)]))
    files = [path for path in behind if path.suffix != ".md"]  # prose of other topics
    files += sorted(path for path in part_files if path.suffix == ".md") + [HERE / name for name in BESIDE]
    digests = [(str(path), file_digest(path)) for path in files]
    return _hash(results.once("inputs", lambda: _inputs(results)), *digests)


def _inputs(results: Results) -> str:
    """Hashes the inputs that all parts share."""
    names = [str(path) for folder in _folders(results) for path in sorted(folder.rglob("*")) if path.is_file()]
    return _hash(results.workspace.params, results.settings, versions(), names)


def _folders(results: Results) -> list[Path]:
    """The folders of the files that a part reads."""
    reports = {results.reports, results.workspace.published}
    folders = {folder / name for folder in reports for name in ("measurements", "bench")}
    return sorted({*folders, results.data, results.workspace.build / "code"})


def _hash(*parts: object) -> str:
    return hashlib.sha256(repr(parts).encode()).hexdigest()


_opened: list[set[str]] = []  # paths go into the last one; an audit hook cannot be taken back


@contextmanager
def files_opened() -> Iterator[set[str]]:
    """A set that gets the path of each file that this process opens inside the block."""
    _watch()
    _opened.append(set())
    try:
        yield _opened[-1]
    finally:
        _opened.pop()


@cache
def _watch() -> None:
    def note(event: str, arguments: tuple) -> None:
        if event == "open" and _opened and isinstance(arguments[0], str):
            _opened[-1].add(arguments[0])

    sys.addaudithook(note)


def built(work: Callable[[Results], Any], results: Results) -> tuple[Any, dict[Path, str]]:
    """(the part that some work makes of the results, {file: SHA-256} of the rows and data that it opened)."""
    with files_opened() as opened:
        part = work(results.unread())  # whatever was read before would not be opened
    folders = [os.path.abspath(folder) for folder in _folders(results)]
    paths = sorted({Path(os.path.abspath(path)) for path in opened})
    read_paths = [path for path in paths if any(path.is_relative_to(folder) for folder in folders) and path.is_file()]
    return part, {path: sha256(path) for path in read_paths}


def taken_again(name: str, key: str, results: Results) -> Any:
    """The part that `keep` stored; None without one, with another key, or where a file of the part has changed."""
    path = results.workspace.build / FOLDER / f"{name}.pickle"
    try:
        known_key, files, part = pickle.loads(path.read_bytes())
    except (OSError, ValueError, TypeError, AttributeError, ImportError, EOFError, pickle.UnpicklingError):
        return None
    is_unchanged = known_key == key and all(file.is_file() and sha256(file) == digest for file, digest in files.items())
    return part if is_unchanged else None


def keep(name: str, key: str, part: Any, read: dict[Path, str], results: Results) -> None:
    """Stores a part below build/, with its key and the hashes of the files that it read and wrote."""
    paths = [path for item in part.items for path in item.paths] if isinstance(part, Built) else []
    content = cloudpickle.dumps((key, read | {path: sha256(path) for path in paths}, part))
    with whole_file(results.workspace.build / FOLDER / f"{name}.pickle") as file:
        file.write_bytes(content)

"""Caches the result of a stage for one item under a hash of all its inputs, and keeps the rows of a run on the disk.

A killed run goes on where it stopped, and one object more costs one object. diskcache keeps the results below
build/objects; the oldest go first when it is full, and deleting the folder loses nothing but time.
"""

import errno
import hashlib
import io
import itertools
import json
import shutil
import sqlite3
import sys
import tempfile
import zipfile
import zlib
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from pathlib import Path
from typing import Any

import diskcache
import joblib
from diskcache.core import MODE_PICKLE

from haptic_glance.base.files import files_below

ROWS = "rows.json"  # in the archive of an object, beside its files
FILES = "files/"
LIMIT = 20 * 2**30  # bytes: several whole runs of the default data
OF_THE_DISK = {  # errors of sqlite that are no damage
    sqlite3.SQLITE_FULL: errno.ENOSPC,
    sqlite3.SQLITE_READONLY: errno.EROFS,
    sqlite3.SQLITE_CANTOPEN: errno.EROFS,
    sqlite3.SQLITE_IOERR: errno.EIO,
    sqlite3.SQLITE_BUSY: errno.EBUSY,
    sqlite3.SQLITE_LOCKED: errno.EBUSY,
}


class _Bytes(diskcache.Disk):
    """Values as they lie on the disk; diskcache would unpickle what somebody else may have put there."""

    def fetch(self, mode: int, filename: str | None, value: Any, read: bool) -> Any:
        if mode == MODE_PICKLE:
            raise ValueError("it is pickled")
        return super().fetch(mode, filename, value, read)


class Objects:
    """The cache below one folder; inside a block it stays open, as to open and close it takes longer than an object."""

    def __init__(self, folder: Path) -> None:
        self.folder = folder
        self._kept: diskcache.Cache | None = None

    def __enter__(self) -> "Objects":
        return self

    def __exit__(self, *_: object) -> None:
        if self._kept is not None:
            self._kept.close()
        self._kept = None

    def take(self, key: str, target: Path) -> list[dict[str, Any]] | None:
        """Puts the files that are kept under a key below `target` and returns the rows; None where there are none.

        A damaged entry is named on the screen and dropped.
        """
        try:
            content: Any = self._ask(lambda cache: cache.get(key))
        except ValueError as error:  # pickled; what the disk itself says goes on
            return self._damaged(error)
        if content is None:
            return None
        try:
            files = _unpacked(content, target)
            rows = json.loads(files.pop(ROWS))
        except (zipfile.BadZipFile, OSError, ValueError, KeyError, TypeError, EOFError, zlib.error) as error:
            return self._damaged(error)
        for member, data in files.items():
            path = target / member.removeprefix(FILES)
            path.parent.mkdir(parents=True, exist_ok=True)
            path.write_bytes(data)
        return rows

    def _damaged(self, error: Exception) -> None:
        print(f"cache: an entry of {self.folder} is damaged ({error}); computed again", file=sys.stderr)

    def keep(self, key: str, content: bytes) -> None:
        """Keeps what `archive` has made under a key."""
        self._ask(lambda cache: cache.set(key, content))

    def _ask(self, work: Callable[[diskcache.Cache], Any]) -> Any:
        """work(cache); a damaged cache is begun anew. OSError where the disk is full or cannot be written to."""
        settings: Any = {"size_limit": LIMIT, "eviction_policy": "least-recently-used", "disk_min_file_size": 0}
        for last in (False, True):
            try:
                if self._kept is None:
                    self._kept = diskcache.Cache(str(self.folder), disk=_Bytes, **settings)
                return work(self._kept)
            except sqlite3.DatabaseError as error:
                self.__exit__()
                number = OF_THE_DISK.get(getattr(error, "sqlite_errorcode", 0) & 255)
                if number or last:
                    raise OSError(number or errno.EIO, str(error), str(self.folder)) from error
                print(f"cache: {self.folder} is damaged ({error}); begun anew", file=sys.stderr)
                shutil.rmtree(self.folder)


def _unpacked(content, target):
    """{member: bytes} of an archive; ValueError for a member outside `target`."""
    with zipfile.ZipFile(io.BytesIO(content)) as zip_file:
        for member in zip_file.namelist():
            if not (target / member.removeprefix(FILES)).resolve().is_relative_to(target.resolve()):
                raise ValueError(f"{member} lies outside its folder")
        return {member: zip_file.read(member) for member in zip_file.namelist()}


def archive(rows: Sequence[Mapping[str, Any]], source: Path) -> bytes:
    """Rows and all files below `source` as one piece; half-written files are left out."""
    stream = io.BytesIO()
    with zipfile.ZipFile(stream, "w") as zip_file:
        zip_file.writestr(ROWS, json.dumps(list(rows)))
        for path in files_below(source):
            zip_file.write(path, FILES + path.relative_to(source).as_posix())
    return stream.getvalue()


def key_of(code: str, function: str, arguments: Mapping[str, Any]) -> str:
    """The hash of what all items of a call have in common.

    code: digest of the stage's code; function, arguments: what runs, and with which values. Paths among them do not
    count: they say where, and what is read there counts by its content.
    """
    plain = {key: value for key, value in arguments.items() if not isinstance(value, Path)}
    return hashlib.sha256(f"{code} {function} {joblib.hash(plain)}".encode()).hexdigest()


def item_key(call: str, name: str, files: Mapping[str, str], made_of: str) -> str:
    """The hash of what an item's results come from.

    call: of key_of; files: {file: SHA-256, empty where it is absent} of what it reads; made_of: what else tells the
    input apart, such as a hash of a source file. Half of SHA-256, as folders are named by it.
    """
    return hashlib.sha256(f"{call} {name} {made_of} {sorted(files.items())}".encode()).hexdigest()[:32]


Row = dict[str, Any]


class KeptRows(Sequence[Row]):
    """Rows in parts, one after the other; `+=` and `append` add to them. A row that is read is a copy."""

    def __init__(self, *parts: Sequence[Row]) -> None:
        self.parts = list(parts)

    def __iadd__(self, rows: Iterable[Row]) -> "KeptRows":
        self.parts.append(rows if isinstance(rows, KeptRows) else list(rows))
        return self

    def append(self, row: Row) -> None:
        """Adds one row."""
        self.parts.append([row])

    def __iter__(self) -> Iterator[Row]:
        return itertools.chain.from_iterable(self.parts)

    def __len__(self) -> int:
        return sum(map(len, self.parts))

    def __getitem__(self, place: Any) -> Any:
        return list(self)[place] if isinstance(place, slice) else next(itertools.islice(self, place, None))


class ItemRows(KeptRows):
    """The rows of items, put in any order and read in that of the names; in a file that ends with this object."""

    def __init__(self, folder: Path, names: Iterable[str]) -> None:
        super().__init__()
        self._file = tempfile.TemporaryFile(dir=folder)  # noqa: SIM115 (read after the run, too)
        self._places: dict[str, tuple[int, int]] = dict.fromkeys(names, (-1, 0))  # where a line starts, its rows

    def put(self, name: str, rows: Sequence[Row]) -> None:
        """Keeps the rows of an item."""
        self._places[name] = self._file.seek(0, 2), len(rows)
        self._file.write(json.dumps(rows).encode() + b"\n")

    def __iter__(self) -> Iterator[Row]:
        for start, _ in self._places.values():
            if start >= 0:
                self._file.seek(start)
                yield from json.loads(self._file.readline())

    def __len__(self) -> int:
        return sum(count for _, count in self._places.values())

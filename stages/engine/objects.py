"""Caches the result of a stage for one item under a hash of all its inputs, in build/objects.

A killed run goes on where it stopped, and one object more costs one object. The oldest results go first when the folder
is full. Deleting the folder loses nothing but time.
"""

import hashlib
import io
import json
import os
import sys
import zipfile
import zlib
from collections.abc import Mapping, Sequence
from contextlib import suppress
from pathlib import Path
from typing import Any

import joblib

from haptic_glance.base.files import files_below, whole_file

ROWS = "rows.json"  # in the archive of an object, beside its files
FILES = "files/"
LIMIT = 20 * 2**30  # bytes: several whole runs of the default data


class Objects:
    """The cache below one folder: a ZIP archive for each key, made by `archive`."""

    def __init__(self, folder: Path) -> None:
        self.folder = folder

    def take(self, key: str, target: Path) -> list[dict[str, Any]] | None:
        """Writes the files of a key below `target` and returns its rows; None without an archive, or a damaged one."""
        path = self._path(key)
        try:
            files = _unpacked(path, target)
            rows = json.loads(files.pop(ROWS))
        except FileNotFoundError:
            return None
        except (zipfile.BadZipFile, ValueError, KeyError, NotImplementedError, EOFError, zlib.error) as error:
            print(f"cache: {path} is damaged ({error}); computed again", file=sys.stderr)
            return None
        for member, data in files.items():
            file = target / member.removeprefix(FILES)
            file.parent.mkdir(parents=True, exist_ok=True)
            file.write_bytes(data)
        with suppress(OSError):  # of a cache that only may be read
            os.utime(path)  # it was used now
        return rows

    def keep(self, key: str, content: bytes) -> None:
        """Keeps what `archive` has made under a key."""
        with whole_file(self._path(key)) as part:
            part.write_bytes(content)

    def trim(self, limit: int = LIMIT) -> None:
        """Removes the archives that were not used for the longest time, until the others have `limit` bytes."""
        entries = [(path, path.stat()) for path in self.folder.rglob("*") if path.is_file()]
        size = sum(entry.st_size for _, entry in entries)
        for path, entry in sorted(entries, key=lambda pair: pair[1].st_mtime):
            if size <= limit:
                break
            path.unlink(missing_ok=True)
            size -= entry.st_size

    def _path(self, key: str) -> Path:
        return self.folder / key[:2] / f"{key}.zip"


def _unpacked(path: Path, target: Path) -> dict[str, bytes]:
    """{member: bytes} of an archive; ValueError for a member outside `target`."""
    with zipfile.ZipFile(path) as zip_file:
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

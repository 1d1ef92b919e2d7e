"""What a stage made of one object, kept under a hash of everything that it came from, and found again by that hash.

A killed run goes on where it stopped, and one object more costs one object. Kept by diskcache below build/objects; the
oldest go first when it is full, and deleting the folder loses nothing but time.
"""

import hashlib
import io
import json
import shutil
import sqlite3
import sys
import zipfile
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import diskcache
import joblib
from diskcache.core import MODE_PICKLE

from .files import PART

ROWS = "rows.json"  # in the archive of an object, beside its files
FILES = "files/"
LIMIT = 20 * 2**30  # bytes: several whole runs of the default data


class _Bytes(diskcache.Disk):
    """Values as they lie on the disk; diskcache would unpickle what somebody else may have put there."""

    def fetch(self, mode: int, filename: str | None, value: Any, read: bool) -> Any:
        if mode == MODE_PICKLE:
            raise ValueError("it is pickled")
        return super().fetch(mode, filename, value, read)


@dataclass(frozen=True)
class Objects:
    """The cache below one folder."""

    folder: Path

    def take(self, key: str, target: Path) -> list[dict[str, Any]] | None:
        """Puts the files that are kept under a key below `target` and returns the rows; None where there are none.

        A damaged entry is named on the screen and dropped.
        """
        try:
            with self._open() as kept:
                content: Any = kept.get(key)
            if content is None:
                return None
            with zipfile.ZipFile(io.BytesIO(content)) as stored:
                damaged = stored.testzip()
                if damaged:
                    raise zipfile.BadZipFile(damaged)
                for member in stored.namelist():
                    if member != ROWS:
                        path = target / member.removeprefix(FILES)
                        if not path.resolve().is_relative_to(target.resolve()):
                            raise ValueError(f"{member} lies outside its folder")
                        path.parent.mkdir(parents=True, exist_ok=True)
                        path.write_bytes(stored.read(member))
                return json.loads(stored.read(ROWS))
        except (zipfile.BadZipFile, OSError, ValueError, KeyError) as error:
            print(f"cache: an entry of {self.folder} is damaged ({error}); computed again", file=sys.stderr)
            return None

    def keep(self, key: str, content: bytes) -> None:
        """Keeps what `archive` has made under a key."""
        with self._open() as kept:
            kept.set(key, content)

    def _open(self) -> diskcache.Cache:
        settings = {"size_limit": LIMIT, "eviction_policy": "least-recently-used", "disk_min_file_size": 0}
        settings |= {"disk": _Bytes}
        try:
            return diskcache.Cache(str(self.folder), **settings)
        except sqlite3.DatabaseError as error:
            print(f"cache: {self.folder} is damaged ({error}); begun anew", file=sys.stderr)
            shutil.rmtree(self.folder)
            return diskcache.Cache(str(self.folder), **settings)


def archive(rows: Sequence[Mapping[str, Any]], source: Path) -> bytes:
    """Rows and all files below `source` as one piece; half-written files are left out."""
    stream = io.BytesIO()
    with zipfile.ZipFile(stream, "w") as stored:
        stored.writestr(ROWS, json.dumps(list(rows)))
        for path in files_below(source):
            stored.write(path, FILES + path.relative_to(source).as_posix())
    return stream.getvalue()


def files_below(folder: Path) -> list[Path]:
    """All whole files below a folder, in alphabetical order."""
    return sorted(path for path in folder.rglob("*") if path.is_file() and not path.name.startswith(PART))


def key_of(code: str, function: str, given: Mapping[str, Any]) -> str:
    """The hash of what all items of a call have in common.

    code: digest of the stage's code; function and given: what runs, with which arguments. Paths among them do not
    count: they say where, and what is read there counts by its content.
    """
    plain = {key: value for key, value in given.items() if not isinstance(value, Path)}
    return hashlib.sha256(f"{code} {function} {joblib.hash(plain)}".encode()).hexdigest()


def item_key(call: str, name: str, files: Mapping[str, str], made_of: str) -> str:
    """The hash of what an item's results come from.

    call: of key_of; files: {file: SHA-256, empty where it is absent} of what it reads; made_of: what else tells the
    input apart, such as a hash of a source file. Half of SHA-256, as folders are named by it.
    """
    return hashlib.sha256(f"{call} {name} {made_of} {sorted(files.items())}".encode()).hexdigest()[:32]

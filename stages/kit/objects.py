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

from .files import PART, sha256

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
            with zipfile.ZipFile(io.BytesIO(content)) as archive:
                damaged = archive.testzip()
                if damaged:
                    raise zipfile.BadZipFile(damaged)
                for member in archive.namelist():
                    if member != ROWS:
                        path = target / member.removeprefix(FILES)
                        if not path.resolve().is_relative_to(target.resolve()):
                            raise ValueError(f"{member} lies outside its folder")
                        path.parent.mkdir(parents=True, exist_ok=True)
                        path.write_bytes(archive.read(member))
                return json.loads(archive.read(ROWS))
        except (zipfile.BadZipFile, OSError, ValueError, KeyError) as error:
            print(f"cache: an entry of {self.folder} is damaged ({error}); computed again", file=sys.stderr)
            return None

    def keep(self, key: str, rows: Sequence[Mapping[str, Any]], source: Path) -> None:
        """Keeps rows and all files below `source` under a key; half-written files are left out."""
        stream = io.BytesIO()
        with zipfile.ZipFile(stream, "w") as archive:
            archive.writestr(ROWS, json.dumps(list(rows)))
            for path in files_below(source):
                archive.write(path, FILES + path.relative_to(source).as_posix())
        with self._open() as kept:
            kept.set(key, stream.getvalue())

    def _open(self) -> diskcache.Cache:
        settings = {"size_limit": LIMIT, "eviction_policy": "least-recently-used", "disk_min_file_size": 0}
        settings |= {"disk": _Bytes}
        try:
            return diskcache.Cache(str(self.folder), **settings)
        except sqlite3.DatabaseError as error:
            print(f"cache: {self.folder} is damaged ({error}); begun anew", file=sys.stderr)
            shutil.rmtree(self.folder)
            return diskcache.Cache(str(self.folder), **settings)


def files_below(folder: Path) -> list[Path]:
    """All whole files below a folder, in alphabetical order."""
    return sorted(path for path in folder.rglob("*") if path.is_file() and not path.name.startswith(PART))


def key_of(code: str, function: str, given: Mapping[str, Any], name: str, reads: Sequence[Path], made_of: str) -> str:
    """The hash of what an object's results come from.

    code: digest of the stage's code; function and given: what runs, with which arguments (paths among them do not
    count: they say where, and what is read there counts by its content); reads: the files read, folders with all that
    lies below them, absent ones as absent; made_of: what else tells the input apart, such as a hash of a source file.
    """
    plain = {key: value for key, value in given.items() if not isinstance(value, Path)}
    digest = hashlib.sha256(f"{code} {function} {joblib.hash(plain)} {name} {made_of}".encode())
    for path in reads:
        for file in files_below(path) if path.is_dir() else [path]:
            content = sha256(file) if file.exists() else "absent"
            digest.update(f"{path.name}/{file.name} {content}\n".encode())
    return digest.hexdigest()

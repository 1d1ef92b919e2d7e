"""Many small files in a few large ones, so that DVC has little to look at; readers name a file as if it lay there.

Where a folder has more than MOST objects (NAME.npz, or a folder NAME), they lie in up to 256 archives HH.pack. HH is a
hash of the name, so that one object more changes one archive. They are zip archives without compression and times:
equal files give equal bytes, and `unzip` opens them. Whatever may be packed is read through this file.
"""

import functools
import io
import os
import struct
import sys
import zipfile
import zlib
from pathlib import Path

PART = ".part-"  # how the name of a file begins that is not whole yet
SUFFIX = ".pack"
MOST = 500  # objects that stay files; DVC looks at 20,000 files a second, anew for each stage that reads them
HEADER, SIZES = 30, slice(26, 30)  # APPNOTE 4.3.7: bytes before a file's name, and where its lengths stand
Member = tuple[int, int, int]  # where the header of a file starts, its length in bytes, its CRC


def pack(folder: Path) -> None:
    """Moves the objects of a folder into archives if there are many; tables beside them stay files."""
    objects = [path for path in sorted(folder.iterdir()) if path.is_dir() or path.suffix == ".npz"]
    if len(objects) <= MOST:
        return
    by_archive: dict[str, list[Path]] = {}
    for path in objects:
        by_archive.setdefault(_archive_name(path.name), []).append(path)
    for name, paths in by_archive.items():
        with zipfile.ZipFile(folder / name, "w") as stored:
            for path in paths:
                _move(path, folder, stored)


def opened(path: str | Path) -> io.BufferedReader | io.BytesIO:
    """A file for reading, be it packed or not. FileNotFoundError as of open; OSError names a damaged archive."""
    path = Path(path)
    found = None if path.exists() else _found(path)
    if found is None:
        return open(path, "rb")
    sys.audit("open", str(path), "r", 0)  # so that the guard of declared files sees it
    archive, (start, length, crc) = found
    with open(archive, "rb") as stream:
        stream.seek(start)
        stream.seek(sum(struct.unpack("<HH", stream.read(HEADER)[SIZES])), os.SEEK_CUR)
        content = stream.read(length)
    if zlib.crc32(content) != crc:
        raise OSError(f"{archive} is damaged at {path.name}: remove it, and run the stage again")
    return io.BytesIO(content)


def is_there(path: Path) -> bool:
    """Whether a file is there, packed or not."""
    return path.exists() or _found(path) is not None


def files_below(folder: Path) -> list[Path]:
    """All whole files below a folder, packed or not, in alphabetical order; archives themselves are none."""
    found = [path for path in folder.rglob("*") if path.is_file() and not path.name.startswith(PART)]
    packed = [folder / name for path in found if path.suffix == SUFFIX for name in _members(path)]
    if not folder.exists():
        archive = folder.parent / _archive_name(folder.name)
        own = _members(archive) if archive.exists() else {}
        packed = [folder.parent / name for name in own if name.startswith(f"{folder.name}/")]
    return sorted([path for path in found if path.suffix != SUFFIX] + packed)


def object_files(folder: Path) -> list[str]:
    """The names of all objects that have a file NAME.npz in a folder, packed or not, in alphabetical order."""
    return sorted(path.stem for path in files_below(folder) if path.suffix == ".npz" and path.parent == folder)


def _move(path, folder, stored):
    files = sorted(path.rglob("*")) if path.is_dir() else [path]
    for file in files:
        if file.is_file():
            stored.writestr(zipfile.ZipInfo(file.relative_to(folder).as_posix()), file.read_bytes())
            file.unlink()
    for emptied in [*reversed(files), path]:
        emptied.rmdir() if emptied.is_dir() else None


def _archive_name(entry: str) -> str:
    return f"{zlib.crc32(entry.encode()) & 255:02x}{SUFFIX}"


def _found(path: Path) -> tuple[Path, Member] | None:
    """The archive of a packed file and its place there: the folder is above it, or above the object's folder."""
    for folder in list(path.parents)[:2]:
        name = path.relative_to(folder).as_posix()
        archive = folder / _archive_name(name.partition("/")[0])
        if archive.exists() and name in (members := _members(archive)):
            return archive, members[name]
    return None


def _members(archive: Path) -> dict[str, Member]:
    known = archive.stat()
    return _index(archive, known.st_mtime_ns, known.st_size)


@functools.lru_cache(maxsize=1024)
def _index(archive: Path, *_: int) -> dict[str, Member]:
    try:
        with zipfile.ZipFile(archive) as stored:
            return {one.filename: (one.header_offset, one.file_size, one.CRC) for one in stored.infolist()}
    except zipfile.BadZipFile as error:
        raise OSError(f"{archive} is damaged ({error}): remove it, and run the stage again") from None

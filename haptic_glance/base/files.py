"""Reads and writes files.

Each writer fills a temporary file and moves it into place, so that a file is complete or absent. A picture is decoded
whole, or refused with the name of its file.
"""

from __future__ import annotations

import csv
import errno
import gzip
import hashlib
import io
import json
import os
import shutil
import tempfile
import zipfile
import zlib
from collections.abc import Iterator, Mapping, Sequence
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import numpy as np
from PIL import Image

from haptic_glance.mesh.mesh import Mesh

from .lazy import pandas as pd

PART = ".part-"  # how the name of a file begins that is not whole yet
LEVEL = 3  # of zlib: views take a third of the time of its default 6 and 13 % more bytes, maps half and 3 %


def existing(*paths: Path | None) -> set[Path]:
    """Those of the paths where there is a file."""
    return {path for path in paths if path and path.exists()}


def said_of(paths: Sequence[Path], before: set[Path]) -> str:
    """Which paths were written and, as they had existed `before`, replaced: `written: a.png; replaced: b.csv`."""
    kinds = {
        "written": [str(path) for path in paths if path not in before],
        "replaced": [str(path) for path in paths if path in before],
    }
    return "; ".join(f"{kind}: {', '.join(names)}" for kind, names in kinds.items() if names)


def check_folder(folder: Path, name: str) -> None:
    """Raises ValueError, which begins with a name, unless the folder can be written to, or created."""
    if folder.exists() and not folder.is_dir():
        raise ValueError(f"{name} is a file: name a folder")
    ancestor = next(place for place in [folder.absolute(), *folder.absolute().parents] if place.exists())
    if not ancestor.is_dir() or not os.access(ancestor, os.W_OK):
        raise ValueError(f"{name}: {ancestor} is not writable")


@contextmanager
def whole_file(path: str | Path) -> Iterator[Path]:
    """A temporary path beside `path`, moved onto it when the block ends well and removed when it fails.

    An error of the disk inside the block names `path`: the system's own does not say what was being written.
    """
    path = Path(path)
    path.parent.mkdir(parents=True, exist_ok=True)
    handle, temporary = tempfile.mkstemp(prefix=PART, suffix=path.suffix, dir=path.parent)
    os.close(handle)
    os.chmod(temporary, 0o644)  # mkstemp makes it private; results are for everybody
    try:
        yield Path(temporary)
        os.replace(temporary, path)
    except OSError as error:
        if error.errno and error.filename is None:
            raise OSError(error.errno, error.strerror, str(path)) from error
        raise
    finally:
        Path(temporary).unlink(missing_ok=True)


def replace_folder(source: Path, target: Path) -> None:
    """Moves a folder to where another one may lie; from another disk it is copied before it takes the place.

    What a killed process leaves begins with PART, and the next one replaces it.
    """
    part = target.with_name(PART + target.name)
    shutil.rmtree(part, ignore_errors=True)
    try:
        source.rename(part)
    except OSError as error:
        if error.errno != errno.EXDEV:
            raise
        _copy(source, part)
        shutil.rmtree(source)
    shutil.rmtree(target, ignore_errors=True)
    part.rename(target)


def _copy(source: Path, part: Path) -> None:
    """Copies a folder; where that fails nothing of it stays, as the disk may be full."""
    try:
        for path in [source, *sorted(source.rglob("*"))]:
            copy = part / path.relative_to(source)
            copy.mkdir() if path.is_dir() else shutil.copyfile(path, copy)
    except OSError:
        shutil.rmtree(part, ignore_errors=True)
        raise


def files_below(folder: Path) -> list[Path]:
    """All whole files below a folder, in alphabetical order."""
    return sorted(path for path in folder.rglob("*") if path.is_file() and not path.name.startswith(PART))


def object_files(folder: Path) -> list[str]:
    """The names of all objects that have a file NAME.npz in a folder, in alphabetical order."""
    return sorted(path.stem for path in folder.glob("*.npz") if not path.name.startswith(PART))


def write_text(path: str | Path, text: str) -> None:
    """Writes text, utf-8, newline at the end."""
    with whole_file(path) as part:
        part.write_text(text if text.endswith("\n") else text + "\n", encoding="utf-8")


def write_json(path: str | Path, value: Any) -> None:
    """Writes JSON with sorted keys, so that equal values give equal bytes."""
    write_text(path, json.dumps(value, indent=2, sort_keys=True, ensure_ascii=False))


def read_json(path: str | Path) -> Any:
    """Reads a JSON file; ValueError that names it when it is not valid."""
    try:
        return json.loads(Path(path).read_text(encoding="utf-8"))
    except (ValueError, RecursionError) as error:
        raise ValueError(f"{path} is not valid JSON: {error}") from None


def write_arrays(path: str | Path, **arrays: Any) -> None:
    """Writes arrays to a compressed .npz; equal arrays give equal bytes."""
    with whole_file(path) as part, zipfile.ZipFile(part, "w", zipfile.ZIP_DEFLATED, compresslevel=LEVEL) as archive:
        for name, array in arrays.items():
            with archive.open(f"{name}.npy", "w", force_zip64=True) as stream:
                np.lib.format.write_array(stream, np.asanyarray(array), allow_pickle=False)


def read_arrays(path: str | Path, prefix: str = "") -> dict[str, np.ndarray]:
    """{name: array} of an .npz whose names begin with `prefix`; never unpickles. ValueError names any other file."""
    with open(path, "rb") as stream:
        try:
            with np.load(stream, allow_pickle=False) as archive:
                return {name: archive[name] for name in archive.files if name.startswith(prefix)}
        except Exception as error:  # zipfile, zlib, tokenize and numpy raise many types; each means a damaged file
            raise ValueError(f"{path} is not a sound .npz file: {' '.join(str(error).split())[:120]}") from None


def write_table(path: str | Path, frame: pd.DataFrame) -> None:
    """Writes a tidy frame to CSV: no index, six significant digits; compressed where the name ends with `.gz`."""
    content = frame.to_csv(index=False, float_format="%.6g", quoting=csv.QUOTE_MINIMAL).encode()
    if Path(path).suffix == ".gz":
        content = gzip.compress(content, mtime=0)  # no time inside: equal tables give equal bytes
    with whole_file(path) as part:
        part.write_bytes(content)


NAMES = dict.fromkeys(("class", "file", "item", "left_out", "object"), str)  # columns of names


def read_table(path: str | Path, dtype: Mapping[str, Any] | None = None) -> pd.DataFrame:
    """Reads a tidy CSV, compressed or not; ValueError that names it when it is not valid.

    Names stay texts: an object may be called `0012` or `nan`, so only an empty cell has no value. dtype: the types of
    further columns that are not to be guessed.
    """
    types, compression = {**NAMES, **(dtype or {})}, "gzip" if Path(path).suffix == ".gz" else None
    try:
        with open(path, "rb") as stream:
            return pd.read_csv(  # low_memory=False: one guess for a column
                stream, dtype=types, compression=compression, low_memory=False, keep_default_na=False, na_values=[""]
            )
    except (ValueError, gzip.BadGzipFile, EOFError, zlib.error) as error:
        raise ValueError(f"{path} is not a valid table: {error}") from None


def sha256(path: str | Path) -> str:
    """The file's SHA-256, in hex."""
    with open(path, "rb") as stream:
        return hashlib.file_digest(stream, "sha256").hexdigest()


def write_mesh(path: str | Path, mesh: Mesh) -> None:
    """Writes a Mesh to .npz."""
    colors = {} if mesh.colors is None else {"colors": mesh.colors}
    write_arrays(path, vertices=mesh.vertices, faces=mesh.faces, **colors)


def read_mesh(path: str | Path) -> Mesh:
    """Reads a Mesh from .npz; ValueError that names it when it holds none."""
    arrays = read_arrays(path)
    try:
        return Mesh(arrays["vertices"], arrays["faces"], arrays.get("colors"))
    except (KeyError, ValueError, TypeError) as error:
        raise ValueError(f"{path} holds no mesh: {error}") from None


MAX_PIXELS = 2**25  # twice what a camera of 16 megapixels takes; a header may state more than memory holds


def open_picture(content: bytes, name: str | Path) -> Image.Image:
    """The picture in the bytes of a file; ValueError that names it where they are none, or state too many pixels."""
    try:
        image = Image.open(io.BytesIO(content))
        if image.width * image.height <= MAX_PIXELS:
            image.load()
            return image
        reason = f"{image.width} x {image.height} pixels are more than {MAX_PIXELS}"
    except Exception as error:  # Pillow raises many types
        reason = " ".join(str(error).split()) or type(error).__name__
    raise ValueError(f"{name} is not a readable picture: download or unpack its archive again ({reason})")

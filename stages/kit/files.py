"""Files that are whole or absent: every writer goes through a temporary name and moves it into place."""

import csv
import hashlib
import json
import os
import tempfile
from contextlib import contextmanager
from pathlib import Path

import numpy as np
import pandas as pd

from .mesh import Mesh

PART = ".part-"  # how the name of a file begins that is not whole yet


@contextmanager
def whole_file(path):
    """A temporary path beside `path`, moved onto it when the block ends well and removed when it fails."""
    path = Path(path)
    path.parent.mkdir(parents=True, exist_ok=True)
    handle, temporary = tempfile.mkstemp(prefix=PART, suffix=path.suffix, dir=path.parent)
    os.close(handle)
    os.chmod(temporary, 0o644)  # mkstemp makes it private; results are for everybody
    try:
        yield Path(temporary)
        os.replace(temporary, path)
    finally:
        Path(temporary).unlink(missing_ok=True)


def write_text(path, text):
    """Writes text, utf-8, newline at the end."""
    with whole_file(path) as part:
        part.write_text(text if text.endswith("\n") else text + "\n", encoding="utf-8")


def write_json(path, value):
    """Writes JSON with sorted keys, so that equal values give equal bytes."""
    write_text(path, json.dumps(value, indent=2, sort_keys=True, ensure_ascii=False))


def read_json(path):
    """Reads a JSON file; ValueError that names it when it is none."""
    try:
        return json.loads(Path(path).read_text(encoding="utf-8"))
    except ValueError as error:
        raise ValueError(f"{path} is no JSON: {error}") from None


def write_arrays(path, **arrays):
    """Writes arrays to a compressed .npz; equal arrays give equal bytes."""
    with whole_file(path) as part, open(part, "wb") as stream:
        np.savez_compressed(stream, **arrays)


def read_arrays(path):
    """Reads an .npz to a dict of arrays; never unpickles."""
    with np.load(path, allow_pickle=False) as stored:
        return {name: stored[name] for name in stored.files}


def write_table(path, frame):
    """Writes a tidy frame to CSV: no index, six significant digits."""
    with whole_file(path) as part:
        frame.to_csv(part, index=False, float_format="%.6g", quoting=csv.QUOTE_MINIMAL)


def read_table(path):
    """Reads a tidy CSV."""
    return pd.read_csv(path)


def sha256(path):
    """The file's SHA-256, in hex."""
    with open(path, "rb") as stream:
        return hashlib.file_digest(stream, "sha256").hexdigest()


def write_mesh(path, mesh):
    """Writes a kit Mesh to .npz."""
    colors = {} if mesh.colors is None else {"colors": mesh.colors}
    write_arrays(path, vertices=mesh.vertices, faces=mesh.faces, **colors)


def read_mesh(path):
    """Reads a kit Mesh from .npz."""
    return Mesh(**read_arrays(path))

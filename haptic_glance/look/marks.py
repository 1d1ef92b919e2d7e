"""The points that people marked on a mesh: one CSV per mesh, which is read, checked, merged and written as a whole."""

import csv
import io
import os
import tempfile
from collections.abc import Iterable, Mapping, Sequence
from datetime import UTC, datetime
from pathlib import Path
from typing import TYPE_CHECKING, NamedTuple

import numpy as np
from filelock import FileLock
from numpy.typing import ArrayLike

from haptic_glance.base.extras import from_extra
from haptic_glance.base.files import write_text
from haptic_glance.mesh.mesh import Mesh

if TYPE_CHECKING:
    import pandas as pd

TYPES = {"annotator": str, "time": str, "vertex": np.int64, "x": np.float64, "y": np.float64, "z": np.float64}
COLUMNS = [*TYPES]
MAX_NAME_LENGTH = 80  # characters of an annotator's name
ON_VERTEX = 1e-4  # units; a hundred times the rounding of six decimals, a tenth of an edge at 40,000 faces
# Outside the folder of marks, which holds only marks; one per user, since users cannot open each other's lock.
LOCK = Path(tempfile.gettempdir()) / f"haptic-glance-marks-{getattr(os, 'getuid', int)()}.lock"


class Mark(NamedTuple):
    """A row of a file of marks, whose columns `read_marks` describes."""

    annotator: str
    time: str
    vertex: int
    x: float
    y: float
    z: float


class MarksError(ValueError):
    """A file of marks that cannot be used. The message names the file and the line."""


class MarksChanged(ValueError):
    """The rows of the annotator on disk have changed since the caller read them."""


def read_rows(path: str | Path, content: bytes | None = None) -> list[Mark]:
    """The marks of `read_marks` as a list, for which pandas need not be installed."""
    return [row for _, _, row in _rows(Path(path), content)]


def read_marks(path: str | Path, content: bytes | None = None) -> "pd.DataFrame":
    """The marks in a CSV, or in its content: frame with columns annotator, time, vertex (i8), x, y, z (f8), in order.

    time: ISO 8601 in UTC, when the point was marked; x, y, z: in units of the normalised mesh (bounding-box centre 0,
    bounding sphere of radius 0.5). Raises FileNotFoundError, or MarksError naming the first damaged line.
    """
    with from_extra():
        import pandas as pd

    return pd.DataFrame(read_rows(path, content), columns=pd.Index(COLUMNS)).astype(TYPES)


def write_marks(
    path: str | Path, annotator: str, marks: "pd.DataFrame | Sequence[Mapping]", expected: Iterable[tuple] | None = None
) -> None:
    """Replaces the rows of an annotator in a CSV by `marks`; rows of others stay unchanged, byte for byte.

    marks: frame or list of dicts with time (ISO 8601 with an offset, or an aware datetime), vertex, x, y, z; an empty
    one removes the rows. expected: pairs (time, vertex) that must equal the rows of the annotator on disk, else
    MarksChanged is raised; None skips the check. Concurrent writers are serialised, and the file is replaced as a
    whole. A damaged file raises MarksError and stays unchanged.
    """
    path, annotator = Path(path), check_annotator(annotator)
    new = [_line([annotator, *row]) for row in _values(marks)]
    with FileLock(LOCK):
        rows = list(_rows(path)) if path.exists() else []
        indices = [k for k, (_, _, row) in enumerate(rows) if row[0] == annotator]
        if expected is not None and [tuple(rows[k][2][1:3]) for k in indices] != [
            (utc(t), int(v)) for t, v in expected
        ]:
            raise MarksChanged(f"{path}: the points of {annotator} have changed since they were read")
        lines = [line for k, (_, line, _) in enumerate(rows) if k not in set(indices)]
        position = indices[0] if indices else len(lines)
        write_text(path, "\n".join([",".join(COLUMNS), *lines[:position], *new, *lines[position:]]))


def check_on_mesh(vertices: ArrayLike, positions: ArrayLike, mesh: Mesh, source: str | Path) -> None:
    """ValueError, with the distances, unless every mark lies at the vertex of the mesh that it names.

    vertices (k,) and positions (k, 3) of the marks in the file `source`.
    """
    vertices, count = np.asarray(vertices, dtype=np.int64), len(mesh.vertices)
    outside = vertices[(vertices < 0) | (vertices >= count)]
    if len(outside):
        raise ValueError(f"{source} is of another mesh: vertex {outside[0]} is not in 0..{count - 1}")
    distances = np.linalg.norm(mesh.vertices[vertices] - np.reshape(positions, (-1, 3)), axis=1)
    if (distances > ON_VERTEX).any():
        off = distances[distances > ON_VERTEX]
        raise ValueError(
            f"{source} is of another mesh: {len(off)} of {len(vertices)} points lie {off.min():.4g} to {off.max():.4g}"
            " units away from their vertices"
        )


def check_annotator(name: str) -> str:
    """The name without surrounding blanks; ValueError if it is empty, too long or has control characters."""
    name = name.strip() if isinstance(name, str) else ""
    if not name or len(name) > MAX_NAME_LENGTH or not name.isprintable():
        raise ValueError(f"an annotator's name must have 1 to {MAX_NAME_LENGTH} printable characters, got {name!r}")
    return name


def utc(time: str | datetime) -> str:
    """A time, as ISO 8601 text with an offset or an aware datetime, as text in UTC to the millisecond."""
    try:
        moment = time if isinstance(time, datetime) else datetime.fromisoformat(time)
    except (TypeError, ValueError):
        raise ValueError(f"{time!r} is not a time in ISO 8601") from None
    if moment.tzinfo is None:
        raise ValueError(f"{time!r} has no offset from UTC")
    return moment.astimezone(UTC).isoformat(timespec="milliseconds").replace("+00:00", "Z")


def _rows(path, content=None):
    """Yields (line number, line, row of typed values) of each mark."""
    lines = _text(path, content).split("\n")
    if lines[0].rstrip("\r") != ",".join(COLUMNS):
        raise MarksError(f"{path}, line 1: the header is not {','.join(COLUMNS)}, with commas between the columns")
    for number, line in enumerate(lines[1:], start=2):
        line = line.rstrip("\r")
        if line:
            try:
                yield number, line, _row(line)
            except (ValueError, csv.Error) as error:
                raise MarksError(f"{path}, line {number}: {error}; correct or remove the line") from None


def _text(path, content):
    content = path.read_bytes() if content is None else content
    try:
        return content.decode("utf-8-sig")  # spreadsheets write a byte order mark
    except UnicodeDecodeError as error:
        line = content[: error.start].count(b"\n") + 1
        raise MarksError(f"{path}, line {line}: not UTF-8 text; save the file as UTF-8") from None


def _row(line):
    cells = next(csv.reader([line], strict=True))
    if len(cells) != len(COLUMNS):
        raise ValueError(f"{len(cells)} values instead of {len(COLUMNS)}")
    vertex, place = int(cells[2]), [float(cell) for cell in cells[3:]]
    if not 0 <= vertex < 2**63 or not np.isfinite(place).all():
        raise ValueError(f"vertex {cells[2]} at {', '.join(cells[3:])} is not a point of a mesh")
    return Mark(check_annotator(cells[0]), utc(cells[1]), vertex, *place)


def _values(marks):
    """The cells of the columns after the annotator, checked by parsing them."""
    records = marks if isinstance(marks, Sequence) else marks.to_dict("records")
    rows = [[utc(mark["time"]), mark["vertex"], *(_decimal(float(mark[axis])) for axis in "xyz")] for mark in records]
    for row in rows:
        _row(_line(["checked", *row]))
    return rows


def _decimal(value):
    return f"{round(value, 6) + 0.0:.6f}"  # the sum turns -0.0 into 0.0


def _line(cells):
    stream = io.StringIO()
    csv.writer(stream, lineterminator="").writerow(cells)
    return stream.getvalue()

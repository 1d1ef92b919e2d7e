"""The points that people marked on a mesh: one CSV a mesh, read, checked, merged and written whole."""

import csv
import io
import os
import tempfile
from datetime import UTC, datetime
from pathlib import Path

import numpy as np
import pandas as pd
from filelock import FileLock

from stages.kit.files import write_text

COLUMNS = ["annotator", "time", "vertex", "x", "y", "z"]
TYPES = {"annotator": str, "time": str, "vertex": np.int64, "x": np.float64, "y": np.float64, "z": np.float64}
LONGEST_NAME = 80  # characters of an annotator's name
ON_VERTEX = 1e-4  # units; a hundred times the rounding of six decimals, a tenth of an edge at 40,000 faces
# Outside the folder of marks, where nothing but marks lies; one a user, since nobody can open another's in there.
LOCK = Path(tempfile.gettempdir()) / f"haptic-glance-marks-{getattr(os, 'getuid', int)()}.lock"


class MarksError(ValueError):
    """A file of marks that cannot be used as it is; the message names the file and the line."""


class MarksChanged(ValueError):
    """The annotator's rows on disk are no longer those that the caller has seen."""


def read_marks(path):
    """The marks in a CSV: frame with columns annotator, time, vertex (i8), x, y, z (f8), in the order of the file.

    time is ISO 8601 in UTC, when the point was chosen; x, y, z are units of the normalised mesh (bounding-box centre
    0, bounding sphere of radius 0.5). Raises FileNotFoundError, or MarksError naming the first damaged line.
    """
    return _frame([row for _, _, row in _rows(Path(path))])


def write_marks(path, annotator, marks, seen=None):
    """Replaces the annotator's rows in a CSV by `marks`; the others' rows stay as they are on disk, byte for byte.

    marks: frame or list of dicts with time (ISO 8601 with an offset, or an aware datetime), vertex, x, y, z; an empty
    one removes the rows. seen: pairs (time, vertex) that the annotator's rows must equal on disk, any when None; else
    MarksChanged. Writers take turns, and the file is whole or as before. A damaged file raises MarksError and stays.
    """
    path, annotator = Path(path), check_annotator(annotator)
    new = [_line([annotator, *row]) for row in _values(marks)]
    with FileLock(LOCK):
        rows = list(_rows(path)) if path.exists() else []
        own = [k for k, (_, _, row) in enumerate(rows) if row[0] == annotator]
        if seen is not None and [tuple(rows[k][2][1:3]) for k in own] != [(utc(t), int(v)) for t, v in seen]:
            raise MarksChanged(f"{path}: the points of {annotator} have changed since they were read")
        lines = [line for k, (_, line, _) in enumerate(rows) if k not in set(own)]
        at = own[0] if own else len(lines)
        write_text(path, "\n".join([",".join(COLUMNS), *lines[:at], *new, *lines[at:]]))


def check_on_mesh(marks, mesh, source):
    """ValueError unless every mark lies on the vertex of the mesh that it names; the message tells the distances."""
    count = len(mesh.vertices)
    outside = marks.vertex[(marks.vertex < 0) | (marks.vertex >= count)]
    if len(outside):
        raise ValueError(f"{source} marks another mesh: vertex {outside.iloc[0]} is none of 0..{count - 1}")
    away = np.linalg.norm(mesh.vertices[marks.vertex] - marks[["x", "y", "z"]], axis=1)
    if (away > ON_VERTEX).any():
        off = away[away > ON_VERTEX]
        raise ValueError(
            f"{source} marks another mesh: {len(off)} of {len(marks)} points lie {off.min():.4g} to {off.max():.4g}"
            " units away from the vertices that they name"
        )


def check_annotator(name):
    """The name without blanks around it; ValueError where it is empty, too long or holds control characters."""
    name = name.strip() if isinstance(name, str) else ""
    if not name or len(name) > LONGEST_NAME or not name.isprintable():
        raise ValueError(f"the annotator needs a name of 1 to {LONGEST_NAME} printable characters, got {name!r}")
    return name


def utc(time):
    """The time, ISO 8601 text with an offset or an aware datetime, as text in UTC to the millisecond."""
    try:
        moment = time if isinstance(time, datetime) else datetime.fromisoformat(time)
    except (TypeError, ValueError):
        raise ValueError(f"{time!r} is no time in ISO 8601") from None
    if moment.tzinfo is None:
        raise ValueError(f"{time!r} does not say its offset from UTC")
    return moment.astimezone(UTC).isoformat(timespec="milliseconds").replace("+00:00", "Z")


def _rows(path):
    """Yields (line number, line, row of typed values) of each mark."""
    lines = _text(path).split("\n")
    if lines[0].rstrip("\r") != ",".join(COLUMNS):
        raise MarksError(f"{path}, line 1: the header is not {','.join(COLUMNS)}")
    for number, line in enumerate(lines[1:], start=2):
        line = line.rstrip("\r")
        if line:
            try:
                yield number, line, _row(line)
            except (ValueError, csv.Error) as error:
                raise MarksError(f"{path}, line {number}: {error}; mend or remove the line") from None


def _text(path):
    content = path.read_bytes()
    try:
        return content.decode("utf-8-sig")  # spreadsheets put a mark in front
    except UnicodeDecodeError as error:
        line = content[: error.start].count(b"\n") + 1
        raise MarksError(f"{path}, line {line}: not UTF-8 text; mend or remove the line") from None


def _row(line):
    cells = next(csv.reader([line], strict=True))
    if len(cells) != len(COLUMNS):
        raise ValueError(f"{len(cells)} values instead of {len(COLUMNS)}")
    vertex, place = int(cells[2]), [float(cell) for cell in cells[3:]]
    if vertex < 0 or not np.isfinite(place).all():
        raise ValueError(f"vertex {cells[2]} at {', '.join(cells[3:])} is no place on a mesh")
    return [check_annotator(cells[0]), utc(cells[1]), vertex, *place]


def _frame(rows):
    columns = list(zip(*rows, strict=True)) or [[]] * len(COLUMNS)
    return pd.DataFrame(
        {name: pd.Series(values, dtype=TYPES[name]) for name, values in zip(COLUMNS, columns, strict=True)}
    )


def _values(marks):
    """Cells of the columns after the annotator, checked by reading them back."""
    frame = pd.DataFrame(marks, columns=COLUMNS[1:])
    rows = [[utc(mark.time), mark.vertex, *map(_decimal, (mark.x, mark.y, mark.z))] for mark in frame.itertuples()]
    for row in rows:
        _row(_line(["checked", *row]))
    return rows


def _decimal(value):
    return f"{round(value, 6) + 0.0:.6f}"  # the sum turns -0 into 0


def _line(cells):
    stream = io.StringIO()
    csv.writer(stream, lineterminator="").writerow(cells)
    return stream.getvalue()

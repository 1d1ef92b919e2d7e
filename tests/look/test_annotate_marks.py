"""Files of marks: what is written is read back, others' rows survive, damage is named and never overwritten."""

import threading
from datetime import UTC, datetime

import numpy as np
import pytest

from haptic_glance.look.marks import COLUMNS, MarksChanged, MarksError, check_on_mesh, read_marks, write_marks
from haptic_glance.mesh.mesh import Mesh

HEADER = ",".join(COLUMNS) + "\n"
OTHER = 'zoe,2026-01-02T03:04:05Z,7,0.5,-0.25,1e-1\n"Doe, Jane",2026-01-02T05:04:05+02:00,8,0,0,0.5\n'


def mark(vertex, time="2026-05-06T07:08:09.123Z", place=(0.1, -0.2, 0.3)):
    return {"time": time, "vertex": vertex, **dict(zip("xyz", place, strict=True))}


def test_a_written_file_is_read_back_and_can_be_written_again(tmp_path):
    write_marks(tmp_path / "cup.csv", "ann", [mark(3), mark(5, place=(-0.0, 1 / 3, -1e-9))])
    marks = read_marks(tmp_path / "cup.csv")
    assert list(marks) == COLUMNS and list(marks.vertex) == [3, 5] and set(marks.annotator) == {"ann"}
    assert marks.vertex.dtype == np.int64 and marks.x.dtype == np.float64
    assert np.allclose(marks[["x", "y", "z"]], [[0.1, -0.2, 0.3], [0, 1 / 3, 0]], atol=5e-7)
    line = (tmp_path / "cup.csv").read_text().splitlines()[2]
    assert line == "ann,2026-05-06T07:08:09.123Z,5,0.000000,0.333333,0.000000"
    write_marks(tmp_path / "again.csv", "ann", marks)
    assert (tmp_path / "again.csv").read_bytes() == (tmp_path / "cup.csv").read_bytes()


@pytest.mark.parametrize("time", ["2026-05-06T09:08:09+02:00", datetime(2026, 5, 6, 7, 8, 9, tzinfo=UTC)])
def test_times_become_utc(tmp_path, time):
    write_marks(tmp_path / "cup.csv", "ann", [mark(3, time)])
    assert list(read_marks(tmp_path / "cup.csv").time) == ["2026-05-06T07:08:09.000Z"]


def test_only_the_annotators_own_rows_are_replaced_and_a_new_annotators_are_appended(tmp_path):
    path = tmp_path / "cup.csv"
    first, second = OTHER.splitlines(keepends=True)
    path.write_text(HEADER + first + "ann,2026-01-01T00:00:00Z,1,0,0,0\n" + second)
    write_marks(path, "ann", [mark(2), mark(4)])
    lines = path.read_text().splitlines(keepends=True)
    assert [lines[1], lines[4]] == [first, second]  # byte for byte, though written in another manner than ours
    assert list(read_marks(path).vertex) == [7, 2, 4, 8]
    write_marks(path, "ann", [])
    assert path.read_text() == HEADER + OTHER
    path.write_text(HEADER + OTHER.rstrip("\n"))  # no newline at the end
    write_marks(path, "ann", [mark(2)])
    assert path.read_text().startswith(HEADER + OTHER)
    assert list(read_marks(path).annotator) == ["zoe", "Doe, Jane", "ann"]
    path.write_bytes(b"\xef\xbb\xbf" + (HEADER + OTHER).replace("\n", "\r\n").encode())  # a spreadsheet's
    assert list(read_marks(path).vertex) == [7, 8]


def test_no_row_is_lost_when_many_write_at_once(tmp_path):
    names = [f"person {k}" for k in range(12)]
    writers = [threading.Thread(target=write_marks, args=(tmp_path / "cup.csv", name, [mark(1)])) for name in names]
    for writer in writers:
        writer.start()
    for writer in writers:
        writer.join()
    assert sorted(read_marks(tmp_path / "cup.csv").annotator) == sorted(names)
    assert [path.name for path in tmp_path.iterdir()] == ["cup.csv"]  # no half file, no lock left


def test_rows_that_changed_since_they_were_seen_are_not_replaced(tmp_path):
    path = tmp_path / "cup.csv"
    write_marks(path, "ann", [mark(3)], expected=[])
    before = path.read_bytes()
    with pytest.raises(MarksChanged, match="ann"):
        write_marks(path, "ann", [mark(4)], expected=[])
    assert path.read_bytes() == before
    write_marks(path, "ann", [mark(4)], expected=[("2026-05-06T07:08:09.123+00:00", 3)])
    assert list(read_marks(path).vertex) == [4]


@pytest.mark.parametrize(
    "line, reason",
    [
        ("zoe,2026-01-02T03:04:05Z,7,0.5,0.2", "5 values instead of 6"),
        ("zoe,2026-01-02T03:04:05Z,7.5,0.5,0.2,0.1", "7.5"),
        ("zoe,2026-01-02T03:04:05Z,-7,0.5,0.2,0.1", "not a point of a mesh"),
        ("zoe,2026-01-02T03:04:05Z,7,0.5,nan,0.1", "not a point of a mesh"),
        ("zoe,yesterday,7,0.5,0.2,0.1", "not a time"),
        ("zoe,2026-01-02T03:04:05,7,0.5,0.2,0.1", "offset"),
        (",2026-01-02T03:04:05Z,7,0.5,0.2,0.1", "name"),
        ('"zoe,2026-01-02T03:04:05Z,7,0.5,0.2,0.1', "end of data"),
        ("z\udcffe,2026-01-02T03:04:05Z,7,0.5,0.2,0.1", "UTF-8"),
    ],
)
def test_damage_is_named_with_file_and_line_and_never_overwritten(tmp_path, line, reason):
    path = tmp_path / "cup.csv"
    content = (HEADER + OTHER + line + "\n").encode("utf-8", "surrogateescape")
    path.write_bytes(content)
    for attempt in (lambda: read_marks(path), lambda: write_marks(path, "ann", [mark(1)])):
        with pytest.raises(MarksError, match=rf"cup\.csv, line 4: .*{reason}"):
            attempt()
    assert path.read_bytes() == content


def test_a_missing_file_is_an_error_and_a_file_without_marks_is_empty(tmp_path):
    with pytest.raises(FileNotFoundError):
        read_marks(tmp_path / "cup.csv")
    (tmp_path / "cup.csv").write_text(HEADER)
    marks = read_marks(tmp_path / "cup.csv")
    assert marks.empty and list(marks) == COLUMNS and marks.vertex.dtype == np.int64


@pytest.mark.parametrize(
    ("name", "bad", "message"),
    [
        *[(name, mark(1), "name must have 1 to") for name in ("  ", "a\nb", "x" * 81, None)],
        ("ann", mark(1, "soon"), "not a time"),
        ("ann", mark(-1), "not a point of a mesh"),
    ],
)
def test_unusable_names_and_marks_are_refused_before_anything_is_written(tmp_path, name, bad, message):
    with pytest.raises(ValueError, match=message):
        write_marks(tmp_path / "cup.csv", name, [mark(2), bad])
    assert not (tmp_path / "cup.csv").exists()


def test_marks_off_the_mesh_are_named_with_their_distances():
    mesh = Mesh([[0, 0, 0], [1, 0, 0], [0, 1, 0]], [[0, 1, 2]])
    places = np.array([[1.0, 0, 0], [0, 1, 0]])
    check_on_mesh([0, 1, 2], mesh.vertices, mesh, "cup.csv")
    with pytest.raises(ValueError, match=r"cup\.csv .*1 of 2 points lie 0\.25 to 0\.25 units"):
        check_on_mesh([1, 2], places + [[0, 0, 0], [0, 0, 0.25]], mesh, "cup.csv")
    with pytest.raises(ValueError, match="vertex 3 is not in 0..2"):
        check_on_mesh([1, 3], places, mesh, "cup.csv")

"""Marks of a person: saved at once, one file a mesh, nothing of another window lost."""

import numpy as np
import pytest

from haptic_glance.look.marks import MarksError, read_marks
from haptic_glance.mesh import normalise
from haptic_glance.studio.panels.mark import Marking


@pytest.fixture
def marking(mesh, tmp_path):
    return lambda name="ann": Marking(normalise(mesh), "ball", tmp_path / "marks", name)


def stored(marking):
    marks = read_marks(marking.path)
    return list(zip(marks.annotator, marks.vertex, strict=True))


def test_marks_are_saved_with_the_places_of_their_vertices(marking):
    ours = marking()
    for vertex in (5, 9, 5):
        ours.add(vertex)
        assert not ours.save() and ours.saved
    marks = read_marks(ours.path)
    assert stored(ours) == [("ann", 5), ("ann", 9)] and list(marks.time) == sorted(marks.time)
    assert np.allclose(marks[["x", "y", "z"]], ours.mesh.vertices[[5, 9]], atol=1e-6)
    assert marking().marks == ours.marks


def test_removing_and_undoing(marking):
    ours = marking()
    for vertex in (5, 9, 12):
        ours.add(vertex)
    ours.remove(2)
    ours.save()
    assert [vertex for _, vertex in ours.marks] == [5, 12]
    ours.undo()
    ours.save()
    assert [vertex for _, vertex in stored(ours)] == [5, 9, 12]
    for _ in range(3):
        ours.undo()
    ours.save()
    assert stored(ours) == []
    with pytest.raises(ValueError, match="nothing to undo"):
        ours.undo()
    with pytest.raises(ValueError, match="no point 1"):
        ours.remove(1)


def test_two_windows_under_one_name_lose_nothing(marking):
    first, other = marking(), marking()
    first.add(5)
    first.add(6)
    first.save()
    other.add(9)
    assert other.save() and other.saved
    assert stored(first) == [("ann", 5), ("ann", 6), ("ann", 9)]
    first.remove(1)
    assert first.save()
    assert stored(first) == [("ann", 6), ("ann", 9)]


def test_one_vertex_marked_in_two_windows_is_one_mark_and_another_person_has_marks_of_their_own(marking):
    first, other, theirs = marking(), marking(), marking("bob")
    first.add(5)
    first.save()
    other.add(5)
    assert other.save() and stored(first) == [("ann", 5)]
    theirs.add(7)
    assert not theirs.save()
    assert stored(first) == [("ann", 5), ("bob", 7)]


def test_what_cannot_be_saved_stays_and_is_saved_later(marking, tmp_path):
    ours = marking()
    (tmp_path / "marks").write_text("a file where the folder should be")
    ours.add(5)
    with pytest.raises(OSError):
        ours.save()
    assert not ours.saved and len(ours.marks) == 1
    (tmp_path / "marks").unlink()
    ours.save()
    assert stored(ours) == [("ann", 5)]


def test_a_damaged_file_or_one_of_another_mesh_is_named_and_stays(marking, mesh, tmp_path):
    ours = marking()
    ours.add(5)
    ours.save()
    other = type(mesh)(mesh.vertices * [1, 2, 1], mesh.faces)
    with pytest.raises(ValueError, match=r"ball.csv is of another mesh"):
        Marking(normalise(other), "ball", tmp_path / "marks", "ann")
    ours.path.write_text("annotator,time,vertex,x,y,z\nzoe,now\n")
    with pytest.raises(MarksError, match="line 2"):
        marking()
    assert ours.path.read_text().endswith("zoe,now\n")

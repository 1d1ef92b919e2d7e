"""The mesh files that a person names: one, or a folder of them."""

import pytest

from haptic_glance.mesh import MeshError
from haptic_glance.mesh.files import mesh_files, names_of


def test_a_folder_gives_its_meshes_in_order_and_nothing_else(tmp_path):
    for name in ("b.STL", "a.ply", "a.mtl", "readme.txt"):
        (tmp_path / name).touch()
    (tmp_path / "c.obj").mkdir()
    assert [path.name for path in mesh_files(tmp_path)] == ["a.ply", "b.STL"]
    assert mesh_files(tmp_path / "readme.txt") == [tmp_path / "readme.txt"]  # whose reader says what is wrong
    with pytest.raises(MeshError, match="gone: no such file or folder"):
        mesh_files(tmp_path / "gone")
    (tmp_path / "empty").mkdir()
    with pytest.raises(MeshError, match="empty: no mesh in this folder; the formats are .stl"):
        mesh_files(tmp_path / "empty")


def test_files_of_one_stem_are_told_apart(tmp_path):
    files = [tmp_path / name for name in ("a.ply", "a.stl", "b.stl")]
    assert names_of(files) == ["a.ply", "a.stl", "b"]

"""The objects that can be known: basic shapes, and the meshes of a folder."""

import sys

import numpy as np
import pytest
import trimesh

from haptic_glance import write_any
from haptic_glance.base.files import write_mesh
from haptic_glance.know import known_objects, primitives
from haptic_glance.mesh.mesh import Mesh


@pytest.fixture(scope="module")
def shapes():
    return primitives()


def test_a_folder_gives_its_meshes_and_names_what_it_leaves_out(tmp_path, shapes, monkeypatch):
    for name in ("cubelarge.npz", "cubesmall.npz"):  # as the pipeline has them
        write_mesh(tmp_path / name, shapes["box"])
    for name in ("mug_small.stl", "mug_large.stl", "small.stl"):
        write_any(tmp_path / name, shapes["box"])
    (tmp_path / "broken.stl").write_bytes(b"solid nothing")
    write_any(tmp_path / "line.ply", Mesh(np.arange(3.0)[:, None] * [1, 0, 0], np.array([[0, 1, 2]])))
    write_any(tmp_path / "._mug.stl", shapes["box"])
    (tmp_path / "notes.txt").write_text("no mesh")
    monkeypatch.setitem(sys.modules, "pymeshlab", None)
    (tmp_path / "cloud.xyz").write_text("\n".join(f"{i % 9} {i % 7} {i % 5}" for i in range(200)))
    meshes, notes = known_objects(tmp_path)
    assert list(meshes) == ["cubelarge", "mug_large", "mug_small", "small"]
    assert [note.partition(":")[0] for note in notes] == ["broken.stl", "cloud.xyz", "line.ply"]
    assert str(tmp_path) not in "".join(notes)
    assert np.linalg.norm(meshes["small"].vertices, axis=1).max() == pytest.approx(0.5)
    few, left_out = known_objects(tmp_path, most=1)
    assert not few and len(left_out) == 7  # the first by name is the broken one
    assert known_objects(tmp_path / "nowhere") == ({}, [])
    with pytest.raises(ValueError, match="small.stl is a file: give the folder"):
        known_objects(tmp_path / "small.stl")
    trimesh.Trimesh(shapes["box"].vertices, shapes["box"].faces).export(tmp_path / "small.stl")
    with pytest.warns(UserWarning, match="small.stl does not say which axis points up"):
        known_objects(tmp_path)


def test_sizes_count_where_the_files_share_a_unit(tmp_path, shapes):
    write_any(tmp_path / "small.stl", Mesh(0.02 * shapes["ball"].vertices, shapes["ball"].faces))
    (mesh,) = known_objects(tmp_path, sized=True)[0].values()
    assert np.linalg.norm(mesh.vertices, axis=1).max() == pytest.approx(0.01)

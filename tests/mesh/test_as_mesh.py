"""Whatever a person has for a mesh goes through the public functions."""

import numpy as np
import pytest
import trimesh

import haptic_glance
from haptic_glance import Mesh, MeshError, Surface, as_mesh, load, normalise, to_trimesh
from haptic_glance.mesh.files import mesh_files

EGG = trimesh.creation.icosphere(3)
EGG.vertices *= [1, 1, 1.4]


def forms(folder):
    EGG.export(folder / "egg.ply")
    arrays = (EGG.vertices.tolist(), EGG.faces.tolist())
    return [folder / "egg.ply", str(folder / "egg.ply"), EGG, arrays, Mesh(EGG.vertices, EGG.faces, up="auto")]


@pytest.mark.slow
def test_each_form_gives_the_same_mesh_in_the_order_of_its_vertices(tmp_path):
    for form in forms(tmp_path):
        mesh = as_mesh(form)
        assert np.allclose(mesh.vertices, EGG.vertices, atol=1e-6) and (mesh.faces == EGG.faces).all()
        assert mesh.up in ("y", "z") and mesh.up == as_mesh(EGG).up
    assert as_mesh(mesh) is mesh


def test_colours_of_trimesh_are_taken_over_and_given_back():
    colors = np.arange(3 * len(EGG.vertices)).reshape(-1, 3) % 256
    painted = trimesh.Trimesh(EGG.vertices, EGG.faces, vertex_colors=colors, process=False)
    back = to_trimesh(as_mesh(painted))
    assert (as_mesh(painted).colors == colors).all() and (back.visual.vertex_colors[:, :3] == colors).all()


def test_the_parts_of_a_scene_are_joined():
    scene = trimesh.Scene([EGG, trimesh.creation.box()])
    assert len(as_mesh(scene).faces) == len(EGG.faces) + 12
    with pytest.raises(MeshError, match="no geometry"):
        as_mesh(trimesh.Scene())


@pytest.mark.parametrize("value", [5, None, np.zeros((3, 3)), (1, 2, 3)])
def test_what_is_no_mesh_is_told_what_would_be(value):
    with pytest.raises(TypeError, match=f"no mesh: a {type(value).__name__}; give a path, a trimesh"):
        as_mesh(value)
    with pytest.raises(ValueError, match=r"vertices must have shape \(n, 3\)"):
        as_mesh((np.zeros((4, 2)), [[0, 1, 2]]))


def test_a_surface_is_pressed_as_it_is(tmp_path):
    mesh = normalise(load(forms(tmp_path)[0], up="z"))
    assert (haptic_glance.press(Surface(mesh), 7) == haptic_glance.press(mesh, 7)).all()


def test_a_folder_gives_its_meshes_in_order_and_nothing_else(tmp_path):
    for name in ("b.STL", "a.ply", "a.mtl", "readme.txt", "._a.ply"):
        (tmp_path / name).touch()
    (tmp_path / "c.obj").mkdir()
    assert [path.name for path in mesh_files(tmp_path)] == ["a.ply", "b.STL"]
    assert mesh_files(tmp_path / "readme.txt") == [tmp_path / "readme.txt"]  # whose reader says what is wrong
    with pytest.raises(MeshError, match="gone: no such file or folder"):
        mesh_files(tmp_path / "gone")
    (tmp_path / "empty").mkdir()
    with pytest.raises(MeshError, match="empty: no mesh in this folder; the formats are .stl"):
        mesh_files(tmp_path / "empty")


def test_a_change_of_a_trimesh_object_leaves_its_mesh_alone():
    mesh = as_mesh(trimesh.creation.box())
    before, made = Mesh(mesh.vertices.copy(), mesh.faces.copy(), up=mesh.up), to_trimesh(mesh)
    made.vertices[0] += 1
    made.faces[0] = made.faces[0][::-1]
    assert mesh == before

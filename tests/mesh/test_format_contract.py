"""Every format that is read or written: the same mesh comes back, and a damaged file is refused by its name."""

import numpy as np
import pytest
import trimesh

from haptic_glance.lod.export import FORMATS as WRITTEN
from haptic_glance.lod.export import write_any
from haptic_glance.lod.weight_files import WRITERS, write_weights
from haptic_glance.mesh import MeshError, clean, load
from haptic_glance.mesh.files import FORMATS as READ
from haptic_glance.mesh.mesh import Mesh, Texture
from tests.shapes import ball_mesh

CUBE = trimesh.creation.box()
ODD = {"STL_ASCII": lambda text: text.upper(), "stl_trailed": lambda content: content + b"\0\0"}
PICTURED, COLOURED = (".glb", ".obj"), (".glb", ".obj", ".ply")
NAME = "tasse à café 茶"


@pytest.mark.parametrize("kind", ["stl", "stl_ascii", *ODD, "obj", "ply", "off", "glb"])
def test_the_same_cube_is_read_in_the_order_of_its_vertices(tmp_path, kind):
    path = tmp_path / f"{NAME}.{kind.split('_')[0]}"
    content = CUBE.export(file_type=kind.lower().removesuffix("_trailed"))
    content = ODD.get(kind, type(content))(content)
    path.write_bytes(content.encode() if isinstance(content, str) else content)
    mesh, notes = clean(load(path))
    assert len(mesh.faces) == 12 and len(mesh.vertices) == 8 and mesh.watertight and not notes
    assert mesh.face_areas.sum() == pytest.approx(6)
    if kind in ("obj", "ply", "off"):
        np.testing.assert_allclose(load(path).vertices, CUBE.vertices, atol=1e-5)


def sorted_rows(*columns):
    return np.unique(np.round(np.hstack(columns), 5), axis=0)


@pytest.mark.parametrize("suffix", WRITTEN)
@pytest.mark.parametrize("up", ["z", "-y", "0,0.6,0.8"])
def test_what_is_written_reads_back_with_its_colours_and_its_axis(tmp_path, suffix, up):
    ball = ball_mesh(2, 0.3)
    colors = np.rint((ball.vertices + 0.3) * 425).astype(np.uint8)
    mesh = Mesh(ball.vertices + [3, -2, 1], ball.faces, colors, up=up)
    write_any(tmp_path / f"{NAME}{suffix}", mesh)
    again = load(tmp_path / f"{NAME}{suffix}")
    assert len(again.faces) == len(mesh.faces) and again.watertight and len(again.vertices) == len(mesh.vertices)
    assert again.up == ("y" if suffix == ".glb" else up)
    corners = (mesh.vertices[mesh.faces] @ np.eye(3)).reshape(-1, 3)
    np.testing.assert_allclose(sorted_rows(again.vertices[again.faces].reshape(-1, 3)), sorted_rows(corners), atol=2e-5)
    assert again.face_crosses.sum(axis=0) == pytest.approx(0, abs=1e-5)
    assert (again.colors is not None) == (suffix in COLOURED)
    if suffix in COLOURED:
        shade = np.rint((again.vertices - [3, -2, 1] + 0.3) * 425)
        assert np.abs(again.colors - shade).max() <= 1


@pytest.mark.parametrize("suffix", WRITTEN)
def test_a_picture_is_kept_where_the_format_has_pictures_and_its_colours_elsewhere(tmp_path, suffix):
    ball = ball_mesh(2)
    uv = (ball.vertices[ball.faces][..., :2] / 2.1 + 0.5).astype(np.float32)
    image = np.random.default_rng(0).integers(256, size=(16, 16, 4), dtype=np.uint8) | np.uint8([0, 0, 0, 255])
    mesh = Mesh(ball.vertices, ball.faces, None, Texture(uv, np.zeros(len(uv), int), (image,)))
    write_any(tmp_path / f"ball{suffix}", mesh)
    again = load(tmp_path / f"ball{suffix}")
    assert len(again.faces) == 320 and again.watertight
    assert (again.texture is not None) == (suffix in PICTURED) and (again.colors is not None) == (suffix == ".ply")
    if suffix in PICTURED:
        assert np.array_equal(again.texture.images[0], image)
        assert np.unique(again.texture.uv.round(5).reshape(-1, 2), axis=0) == pytest.approx(
            np.unique(uv.round(5).reshape(-1, 2), axis=0), abs=2e-5
        )


def test_another_suffix_is_named_with_those_there_are(tmp_path):
    for write, mesh in ((write_any, (ball_mesh(1),)), (write_weights, (ball_mesh(1), np.ones(42)))):
        with pytest.raises(ValueError, match=r"a\.dwg.*written as \.glb"):
            write(tmp_path / "a.dwg", *mesh)
    assert not list(tmp_path.iterdir()) and set(WRITERS) == {".ply", ".glb", ".npz", ".usda"}


@pytest.mark.filterwarnings("ignore")
@pytest.mark.parametrize("content", [b"", b"\0" * 90, b"no mesh at all\n"], ids=["empty", "zeros", "words"])
@pytest.mark.parametrize("suffix", READ)
def test_what_is_no_mesh_is_refused_by_its_name(tmp_path, suffix, content):
    path = tmp_path / f"broken{suffix}"
    path.write_bytes(content)
    with pytest.raises(MeshError, match=rf"broken\{suffix}: "):
        load(path)
    with pytest.raises(MeshError, match=rf"absent\{suffix}: no such file"):
        load(tmp_path / f"absent{suffix}")

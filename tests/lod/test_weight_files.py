"""Files of weights: each vertex keeps its own weight in each format."""

import json
import re
import struct
import warnings
from dataclasses import replace

import numpy as np
import pytest
import trimesh

from haptic_glance.cli.saliency import run
from haptic_glance.gallery.demo import sample
from haptic_glance.lod import write_any, write_weights
from haptic_glance.mesh import load, rotate_to_z_up
from haptic_glance.mesh.mesh import Mesh, Texture


@pytest.fixture
def ball():
    sphere = trimesh.creation.icosphere(2)
    mesh = Mesh(sphere.vertices, sphere.faces)
    return mesh, np.random.default_rng(0).random(len(mesh.vertices)).astype(np.float32)


def test_ply_has_a_property(ball, tmp_path):
    mesh, weights = ball
    write_weights(tmp_path / "w.ply", mesh, weights)
    loaded = trimesh.load(tmp_path / "w.ply", process=False)
    np.testing.assert_array_equal(loaded.metadata["_ply_raw"]["vertex"]["data"]["saliency"], weights)
    np.testing.assert_array_equal(loaded.faces, mesh.faces)


def test_glb_has_a_scalar_attribute_that_follows_the_seams_of_a_texture(ball, tmp_path):
    mesh, weights = ball
    images = [np.full((2, 2, 4), 255, dtype=np.uint8)]
    uv = np.random.default_rng(1).random((len(mesh.faces), 3, 2)).astype(np.float32)
    textured = Mesh(mesh.vertices, mesh.faces, texture=Texture(uv, np.zeros(len(mesh.faces), dtype=np.int64), images))
    write_weights(tmp_path / "w.glb", textured, weights)
    [part] = trimesh.load(tmp_path / "w.glb", process=False).geometry.values()
    assert len(part.vertices) > len(mesh.vertices) and part.visual.uv is not None
    order = np.linalg.norm(part.vertices[:, None] - mesh.vertices[None], axis=2).argmin(axis=1)
    np.testing.assert_array_equal(part.vertex_attributes["_SALIENCY"].ravel(), weights[order])
    data = (tmp_path / "w.glb").read_bytes()
    header = json.loads(data[20 : 20 + struct.unpack("<I", data[12:16])[0]])
    [primitive] = header["meshes"][0]["primitives"]
    accessor = header["accessors"][primitive["attributes"]["_SALIENCY"]]
    assert (accessor["type"], accessor["componentType"]) == ("SCALAR", 5126)


def test_vertices_at_one_place_keep_weights_of_their_own(ball, tmp_path):
    mesh, weights = ball
    twice = Mesh(np.tile(mesh.vertices, (2, 1)), np.concatenate([mesh.faces, mesh.faces[:, ::-1] + len(mesh.vertices)]))
    write_weights(tmp_path / "w.glb", twice, np.concatenate([weights, 1 - weights]))
    [part] = trimesh.load(tmp_path / "w.glb", process=False).geometry.values()
    np.testing.assert_array_equal(part.vertex_attributes["_SALIENCY"].ravel(), np.concatenate([weights, 1 - weights]))


def test_npz_has_the_arrays_of_meshoptimizer(ball, tmp_path):
    mesh, weights = ball
    write_weights(tmp_path / "w.npz", mesh, weights)
    arrays = np.load(tmp_path / "w.npz")
    assert arrays["indices"].dtype == np.uint32 and arrays["vertices"].dtype == np.float32
    np.testing.assert_array_equal(arrays["indices"].reshape(-1, 3), mesh.faces)
    np.testing.assert_array_equal(arrays["saliency"], weights)


def test_usda_has_a_primvar(ball, tmp_path):
    mesh, weights = ball
    write_weights(tmp_path / "w.usda", mesh, weights)
    text = (tmp_path / "w.usda").read_text()
    assert "metersPerUnit = 1" in text  # OpenUSD's validator asks for it
    values = re.search(r"primvars:saliency = \[(.*?)\] \(\s+interpolation = \"vertex\"", text, re.DOTALL)
    np.testing.assert_array_equal(np.array(values[1].split(", "), dtype=np.float32), weights)
    assert len(re.search(r"points = \[(.*)\]", text)[1].split("), (")) == len(mesh.vertices)


@pytest.mark.parametrize("up", ["x", "-x", "y", "-y", "z", "-z", "0,0.6,0.8"])
def test_the_files_say_which_axis_points_up(ball, tmp_path, up):
    mesh, weights = replace(ball[0], up=up), ball[1]
    write_weights(tmp_path / "w.ply", mesh, weights)
    assert load(tmp_path / "w.ply").up == up
    write_weights(tmp_path / "w.usda", mesh, weights)
    text = (tmp_path / "w.usda").read_text()
    rows = re.search(r"points = \[\((.*)\)\]", text)[1].split("), (")
    vertices = np.array([row.split(", ") for row in rows], dtype=float)
    stated = re.search('upAxis = "(.)"', text)[1].lower()
    turned = rotate_to_z_up(Mesh(vertices, mesh.faces, up=stated)).vertices
    np.testing.assert_allclose(turned[:, 2], rotate_to_z_up(mesh).vertices[:, 2], atol=1e-6)


@pytest.mark.parametrize(
    ("name", "weights", "words"),
    [
        ("w.obj", np.ones(162), "written as .glb"),
        ("w.ply", np.ones(3), "w.ply: weights must be one per vertex"),
        ("w.ply", np.full(162, 1.5), r"w.ply: weights must lie in 0\.\.1"),
        ("w.ply", np.full(162, np.nan), r"w.ply: weights must lie in 0\.\.1"),
    ],
)
def test_wrong_files_and_weights_are_named(ball, tmp_path, name, weights, words):
    with pytest.raises(ValueError, match=words):
        write_weights(tmp_path / name, ball[0], weights)
    assert not list(tmp_path.iterdir())


def test_places_that_single_precision_moves_are_warned_of(ball, tmp_path):
    far = replace(ball[0], vertices=ball[0].vertices + 1e5)
    for write, kind, text in (
        (write_any, "ply", r", or write text \(.obj, .off\)"),
        (lambda path, mesh: write_weights(path, mesh, ball[1]), "usda", "$"),
    ):
        with pytest.warns(UserWarning, match=rf"w.{kind}: single precision moves .* move it to the origin{text}"):
            write(tmp_path / f"w.{kind}", far)
        with pytest.raises(ValueError, match=f"v.{kind}: its coordinates are too large for single precision"):
            write(tmp_path / f"v.{kind}", replace(far, vertices=1e45 * far.vertices))
        with pytest.raises(ValueError, match="single precision moves vertices by [0-9.]+ % of the diagonal"):
            write(tmp_path / f"v.{kind}", replace(far, vertices=ball[0].vertices + 5e6))
    with warnings.catch_warnings(action="error"):
        write_any(tmp_path / "w.ply", ball[0])
        write_any(tmp_path / "w.obj", far)
    assert load(tmp_path / "w.obj").vertices == pytest.approx(far.vertices, abs=1e-6)


@pytest.mark.slow
def test_the_command_writes_the_saliency_of_each_vertex(tmp_path, capsys):
    run([str(sample()), "--count", "1", "--weights", str(tmp_path / "w.ply")])
    assert "written" in capsys.readouterr().err
    vertex = trimesh.load(tmp_path / "w.ply", process=False).metadata["_ply_raw"]["vertex"]
    assert vertex["length"] == len(load(sample()).vertices) and vertex["data"]["saliency"].max() == 1
    run([str(tmp_path / "w.ply"), "--up", "x", "--count", "1", "--weights", str(tmp_path / "w.glb")])
    assert "turned from x up" in capsys.readouterr().err
    with pytest.raises(ValueError, match="weights are written as"):
        run([str(sample()), "--weights", str(tmp_path / "w.stl")])

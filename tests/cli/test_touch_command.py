"""`haptic-glance touch MESH`: a person's own mesh, from file to picture."""

import json

import numpy as np
import pandas as pd
import pytest
import trimesh
from PIL import Image

from haptic_glance import press
from haptic_glance.cli.touch import POINT, parse_options, run
from haptic_glance.look.points import find_points
from haptic_glance.mesh import load, normalise, rotate_to_z_up
from haptic_glance.mesh.mesh import Mesh
from haptic_glance.touch import imprint_pictures as pictures
from haptic_glance.touch import places as user_mesh
from haptic_glance.touch import press_many
from haptic_glance.touch.imprint_pictures import CANDIDATES, best_views, visible, write_picture
from haptic_glance.touch.places import UserMesh
from haptic_glance.touch.skin import Layer

from .conftest import PLACE, bumpy


def exported(path):
    """The file of the ball as another program would write it, without the axis that is up."""
    mesh = bumpy()
    trimesh.Trimesh(mesh.vertices, mesh.faces, process=False).export(path)
    return path


@pytest.fixture
def file(tmp_path):
    return exported(tmp_path / "ball.ply")


@pytest.fixture
def touched(file, tmp_path, capsys, monkeypatch):
    """Function: touches without drawing; returns (arrays, table, standard output, standard error)."""
    monkeypatch.setattr(pictures, "write_picture", lambda path, *_: path.touch())

    def work(*options, source=file):
        run([str(source), *map(str, options), "--out", str(tmp_path / "out")])
        captured = capsys.readouterr()
        with np.load(tmp_path / "out/imprints.npz") as stored:
            arrays = dict(stored)
        return arrays, pd.read_csv(tmp_path / "out/places.csv"), captured.out, captured.err

    return work


def test_json_has_the_places_as_the_table_has_them(touched):
    _, table, printed, messages = touched("--at", 3, 50, "--json")
    assert "touch: pressing\ntouch: drawing\ntouch: written: " in messages
    assert "touch: replaced: " in touched("--at", 3, 50, "--json")[-1]
    rows = json.loads(printed)
    assert [list(row) for row in rows] == [list(table.columns)] * 2
    assert [row["vertex"] for row in rows] == [3, 50] and rows[0]["relief"] == pytest.approx(
        table["relief"][0], rel=1e-5
    )


def test_vertices_feel_what_press_feels_and_relief_has_the_units_of_the_file(touched, file):
    arrays, table, printed, _ = touched("--at", 3, 200, "--cells", 8, 10, "--pitch", 0.02)
    mesh = normalise(load(file))
    assert np.array_equal(arrays["images"], press_many(mesh, [3, 200], (8, 10), 0.02))
    assert table["vertex"].tolist() == arrays["vertices"].tolist() == [3, 200]
    x = load(file).vertices
    assert np.allclose(table[["x", "y", "z"]], x[[3, 200]], atol=1e-4)
    relief = np.ptp(arrays["distances"][0])
    assert table["relief"][0] == pytest.approx(relief, rel=1e-5)
    assert table["relief_in_file"][0] == pytest.approx(relief * arrays["unit"], rel=1e-5)
    middle = (x.min(axis=0) + x.max(axis=0)) / 2
    assert arrays["unit"] == pytest.approx(2 * np.linalg.norm(x - middle, axis=1).max())
    assert f"1 unit is {arrays['unit']:.4g}" in printed


def test_position_of_a_vertex_feels_as_the_vertex_and_may_be_negative(touched, file):
    vertices = load(file).vertices
    lowest = vertices[:, 1].argmin()
    arrays, table, _, _ = touched("--at", lowest, ",".join(f"{value:.9g}" for value in vertices[lowest]))
    assert np.allclose(arrays["images"][0], arrays["images"][1], atol=1e-4)
    assert table["vertex"].fillna(-1).tolist() == [lowest, -1] and table["y"][1] < 0
    assert np.allclose(table[["x", "y", "z"]], vertices[lowest], atol=1e-4)
    assert POINT.fullmatch("-.5,1,-2e-3") and not POINT.fullmatch("-5") and not POINT.fullmatch("--at")
    assert str(parse_options(["1,2,3.stl", "--out", "2024,11,29"]).out) == "2024,11,29"


def test_normals_and_axes_are_those_of_the_file(touched, file):
    arrays, table, _, _ = touched("--at", 10, 300, "--up", "y")
    away = load(file).vertices[[10, 300]] - PLACE
    assert (np.sum(away * table[["nx", "ny", "nz"]].to_numpy(), axis=1) > 0.9 * np.linalg.norm(away, axis=1)).all()
    assert np.allclose(arrays["axes"][:, 2], arrays["normals"]) and (arrays["axes"][:, 1, 1] > 0).all()


@pytest.mark.parametrize("up", ["x", "y", "0,1,1"])
def test_coordinates_come_back_from_the_meshs_frame(up):
    unturned = Mesh(bumpy().vertices * [1, 2, 4] + [3, 0, 1], bumpy().faces, up=up)
    model = UserMesh(unturned, "ball")
    points = np.random.default_rng(0).random((5, 3))
    assert np.allclose(model.from_file(model.to_file(points)), points)
    assert np.allclose(model.to_file(model.mesh.vertices), unturned.vertices)
    assert np.allclose(model.mesh.vertices, normalise(rotate_to_z_up(unturned, up)).vertices)
    lengths = [np.linalg.norm(np.ptp(mesh.vertices[[0, 9]], axis=0)) for mesh in (unturned, model.mesh)]
    assert lengths[0] / lengths[1] == pytest.approx(model.unit)
    image = press(unturned, 9, pitch="100mm", unit="m")  # as the command feels it
    assert np.allclose(image, press(model.mesh, 9, pitch=0.1 / model.unit))


def test_random_places_depend_on_the_seed_alone(touched, file):
    first, table, _, _ = touched("--at", "random", "--count", 3)
    again, _, _, _ = touched("--at", "random", "--count", 3)
    other, _, _, _ = touched("--at", "random", "--count", 3, "--seed", 1)
    assert len(table) == 3 and np.array_equal(first["images"], again["images"])
    assert not np.array_equal(first["vertices"], other["vertices"])
    assert np.array_equal(first["vertices"], find_points(load(file), "random", 3))


def test_places_that_are_missing_or_without_a_normal_are_counted(tmp_path, touched):
    box = trimesh.creation.box()
    box.export(tmp_path / "box.stl")
    _, table, _, messages = touched("--at", "random", "--count", 50, source=tmp_path / "box.stl")
    assert len(table) == 8 and "8 of 50 places: the mesh has no more" in messages
    leaf = trimesh.Trimesh([[2, 0, 0], [3, 0, 0], [2, 1, 0]], [[0, 1, 2], [0, 2, 1]])
    trimesh.util.concatenate([box, leaf]).export(tmp_path / "leaf.ply")
    _, table, _, messages = touched("--at", "random", "--count", 11, source=tmp_path / "leaf.ply")
    assert len(table) == 8 and "8 of 11 places: the others have no normal" in messages


def test_skin_and_depth_change_the_images_and_not_the_distances(touched):
    plain, _, _, _ = touched("--at", 0, 50)
    worn, _, _, _ = touched("--at", 0, 50, "--depth", 0.01, "--skin", "blur=1,noise=0.05,dead=0.1")
    assert np.array_equal(plain["distances"], worn["distances"])
    assert not np.allclose(plain["images"], worn["images"])
    dead = (worn["images"] == 1).all(axis=0)
    assert dead.sum() >= 26


def test_a_load_is_shared_by_the_cells_in_newtons(touched):
    options = "--at", 0, 50, "--load", 0.5, "--unit", "mm", "--layer", "thickness=0.004,modulus=5e5"
    arrays, table, printed, _ = touched(*options)
    assert np.allclose(arrays["forces"].sum(axis=(1, 2)), 0.5) and arrays["forces"].shape == (2, 16, 16)
    area = (0.01 * arrays["unit"] * 0.001) ** 2
    assert np.allclose(table["peak_newtons"], arrays["forces"].max(axis=(1, 2)), rtol=1e-4)
    assert np.allclose(table["indentation_metres"] * Layer(0.004, 5e5).stiffness * area, table["peak_newtons"])
    assert "load: 0.5 N a place" in printed
    plain, _, _, _ = touched("--at", 0, 50)
    assert "forces" not in plain and np.array_equal(plain["images"], arrays["images"])


@pytest.mark.parametrize(("unit", "pitch", "depth"), [("mm", "1mm", "0.05cm"), ("in", "1in", "0.5in")])
def test_lengths_are_those_of_the_object_in_its_unit(touched, file, unit, pitch, depth):
    arrays, _, printed, _ = touched("--at", 0, 50, "--unit", unit, "--pitch", pitch, "--depth", depth)
    assert f"({1:.4g} in the file's units" in printed
    units = 1 / arrays["unit"]
    plain, _, _, _ = touched("--at", 0, 50, "--pitch", units, "--depth", 0.5 * units)
    assert np.allclose(arrays["distances"], plain["distances"], atol=1e-6)
    assert np.allclose(arrays["images"], plain["images"], atol=1e-5)


@pytest.mark.parametrize("count", [1, 25])
@pytest.mark.slow
def test_picture_is_drawn_for_any_number(count, tmp_path, monkeypatch):
    monkeypatch.setattr(pictures, "ROWS", 60)
    mesh = normalise(bumpy())
    vertices = np.random.default_rng(count).choice(len(mesh.vertices), count, replace=False)
    axes = np.stack([user_mesh.sensor_normals(mesh, vertices)] * 3, axis=1)
    images = press_many(mesh, vertices, (6, 6), 0.02)
    write_picture(tmp_path / "a.png", mesh, mesh.vertices[vertices], axes, images, np.ones(count), 0.02)
    write_picture(tmp_path / "b.png", mesh, mesh.vertices[vertices], axes, images, np.ones(count), 0.02)
    assert (tmp_path / "a.png").read_bytes() == (tmp_path / "b.png").read_bytes()
    assert min(Image.open(tmp_path / "a.png").size) > 500


def test_views_show_places_of_both_sides_and_the_fewest_that_do():
    mesh = normalise(bumpy())
    ids = np.array([mesh.vertices[:, 0].argmax(), mesh.vertices[:, 0].argmin()])
    places, normals = mesh.vertices[ids], np.array([[1.0, 0, 0], [-1, 0, 0]])
    views = best_views(mesh, places, normals)
    assert len(views) == 2 and np.any([visible(mesh, places, normals, view) for view in views], axis=0).all()
    assert len(best_views(mesh, places[:1], normals[:1])) == 1
    assert all(view.elevation == CANDIDATES[0].elevation for view in views)


def test_place_behind_another_part_is_out_of_sight():
    box = trimesh.creation.box(extents=(0.2, 0.2, 0.2))
    wall = trimesh.creation.box(extents=(0.02, 0.8, 0.8))
    wall.apply_translation([0.3, 0, 0])
    solid = trimesh.util.concatenate([box, wall])
    mesh = Mesh(solid.vertices, solid.faces)
    place = np.array([[0.1, 0, 0]])
    assert not visible(mesh, place, np.array([[1.0, 0, 0]]), CANDIDATES[2]).any()


@pytest.mark.parametrize(
    "options, words",
    [
        (["--at", "9999"], "ball.ply: --at 9999: no such vertex; the mesh has 0 to 641"),
        (["--at", "120,-40,100"], "off the mesh, by .* in the file's units .* the nearest place is --at 1"),
        (["--at", "random", "--method", "itti"], "--method applies to"),
        (["--at", "salient", "--method", "itty"], "no such method .did you mean itti"),
        (["--at", "0", "--cells", "0", "4"], "cells must be"),
        (["--at", "0", "--pitch", "3"], "--pitch 3 is larger than the object, which is 1 unit across: try 0.01$"),
        (["--at", "0", "--cells", "90000", "90000", "--pitch", "1e-5"], "an array has at most"),
        (["--at", *"01234", "--cells", "4000", "4000", "--pitch", "1e-5"], "5 places: .* cells in all; use fewer"),
        (["--at", "0", "--skin", "blurr=1"], "'blurr' is unknown; write NAME=VALUE with one of blur"),
        (["--at", "0", "--load", "5"], "--load needs --unit, the unit of the file: mm, cm, in, m"),
        (["--at", "0", "--unit", "mm"], "--unit applies to --load, and to a --pitch or --depth such as 1mm"),
        (["--at", "0", "--pitch", "9cm", "--unit", "mm"], "--pitch 90mm is larger .* is --unit mm right"),
        (["--at", "0", "--load", "9e9", "--unit", "mm"], r"ball.ply: --load 9e.09: place 1 needs more than the"),
    ],
)
def test_what_a_person_gets_wrong_is_named_with_its_remedy(options, words, file, tmp_path):
    with pytest.raises(ValueError, match=words):
        run([str(file), *options, "--out", str(tmp_path / "out")])
    assert not (tmp_path / "out").exists()


@pytest.mark.parametrize(
    ("options", "words"),
    [
        (["--pitch", "1mm", "--unit", "m"], "is the unit of length right?"),
        (["--pitch", "0.2"], "is the unit of length right?"),
        (["--load", "1", "--unit", "mm", "--layer", "thickness=3,modulus=1e9"], "m across: is --unit mm right?"),
        (["--load", "1", "--unit", "m", "--layer", "thickness=1e-6"], "m across: is --unit m right?"),
        (["--cells", 40, 4, "--pitch", 0.1], "most cells will miss it"),
        (["--cells", 1, 1, "--pitch", 2], "every imprint is flat"),
    ],
)
def test_sizes_that_tell_of_a_wrong_unit_are_said(options, words, touched):
    assert touched("--at", 0, *options)[-1].count(words) == 1

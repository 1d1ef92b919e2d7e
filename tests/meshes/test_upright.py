"""The axis that points up, chosen by the shape: known objects, laid on another side, told in any way."""

import warnings
from types import SimpleNamespace

import numpy as np
import pytest
import trimesh
from trimesh import creation
from trimesh.transformations import rotation_matrix

from haptic_glance.lod import write_any
from haptic_glance.mesh import as_mesh, load, normalise, rotate_to_z_up
from haptic_glance.mesh.mesh import Mesh
from haptic_glance.mesh.upright import CANDIDATES, MOST, SURE, WEIGHTS, _pieces, features, probable_up
from stages.meshes.collect import prepare_mesh
from stages.meshes.sources import SOURCES

TURNS = {"z": [0, 1, 2], "y": [1, 2, 0]}  # columns of a mesh whose third axis is then that one


def box(size, middle):
    return creation.box(size, trimesh.transformations.translation_matrix(middle))


def joined(*parts):
    return trimesh.util.concatenate(parts)


def legs(height, x, y):
    return [box((0.06, 0.06, height), (a, b, height / 2)) for a in (-x, x) for b in (-y, y)]


def turned_profile(*profile):
    return creation.revolve(np.array(profile), sections=48)


OBJECTS = {
    "table": joined(box((1.2, 0.8, 0.05), (0, 0, 0.7)), *legs(0.7, 0.55, 0.35)),
    "chair": joined(
        box((0.5, 0.5, 0.05), (0, 0, 0.45)), box((0.5, 0.05, 0.55), (0, 0.22, 0.72)), *legs(0.45, 0.22, 0.22)
    ),
    "cup": turned_profile([0, 0], [0.3, 0], [0.4, 0.9], [0.37, 0.9], [0.27, 0.05], [0, 0.05]),
    "bottle": turned_profile([0, 0], [0.2, 0], [0.2, 0.6], [0.06, 0.75], [0.06, 1], [0, 1]),
}


def laid(shape, up="z", **attributes):
    return Mesh(np.asarray(shape.vertices)[:, TURNS[up]], np.asarray(shape.faces), up="auto", **attributes)


@pytest.mark.parametrize("up", TURNS)
@pytest.mark.parametrize("name", OBJECTS)
def test_an_object_that_stands_has_its_axis_and_a_sure_one(name, up):
    axis, probability = probable_up(laid(OBJECTS[name], up))
    assert axis == up and SURE < probability < 1
    assert rotate_to_z_up(laid(OBJECTS[name], up)).vertices[:, 2] == pytest.approx(OBJECTS[name].vertices[:, 2])


def log_odds(mesh):
    found = features(mesh)
    return sum(weight * (found["z"][name] - found["y"][name]) for name, weight in WEIGHTS.items())


def changes(shape):
    vertices, faces = np.asarray(shape.vertices), np.asarray(shape.faces)
    order = np.random.default_rng(0).permutation(len(faces))
    yield "permuted", vertices, faces[order], 0.01
    yield "rolled", vertices, np.roll(faces, 1, axis=1), 0.01
    yield "wound the other way", vertices, faces[:, ::-1], 0.01
    yield "doubled", vertices, np.concatenate([faces, faces[:, ::-1]]), 0.01
    yield "moved and scaled", 30 * vertices + [5, -7, 9], faces, 0.01
    yield "subdivided", *trimesh.remesh.subdivide(vertices, faces), 0.3
    yield "mirrored", vertices * [-1, 1, 1], faces[:, ::-1], 0.1


@pytest.mark.parametrize("name", OBJECTS)
def test_the_choice_belongs_to_the_surface_not_to_its_triangles(name):
    expected = log_odds(laid(OBJECTS[name]))
    for what, vertices, faces, tolerance in changes(OBJECTS[name]):
        assert log_odds(Mesh(vertices, faces)) == pytest.approx(expected, abs=tolerance), what


@pytest.mark.parametrize("angle", [20, 45, 90, 160])
@pytest.mark.parametrize("name", OBJECTS)
def test_the_features_of_an_axis_do_not_change_as_the_object_turns_about_it(name, angle):
    shape = OBJECTS[name].copy()
    expected = features(laid(shape))["z"]
    shape.apply_transform(rotation_matrix(np.radians(angle), [0, 0, 1]))
    found = features(laid(shape))["z"]
    gap = sum(weight * (found[feature] - expected[feature]) for feature, weight in WEIGHTS.items())
    assert abs(gap) < 0.35 and set(found) == set(WEIGHTS)


SHAPELESS = {
    "ball": (creation.icosphere(2).vertices, creation.icosphere(2).faces),
    "cube": (creation.box().vertices, creation.box().faces),
    "no face": (np.eye(3), np.zeros((0, 3), int)),
    "no area": (np.zeros((3, 3)), [[0, 1, 2]]),
    "a line": ([[0, 0, 0], [1, 0, 0], [2, 0, 0]], [[0, 1, 2]]),
    "one face": (np.eye(3), [[0, 1, 2]]),
    "tiny": (1e-30 * np.eye(3), [[0, 1, 2]]),
}


@pytest.mark.parametrize("name", SHAPELESS)
def test_what_has_no_upright_pose_is_z_up_without_a_preference(name):
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        assert probable_up(Mesh(*SHAPELESS[name], up="auto")) == (CANDIDATES[0], 0.5)


def test_a_sheet_lies_flat():
    sheet = [[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]]
    assert probable_up(Mesh(sheet, [[0, 1, 2], [0, 2, 3]]))[0] == "z"
    assert probable_up(Mesh(np.roll(sheet, 2, axis=1), [[0, 1, 2], [0, 2, 3]]))[0] == "y"


def test_a_mesh_in_every_form_has_one_axis(tmp_path):
    shape = OBJECTS["table"].copy()
    shape.vertices = shape.vertices[:, TURNS["y"]]
    for suffix in ("stl", "obj", "ply", "off"):
        shape.export(tmp_path / f"table.{suffix}")
        assert load(tmp_path / f"table.{suffix}").up == as_mesh(tmp_path / f"table.{suffix}").up == "y"
    assert as_mesh(shape).up == as_mesh((shape.vertices, shape.faces)).up == as_mesh(trimesh.Scene(shape)).up == "y"
    assert as_mesh(Mesh(shape.vertices, shape.faces)).up == "z"


@pytest.mark.parametrize("setting", ["auto", "x"])
def test_a_folder_of_the_pipeline_has_what_the_setting_a_file_or_the_shape_says(tmp_path, setting):
    lying = laid(OBJECTS["table"], "y")
    trimesh.Trimesh(lying.vertices, lying.faces, process=False).export(tmp_path / "plain.stl")
    write_any(tmp_path / "stated.ply", Mesh(lying.vertices, lying.faces, up="-y"))
    items = SOURCES["folder"](SimpleNamespace(folder=str(tmp_path), objects=[], up=setting, unit="m"))
    found = {item.name: prepare_mesh(item) for item in items}
    expected = {"plain": "y", "stated": "-y"} if setting == "auto" else {"plain": "x", "stated": "x"}
    assert {name: row["up"] for name, (_, row) in found.items()} == expected
    if setting == "auto":
        own = normalise(rotate_to_z_up(load(tmp_path / "plain.stl"))).vertices
        assert np.ptp(found["plain"][0].vertices, axis=0) == pytest.approx(np.ptp(own, axis=0))


def test_a_tangle_of_large_faces_is_cut_into_as_few_pieces_as_fit():
    corners = np.random.default_rng(0).random((6000, 3))
    assert len(_pieces(corners.reshape(-1, 3, 3))[0]) < 4 * MOST

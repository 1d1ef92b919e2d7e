"""The axis that points up: known from a GLB, guessed from the shape elsewhere, kept through all work on a mesh."""

import warnings
from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pytest
import trimesh
from trimesh import creation
from trimesh.transformations import rotation_matrix

from haptic_glance.lod import simplify, write_any
from haptic_glance.lod.borders import close_borders, cut_borders
from haptic_glance.lod.mesh_pictures import coloured
from haptic_glance.lod.task import SimplificationTask, repaired
from haptic_glance.mesh import as_mesh, clean, load, normalise, rotate_to_z_up
from haptic_glance.mesh.axes import axis_named, to_z_up
from haptic_glance.mesh.materials import bake_texture
from haptic_glance.mesh.mesh import Mesh, Texture
from haptic_glance.mesh.plane import _submesh
from haptic_glance.mesh.repair import orient
from haptic_glance.mesh.up import upright_for
from haptic_glance.mesh.upright import CANDIDATES, MOST, SURE, WEIGHTS, _pieces, features, probable_up
from stages.meshes.collect import prepare_mesh
from stages.meshes.sources import SOURCES

BALL = trimesh.creation.icosphere(2)
PLAIN = Texture(np.zeros((len(BALL.faces), 3, 2)), np.zeros(len(BALL.faces), int), (np.full((1, 1, 4), 255, np.uint8),))
LYING = Mesh(BALL.vertices, BALL.faces[:, ::-1], None, PLAIN, "y")


def _task():
    nothing = np.zeros(0, dtype=np.int64)
    return SimplificationTask(LYING, np.ones(len(LYING.vertices)), nothing, nothing, None, "qslim", False)


@pytest.mark.parametrize(
    "work",
    [
        normalise,
        bake_texture,
        lambda mesh: orient(mesh)[0],
        lambda mesh: clean(mesh)[0],
        lambda mesh: repaired(mesh)[0],
        lambda mesh: _submesh(mesh, np.arange(len(mesh.faces)) > 9),
        lambda mesh: coloured(mesh, mesh.vertices[:, 0] + 1),
        lambda mesh: close_borders(cut_borders(mesh)[0], *cut_borders(mesh)),
        lambda mesh: simplify(mesh, 100, backend="qslim"),
        lambda mesh: simplify(bake_texture(mesh), 100, backend="qslim"),
        lambda mesh: simplify(Mesh(mesh.vertices, mesh.faces, up="y"), 100, backend="qslim"),
        lambda mesh: _task().restored(_task().simplified(100)),
    ],
)
def test_a_mesh_made_of_a_mesh_keeps_it(work):
    assert work(LYING).up == "y"


def test_turned_upright_a_mesh_is_z_up_by_its_own_axis():
    turned = rotate_to_z_up(LYING)
    assert turned.up == "z" and np.array_equal(turned.vertices[:, 2], LYING.vertices[:, 1])
    assert np.array_equal(rotate_to_z_up(LYING, "x").vertices[:, 2], LYING.vertices[:, 0])


ALL = "x, y, z, -x, -y, -z, auto, or a vector of three numbers that is not zero, such as 0,1,1"
NONE = ["w", "", "--y", "0,0,0", "1,2", "1,2,3,4", "nan,0,1", (0, 1), (0, 1, "a"), None, 3, [[0, 0, 1]]]


@pytest.mark.parametrize("up", NONE, ids=str)
def test_what_is_no_axis_is_answered_by_the_axes_there_are(up):
    with pytest.raises(ValueError, match="unknown up axis .*: choose one of") as error:
        Mesh(BALL.vertices, BALL.faces, up=up)
    assert str(error.value).endswith(ALL) and "\n" not in str(error.value)


NAMES = {
    "Y": "y", "+z": "z", " -X ": "-x", "Auto": "auto", (0, 2, 0): "y", (0, 0, -1e-9): "-z", "0,-3,0": "-y",
    (0.6, 0, 0.8): "0.6,0,0.8", "3,0,4": "0.6,0,0.8", (0, 1, 1): "0,0.707107,0.707107", (1e300, 0, 0): "x",
}  # fmt: skip


@pytest.mark.parametrize(("up", "name"), NAMES.items(), ids=str)
def test_an_axis_has_one_name(up, name):
    assert axis_named(up) == name == axis_named(name) == Mesh(BALL.vertices, BALL.faces, up=up).up
    assert axis_named(np.array(up) if isinstance(up, tuple) else up) == name


@pytest.mark.parametrize("up", ["x", "-y", "-z", "0.6,0,0.8", "-0.48,0.6,0.64"])
def test_any_axis_becomes_z_without_a_mirror(up):
    turn = to_z_up(up)
    vector = [float(part) for part in up.split(",")] if "," in up else {"xyz".index(up[-1]): -1 if "-" in up else 1}
    vector = [vector.get(k, 0) for k in range(3)] if isinstance(vector, dict) else vector
    assert turn @ vector == pytest.approx([0, 0, 1], abs=1e-9)
    assert turn @ turn.T == pytest.approx(np.eye(3)) and np.linalg.det(turn) == pytest.approx(1)
    assert rotate_to_z_up(LYING, up) == rotate_to_z_up(LYING, vector) and rotate_to_z_up(LYING, up).up == "z"


def test_a_mesh_is_turned_for_a_glb_alone_and_as_other_programs_turn_it_back():
    standing = Mesh(BALL.vertices, BALL.faces)
    turned, note = upright_for(Path("a.glb"), standing)
    assert turned.up == "y" and note == "a.glb is y up, as every GLB: turned from z up"
    x, y, z = turned.vertices.T
    assert np.array_equal(np.stack([x, -z, y], axis=1), BALL.vertices)  # what Blender makes of a glTF
    assert np.array_equal(
        upright_for(Path("a.glb"), Mesh(BALL.vertices, BALL.faces, up="x"))[0].vertices[:, 1], BALL.vertices[:, 0]
    )
    assert upright_for(Path("a.glb"), LYING) == (LYING, "") and upright_for(Path("a.stl"), LYING) == (LYING, "")


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
    by_axis = features(mesh)
    return sum(weight * (by_axis["z"][name] - by_axis["y"][name]) for name, weight in WEIGHTS.items())


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
@pytest.mark.slow
def test_the_choice_belongs_to_the_surface_not_to_its_triangles(name):
    expected = log_odds(laid(OBJECTS[name]))
    for change, vertices, faces, tolerance in changes(OBJECTS[name]):
        assert log_odds(Mesh(vertices, faces)) == pytest.approx(expected, abs=tolerance), change


@pytest.mark.parametrize("angle", [20, 45])
@pytest.mark.parametrize("name", OBJECTS)
def test_the_features_of_an_axis_do_not_change_as_the_object_turns_about_it(name, angle):
    shape = OBJECTS[name].copy()
    expected = features(laid(shape))["z"]
    shape.apply_transform(rotation_matrix(np.radians(angle), [0, 0, 1]))
    turned = features(laid(shape))["z"]
    gap = sum(weight * (turned[feature] - expected[feature]) for feature, weight in WEIGHTS.items())
    assert abs(gap) < 0.35 and set(turned) == set(WEIGHTS)


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
    prepared = {item.name: prepare_mesh(item) for item in items}
    expected = {"plain": "y", "stated": "-y"} if setting == "auto" else {"plain": "x", "stated": "x"}
    assert {name: row["up"] for name, (_, row) in prepared.items()} == expected
    if setting == "auto":
        upright = normalise(rotate_to_z_up(load(tmp_path / "plain.stl"))).vertices
        assert np.ptp(prepared["plain"][0].vertices, axis=0) == pytest.approx(np.ptp(upright, axis=0))


@pytest.mark.slow
def test_a_tangle_of_large_faces_is_cut_into_as_few_pieces_as_fit():
    corners = np.random.default_rng(0).random((6000, 3))
    assert len(_pieces(corners.reshape(-1, 3, 3))[0]) < 4 * MOST

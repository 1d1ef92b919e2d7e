"""The axis that points up: known from a GLB, guessed elsewhere, kept by whatever makes a mesh of a mesh."""

import argparse
from pathlib import Path

import numpy as np
import pytest
import trimesh

from haptic_glance.lod import simplify
from haptic_glance.lod.borders import close_borders, cut_borders
from haptic_glance.lod.export import write_any
from haptic_glance.lod.pictures import coloured
from haptic_glance.lod.task import SimplificationTask, repaired
from haptic_glance.mesh import clean, load, normalise, rotate_to_z_up
from haptic_glance.mesh.axes import axis_named, to_z_up
from haptic_glance.mesh.files import load_as_stated
from haptic_glance.mesh.materials import bake_texture
from haptic_glance.mesh.mesh import Mesh, Texture
from haptic_glance.mesh.plane import _submesh
from haptic_glance.mesh.repair import orient
from haptic_glance.mesh.up import add_up, upright_by, upright_for

BALL = trimesh.creation.icosphere(2)
PLAIN = Texture(np.zeros((len(BALL.faces), 3, 2)), np.zeros(len(BALL.faces), int), (np.full((1, 1, 4), 255, np.uint8),))
LYING = Mesh(BALL.vertices, BALL.faces[:, ::-1], None, PLAIN, "y")


@pytest.mark.parametrize(("suffix", "up"), [("glb", "y"), ("stl", "z"), ("obj", "z"), ("ply", "z"), ("off", "z")])
def test_a_file_gives_the_axis_of_its_format(tmp_path, suffix, up):
    BALL.export(tmp_path / f"ball.{suffix}")
    assert load(tmp_path / f"ball.{suffix}").up == up


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
NONE = ["w", "", "--y", "0,0,0", "1,2", "1,2,3,4", "nan,0,1", (0, 0, 0), (0, 1), (0, 1, "a"), None, 3, [[0, 0, 1]]]


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


@pytest.mark.parametrize("up", ["x", "y", "z", "-x", "-y", "-z", "0.6,0,0.8", "-0.48,0.6,0.64"])
def test_any_axis_becomes_z_without_a_mirror(up):
    turn = to_z_up(up)
    vector = [float(part) for part in up.split(",")] if "," in up else {"xyz".index(up[-1]): -1 if "-" in up else 1}
    vector = [vector.get(k, 0) for k in range(3)] if isinstance(vector, dict) else vector
    assert turn @ vector == pytest.approx([0, 0, 1], abs=1e-9)
    assert turn @ turn.T == pytest.approx(np.eye(3)) and np.linalg.det(turn) == pytest.approx(1)
    assert rotate_to_z_up(LYING, up) == rotate_to_z_up(LYING, vector) and rotate_to_z_up(LYING, up).up == "z"


def test_a_guess_is_told_from_what_a_file_says():
    cone = trimesh.creation.cone(0.4, 1)
    known, stated = Mesh(cone.vertices, cone.faces, up="auto"), Mesh(cone.vertices, cone.faces, up="-y")
    assert upright_by(LYING, Path("a.glb"), None) == (LYING, "y up, as in every GLB")
    assert upright_by(stated, Path("a.stl"), None) == (stated, "-y up, as the file says")
    sure = "assuming z is up (probability 0.99; STL files do not store it; --up y for the other)"
    assert upright_by(known, Path("a.stl"), None) == (Mesh(cone.vertices, cone.faces), sure)
    assert upright_by(stated, Path("a.stl"), "auto") == (Mesh(cone.vertices, cone.faces), sure)
    ball = Mesh(BALL.vertices, BALL.faces, up="auto")
    hardly = "z is up, but the shape hardly tells (probability 0.50; OBJ files do not store it; say --up z or --up y)"
    assert upright_by(ball, Path("a.obj"), None)[1] == f"assuming {hardly}"
    assert upright_by(known, Path("a.stl"), "x") == (Mesh(cone.vertices, cone.faces, up="x"), "x up")


@pytest.mark.parametrize("suffix", ["stl", "obj", "ply", "off"])
@pytest.mark.parametrize("up", ["z", "-y", "-0.48,0.6,0.64"])
def test_a_file_of_ours_states_its_axis(tmp_path, suffix, up):
    mesh = Mesh(BALL.vertices, BALL.faces, up=up)
    write_any(tmp_path / f"ball.{suffix}", mesh)
    assert load_as_stated(tmp_path / f"ball.{suffix}").up == up
    assert upright_by(load_as_stated(tmp_path / f"ball.{suffix}"), Path(f"a.{suffix}"), None)[1].endswith(
        "the file says"
    )


def command(argv):
    parser = argparse.ArgumentParser("prog")
    add_up(parser)
    parser.add_argument("--count", type=int)
    return parser.parse_args(argv)


@pytest.mark.parametrize("text", ["-y", "-Y", "-0.5,0,1", "0,1,1", "Z", "auto"])
def test_a_command_takes_every_axis(text):
    assert command(["--up", text, "--count", "3"]).up == axis_named(text) == command([f"--up={text}"]).up
    assert command(["--count", "3"]).up is None and command(["--up", text, "--count", "3"]).count == 3


@pytest.mark.parametrize("text", ["w", "0,0,0", "-w"])
def test_a_command_refuses_what_is_no_axis(text, capsys):
    with pytest.raises(SystemExit):
        command([f"--up={text}"])
    assert (
        capsys.readouterr().err.splitlines()[-1]
        == f"prog: error: argument --up: unknown up axis {text!r}: choose one of {ALL}"
    )


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

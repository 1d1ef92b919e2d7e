"""The axis that points up: known from a GLB, guessed elsewhere, kept by whatever makes a mesh of a mesh."""

from pathlib import Path

import numpy as np
import pytest
import trimesh

from stages.kit import Mesh
from stages.kit.texture import Texture
from stages.lod import simplify
from stages.lod.borders import close_borders, cut_borders
from stages.lod.look import coloured
from stages.lod.task import SimplificationTask, repaired
from stages.meshes import clean, load, normalise, rotate_to_z_up
from stages.meshes.colours import bake_texture
from stages.meshes.orient import orient
from stages.meshes.plane import _submesh
from stages.meshes.up import upright_by, upright_for

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


def test_there_are_three_axes():
    with pytest.raises(ValueError, match="up axis 'w'"):
        Mesh(BALL.vertices, BALL.faces, up="w")


def test_a_guess_is_told_from_what_a_file_says():
    flat = Mesh(BALL.vertices, BALL.faces)
    assert upright_by(LYING, Path("a.glb"), None) == (LYING, "y up, as in every GLB")
    assert upright_by(flat, Path("a.stl"), None) == (flat, "z up, a guess, since STL does not say (another axis: --up)")
    assert upright_by(flat, Path("a.stl"), "x")[0].up == "x"


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

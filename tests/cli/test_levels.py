"""`haptic-glance simplify`: several levels from one look, folders, the nodes of a scene, and which axis points up."""

import json

import numpy as np
import pytest
import trimesh

from haptic_glance.cli import simplify
from haptic_glance.cli.simplify import run
from haptic_glance.lod import measures
from haptic_glance.lod.export import level_path, levels, write_any
from haptic_glance.lod.topology import moved_parts, parts_of
from haptic_glance.mesh import load, rotate_to_z_up
from haptic_glance.mesh.mesh import Mesh


def egg(subdivisions=3, at=(0.0, 0.0, 0.0), up="z"):
    ball = trimesh.creation.icosphere(subdivisions)
    return Mesh(ball.vertices * [1, 0.7, 1.4] + at, ball.faces, up=up)


@pytest.fixture(autouse=True)
def small_pictures(monkeypatch):
    monkeypatch.setattr(measures, "SIZE", (60, 80))


@pytest.fixture
def file(tmp_path):
    write_any(tmp_path / "egg.ply", egg())
    return tmp_path / "egg.ply"


@pytest.fixture
def folder(file):
    """A folder with two meshes, of which one cannot be read, and a text."""
    (file.parent / "meshes").mkdir()
    file.rename(file.parent / "meshes/egg.ply")
    (file.parent / "meshes/bad.stl").write_bytes(b"solid")
    (file.parent / "meshes/notes.txt").write_text("no mesh")
    return file.parent / "meshes"


def test_levels_are_counts_or_shares_each_once_and_keep_the_format_where_it_can_be_written(tmp_path):
    assert levels("50%,25%,50.0%") == ["50%", "25%"] and levels(" 300 ,9%,0300") == ["300", "9%"]
    assert level_path(tmp_path, "a", tmp_path / "a.STL", "50%") == tmp_path / "a_50pct.stl"
    assert level_path(tmp_path, "a", tmp_path / "a.xyz", "900") == tmp_path / "a_900.glb"
    assert level_path(tmp_path, "a", tmp_path / "a.stl", "900", "obj") == tmp_path / "a_900.obj"


@pytest.mark.slow
def test_levels_come_from_one_look(file, tmp_path, monkeypatch, capsys):
    looks, look = [], simplify.saliency
    monkeypatch.setattr(simplify, "saliency", lambda *args: looks.append(1) or look(*args))
    assert run([str(file), "--levels", "50%,200,10%", "--out", str(tmp_path / "out")]) == 0
    faces = {path.name: len(load(path).faces) for path in (tmp_path / "out").iterdir()}
    assert faces == {"egg_50pct.ply": 640, "egg_200.ply": 200, "egg_10pct.ply": 128} and len(looks) == 1
    printed = capsys.readouterr().out
    assert printed.splitlines()[1].split() == ["faces", "1,280", "640", "200", "128"] and "QEM" not in printed


@pytest.mark.parametrize(("level", "reason"), [("5000", "the mesh has only 1,280 faces"), ("2", "")])
def test_a_level_that_cannot_be_had_is_named_and_does_not_cost_the_others(file, tmp_path, capsys, level, reason):
    assert run([str(file), "--levels", f"{level},100", "--out", str(tmp_path / "out")]) == 1
    assert [path.name for path in (tmp_path / "out").iterdir()] == ["egg_100.ply"]
    assert f"simplify: no level {level}: {reason}" in capsys.readouterr().err


def test_a_folder_goes_through_at_once_and_what_is_broken_is_named(folder, tmp_path, capsys):
    assert run([str(folder), "--faces", "300", "--format", "glb", "--json", "--out", str(tmp_path / "out")]) == 1
    shown = capsys.readouterr()
    (row,) = json.loads(shown.out)
    assert row["faces"] == 1280 and row["levels"][0]["faces"] == 300 and row["levels"][0]["mean"] > 0
    assert [path.name for path in (tmp_path / "out").iterdir()] == ["egg_300.glb"]
    assert "simplify: " in shown.err and "bad.stl: " in shown.err and "notes" not in shown.err


def test_the_meshes_are_not_written_over(folder, file):
    with pytest.raises(ValueError, match="is the folder of the meshes: name another one"):
        run([str(folder), "--faces", "300", "--out", str(folder)])
    with pytest.raises(ValueError, match="no mesh in this folder"):
        run([str(folder.parent), "--faces", "300", "--out", str(folder.parent / "out")])


def test_faces_go_with_the_closest_face(file):
    low, high = egg(2), egg(2, at=(0, 0, 5.0))
    joined = Mesh(np.r_[low.vertices, high.vertices], np.r_[low.faces, high.faces + len(low.vertices)])
    count = len(low.faces)
    parts = {"low": np.arange(count), "high": np.arange(count, 2 * count), "gone": np.zeros(0, dtype=int)}
    order = np.random.default_rng(0).permutation(2 * count)
    moved = moved_parts(parts, joined, Mesh(joined.vertices, joined.faces[order]))
    assert set(moved) == {"low", "high"} and set(order[moved["low"]]) == set(range(count))
    assert moved_parts({}, joined, joined) == {} == parts_of(file)  # only a GLB has nodes


@pytest.mark.parametrize("reverse", [False, True])
def test_faces_of_parts_that_touch_stay_with_their_part(reverse):
    left, right = (trimesh.creation.box().subdivide().subdivide() for _ in range(2))
    right.apply_translation((1, 0, 0))  # the right side of one is the left side of the other
    whole = trimesh.util.concatenate([right, left] if reverse else [left, right])
    count = len(left.faces)
    parts = {"first": np.arange(count), "second": np.arange(count, 2 * count)}
    order = np.random.default_rng(0).permutation(2 * count)
    mesh = Mesh(np.asarray(whole.vertices), np.asarray(whole.faces))
    moved = moved_parts(parts, mesh, Mesh(mesh.vertices, mesh.faces[order]))
    assert {name: set(order[ids]) for name, ids in moved.items()} == {name: set(ids) for name, ids in parts.items()}


def test_a_thin_sheet_keeps_its_parts_where_its_faces_were_turned():
    sheet = trimesh.creation.box(extents=(1, 1, 0.002)).subdivide().subdivide()
    mesh = Mesh(np.asarray(sheet.vertices), np.asarray(sheet.faces))
    top = mesh.vertices[mesh.faces][..., 2].min(axis=1) > 0
    parts = {"top": np.flatnonzero(top), "rest": np.flatnonzero(~top)}
    moved = moved_parts(parts, mesh, Mesh(mesh.vertices, mesh.faces[:, ::-1]))
    assert set(moved["top"]) == set(parts["top"])


@pytest.mark.parametrize("up", ["z", "y"])
@pytest.mark.slow
def test_a_glb_stands_as_the_format_has_it_and_other_formats_stay(file, tmp_path, capsys, up):
    for out in ("small.glb", "small.stl"):
        run([str(file), "--faces", "300", "--up", up, "--out", str(tmp_path / out)])
    messages, (glb, stl) = capsys.readouterr().err, (load(tmp_path / f"small.{suffix}") for suffix in ("glb", "stl"))
    long = rotate_to_z_up(glb).vertices[:, 2] if up == "z" else glb.vertices[:, 2]
    assert np.ptp(long) == pytest.approx(2.8, rel=0.02) and glb.up == "y"
    assert np.ptp(stl.vertices[:, 2]) == pytest.approx(2.8, rel=0.02)
    assert ("small.glb is y up, as every GLB: turned from z up" in messages) == (up == "z")

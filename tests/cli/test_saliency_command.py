"""`haptic-glance saliency MESH`: the points of one's own mesh, a coloured copy and a picture."""

import json

import numpy as np
import pytest
import trimesh
from PIL import Image

from haptic_glance.cli.saliency import COLUMNS, run
from haptic_glance.lod.pictures import places, visible, write_look
from haptic_glance.look.points import detect, find_points, saliency
from haptic_glance.mesh import load, normalise, rotate_to_z_up
from haptic_glance.mesh.mesh import Mesh

PLACE, SIZE = np.array([120.0, -40.0, 7.0]), 25.0


@pytest.fixture
def egg(tmp_path):
    """The file of an egg with a nose, far from the origin."""
    body = trimesh.creation.icosphere(4)
    x, y, z = body.vertices.T
    body.vertices *= (1 + 0.3 * np.exp(-20 * ((y + 1) ** 2 + (z - 0.3) ** 2 + x**2)))[:, None] * [1, 1, 1.4]
    body.vertices = PLACE + SIZE * body.vertices
    body.export(tmp_path / "egg.ply")
    return tmp_path / "egg.ply"


def test_points_are_printed_in_the_files_coordinates(egg, capsys):
    run([str(egg)])
    head, *lines = capsys.readouterr().out.splitlines()
    rows = np.array([[float(value) for value in line.split(",")] for line in lines])
    mesh = load(egg)
    assert head == ",".join(COLUMNS) and rows[:, 0].tolist() == list(range(1, len(rows) + 1))
    assert set(rows[:, 1]) == set(find_points(mesh)) and (np.diff(rows[:, 5]) <= 0).all()
    assert rows[:, 2:5] == pytest.approx(mesh.vertices[rows[:, 1].astype(int)], rel=1e-6)
    assert np.linalg.norm(rows[0, 2:5] - (PLACE + SIZE * np.array([0, -1.3, 0.55]))) < 0.3 * SIZE  # the nose


def test_a_file_that_cannot_be_read_is_named(tmp_path):
    (tmp_path / "broken.stl").write_bytes(b"solid nothing")
    for given, reason in (("broken.stl", "truncated"), ("nowhere.stl", "no such file"), ("", "is a folder")):
        with pytest.raises(ValueError, match=f"^{tmp_path / given}: {reason}"):
            run([str(tmp_path / given)])


def test_one_look_gives_what_the_two_functions_give(egg):
    mesh = load(egg)
    found = detect(mesh, count=4)
    assert found.points.tolist() == find_points(mesh, count=4).tolist() and len(found.points) == 4
    assert (found.saliency == saliency(mesh)).all()


def test_json_holds_the_same_and_files_are_written_as_asked(egg, capsys, tmp_path):
    out, points, picture = (tmp_path / name for name in ("look.ply", "points.csv", "look.png"))
    run([str(egg), "--count", "3", "--json", "--out", str(out), "--points", str(points), "--picture", str(picture)])
    shown = capsys.readouterr()
    rows = json.loads(shown.out)
    assert [list(row) for row in rows] == [list(COLUMNS)] * 3 and "written" in shown.err
    lines = points.read_text().splitlines()
    assert len(lines) == 4 and lines[1].startswith(f"1,{rows[0]['vertex']},")
    given, coloured = load(egg), load(out)
    assert coloured.vertices == pytest.approx(given.vertices, rel=1e-6)
    values = saliency(given)
    bright, dark = coloured.colors[values.argmax()], coloured.colors[values.argmin()]
    assert bright[0] > 200 > dark[0]  # viridis: yellow, violet
    assert np.asarray(Image.open(picture)).std() > 10
    said = shown.err.splitlines()
    assert said[:2] == ["saliency: reading egg.ply", "saliency: looking at it"]
    out.unlink()
    run([str(egg), "--count", "3", "--out", str(out), "--points", str(points)])
    assert capsys.readouterr().err.endswith(f"saliency: written: {out}; replaced: {points}\n")


def test_points_behind_the_picture_are_counted(egg, capsys):
    run([str(egg), "--count", "12", "--picture", str(egg.with_suffix(".png")), "--json"])
    shown = capsys.readouterr()
    mesh = load(egg)
    seen = visible(normalise(rotate_to_z_up(mesh)), [row["vertex"] for row in json.loads(shown.out)])
    assert 0 < seen.sum() < 12 and f"{(~seen).sum()} of 12 points are behind" in shown.err


@pytest.mark.parametrize(
    ("options", "reason"),
    [
        (["--out", "x.stl"], r"--out x.stl: a coloured mesh is written as \.glb"),
        (["--out", "missing/x.ply"], "no such folder"),
        (["--picture", "x.txt"], "pictures are written as"),
        (["--count", "0"], "give 1 or more"),
        (["--method", "guess"], "there is no such method; choose one of glance, "),
        (["--method", "farthest"], "it has no saliency; choose one of glance, "),
    ],
)
def test_what_cannot_be_done_is_named_before_anything_is_computed(egg, options, reason):
    with pytest.raises(ValueError, match=reason):
        run([str(egg), *options])


@pytest.mark.parametrize(("suffix", "up"), [("glb", "y"), ("ply", "z")])
def test_the_command_and_the_function_take_the_same_axis_for_up(egg, capsys, suffix, up):
    file = egg.with_suffix(f".{suffix}")
    trimesh.load(egg, process=False).export(file)
    run([str(file), "--count", "5"])
    shown = capsys.readouterr()
    found = [int(line.split(",")[1]) for line in shown.out.splitlines()[1:]]
    assert set(found) == set(find_points(load(file), count=5)) == set(find_points(load(file), count=5, up=up))
    told = "y up, as in every GLB" if suffix == "glb" else "assuming z is up"
    assert told in shown.err and ("--up y" in shown.err) == (suffix == "ply")


def test_a_picture_shows_the_mesh_upright_and_names_the_axis(egg, tmp_path):
    mesh = load(egg)
    shown = {}
    for up, columns in (("z", [0, 1, 2]), ("y", [1, 2, 0])):
        write_look(tmp_path / "look.png", Mesh(mesh.vertices[:, columns], mesh.faces, up=up), mesh.vertices[:, 2], [0])
        shown[up] = np.asarray(Image.open(tmp_path / "look.png")).astype(int)
    differ = np.argwhere(shown["z"] != shown["y"])
    assert len(differ) and (differ[:, 0] > 500).all() and (differ[:, 1] < 60).all()  # the letter alone


def test_the_numbers_of_the_picture_are_the_ranks_of_the_points(egg, tmp_path, capsys, monkeypatch):
    marked = {}
    monkeypatch.setattr("haptic_glance.lod.pictures.mark", lambda image, x, y, text: marked.update({text: (x, y)}))
    run([str(egg), "--picture", str(tmp_path / "look.png"), "--count", "8", "--json"])
    ids = [row["vertex"] for row in json.loads(capsys.readouterr().out)]
    rows, columns = places(normalise(load(egg)), np.array(ids))
    expected = {str(rank): (round(x), round(y)) for rank, (x, y) in enumerate(zip(columns, rows, strict=True), 1)}
    assert 2 <= len(marked) < 8 and marked.items() <= expected.items()


def test_the_mesh_itself_is_not_overwritten(egg):
    before = egg.read_bytes()
    with pytest.raises(ValueError, match="is the mesh itself"):
        run([str(egg), "--out", str(egg)])
    assert egg.read_bytes() == before

"""`haptic-glance saliency MESH` and `points MESH`: the points of one's own mesh, a coloured copy and a picture."""

import json
import os
import warnings

import numpy as np
import pytest
import trimesh
from PIL import Image

from haptic_glance.cli import points
from haptic_glance.cli.saliency import COLUMNS, as_csv, finely, run
from haptic_glance.lod.mesh_pictures import places, visible
from haptic_glance.look.points import find_points, saliency
from haptic_glance.mesh import load, normalise
from haptic_glance.mesh.mesh import Mesh

from .conftest import PLACE, SIZE


@pytest.fixture
def egg(tmp_path):
    """The file of an egg with a nose, far from the origin."""
    body = trimesh.creation.icosphere(4)
    x, y, z = body.vertices.T
    body.vertices *= (1 + 0.3 * np.exp(-20 * ((y + 1) ** 2 + (z - 0.3) ** 2 + x**2)))[:, None] * [1, 1, 1.4]
    body.vertices = PLACE + SIZE * body.vertices
    body.export(tmp_path / "egg.ply")
    return tmp_path / "egg.ply"


@pytest.mark.slow
def test_points_are_printed_in_the_files_coordinates(egg, capsys):
    run([str(egg)])
    shown = capsys.readouterr()
    head, *lines = shown.out.splitlines()
    rows = np.array([[float(value) for value in line.split(",")] for line in lines])
    mesh = load(egg)
    assert head == ",".join(COLUMNS) and rows[:, 0].tolist() == list(range(1, len(rows) + 1))
    assert set(rows[:, 1]) == set(find_points(mesh)) and (np.diff(rows[:, 5]) <= 0).all()
    assert rows[:, 2:5] == pytest.approx(mesh.vertices[rows[:, 1].astype(int)], rel=1e-6)
    assert np.linalg.norm(rows[0, 2:5] - (PLACE + SIZE * np.array([0, -1.3, 0.55]))) < 0.3 * SIZE  # the nose
    points.run([str(egg)])
    same = capsys.readouterr()
    assert same.out == shown.out and same.err.startswith("points: reading egg.ply\npoints: looking at it\n")


@pytest.mark.slow
def test_json_holds_the_same_and_files_are_written_as_asked(egg, capsys, tmp_path):
    out, table, picture = (tmp_path / name for name in ("look.ply", "points.csv", "look.png"))
    run([str(egg), "--count", "3", "--json", "--out", str(out), "--points", str(table), "--picture", str(picture)])
    shown = capsys.readouterr()
    rows = json.loads(shown.out)
    assert [list(row) for row in rows] == [list(COLUMNS)] * 3 and "written" in shown.err
    lines = table.read_text().splitlines()
    assert len(lines) == 4 and lines[1].startswith(f"1,{rows[0]['vertex']},")
    plain, coloured = load(egg), load(out)
    assert coloured.vertices == pytest.approx(plain.vertices, rel=1e-6)
    values = saliency(plain)
    bright, dark = coloured.colors[values.argmax()], coloured.colors[values.argmin()]
    assert bright[0] > 200 > dark[0]  # viridis: yellow, violet
    assert np.asarray(Image.open(picture)).std() > 10
    out.unlink()
    run([str(egg), "--count", "3", "--out", str(out), "--points", str(table)])
    assert capsys.readouterr().err.endswith(f"saliency: written: {out}; replaced: {table}\n")
    table.unlink()
    points.run([str(egg), "--count", "3", "--out", str(table)])
    assert table.read_text().splitlines() == lines


@pytest.mark.slow
def test_places_to_touch_are_those_of_the_method(egg, capsys):
    shown = []
    for options in (["--purpose", "touch"], ["--method", "touch"], []):
        points.run([str(egg), "--count", "3", *options])
        shown.append(capsys.readouterr().out)
    assert shown[0] == shown[1] != shown[2]
    with pytest.raises(ValueError, match="'touch' chooses the method: leave out method 'itti'"):
        points.run([str(egg), "--purpose", "touch", "--method", "itti"])
    for wrong in (["--purpose", "lick"], ["--picture", "look.png"]):
        with pytest.raises(SystemExit):
            points.run([str(egg), *wrong])


@pytest.mark.parametrize(
    ("options", "reason"),
    [
        (["--out", "x.stl"], r"--out x.stl: a coloured mesh is written as \.glb"),
        (["--out", f"{__file__}/x.ply"], "is a file: name a folder"),
        (["--picture", "x.txt"], "pictures are written as"),
        (["--count", "0"], "give 1 or more"),
        (["--method", "guess"], "there is no such method; choose one of glance, "),
        (["--method", "farthest"], "it has no saliency; choose one of glance, "),
    ],
)
def test_what_cannot_be_done_is_named_before_anything_is_computed(egg, options, reason):
    with pytest.raises(ValueError, match=reason):
        run([str(egg), *options])


def test_a_file_that_cannot_be_read_is_named_and_the_mesh_is_not_overwritten(egg, tmp_path):
    (tmp_path / "broken.stl").write_bytes(b"solid nothing")
    for plain, reason in (("broken.stl", "truncated"), ("nowhere.stl", "no such file"), ("", "is a folder")):
        with pytest.raises(ValueError, match=f"^{tmp_path / plain}: {reason}"):
            run([str(tmp_path / plain)])
    before = egg.read_bytes()
    with pytest.raises(ValueError, match="is the mesh itself"):
        run([str(egg), "--out", str(egg)])
    assert egg.read_bytes() == before
    path = str(tmp_path / "both.ply")
    with pytest.raises(ValueError, match=f"{path} is named for two results"):
        run([str(egg), "--out", path, "--weights", os.path.relpath(path)])


@pytest.mark.slow
def test_the_picture_has_the_ranks_of_the_visible_points_and_the_others_are_counted(egg, capsys, monkeypatch):
    marked = {}
    monkeypatch.setattr("haptic_glance.lod.mesh_pictures.mark", lambda image, x, y, text: marked.update({text: (x, y)}))
    run([str(egg), "--picture", str(egg.with_suffix(".png")), "--count", "8", "--json"])
    shown = capsys.readouterr()
    ids = [row["vertex"] for row in json.loads(shown.out)]
    mesh = normalise(load(egg))
    rows, columns = places(mesh, np.array(ids))
    expected = {str(rank): (round(x), round(y)) for rank, (x, y) in enumerate(zip(columns, rows, strict=True), 1)}
    assert 2 <= len(marked) < 8 and marked.items() <= expected.items()
    seen = visible(mesh, ids)
    assert 0 < seen.sum() == len(marked) and f"{(~seen).sum()} of 8 points are behind" in shown.err


@pytest.mark.parametrize("without_area", [[], [[1, 4, 1]], [[4, 1, 1]], [[4, 4, 4]]])
def test_the_finer_copy_of_long_faces_keeps_the_colours_that_a_method_sees(without_area):
    box = trimesh.creation.box()
    box.faces = np.concatenate([box.faces, np.reshape(without_area, (-1, 3)).astype(int)])
    colors = np.where(box.vertices[:, [0, 0, 0]] > 0, [250, 0, 0], [0, 0, 50]).astype(np.uint8)
    with warnings.catch_warnings(action="error"):
        fine, values = finely(Mesh(box.vertices, box.faces, colors), np.zeros(8), "height")
    share = fine.vertices[:, :1] + 0.5  # from one side of the box to the other
    expected = share * [250, 0, 0] + (1 - share) * [0, 0, 50]
    assert len(values) == len(fine.vertices) > 1000 and np.abs(fine.colors - expected).max() <= 0.5 + 1e-9


def test_positions_far_from_the_origin_are_written_in_full():
    place = np.array([450_000.049522, 5_400_000.031487, 100.009657])  # metres of a map, of an object of ten centimetres
    ball = trimesh.creation.icosphere(2, radius=0.05)
    line = as_csv([(1, 7, *place, 0.5)], Mesh(ball.vertices + place, ball.faces)).splitlines()[1]
    assert np.array(line.split(",")[2:5], dtype=float) == pytest.approx(place, abs=1e-7)
    assert as_csv([(1, 7, 0.1, 1 / 3, 2, 0.5)], Mesh(ball.vertices, ball.faces)).endswith("1,7,0.1,0.333333333,2,0.5")

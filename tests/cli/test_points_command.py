"""`haptic-glance points MESH`: the points of `haptic-glance saliency`, and nothing else."""

import json

import pytest
import trimesh

from haptic_glance.cli import points, saliency


@pytest.fixture
def pear(tmp_path):
    body = trimesh.creation.icosphere(3)
    body.vertices[:, 2] *= 1 + 0.4 * (body.vertices[:, 2] > 0)
    body.export(tmp_path / "pear.ply")
    return tmp_path / "pear.ply"


@pytest.mark.slow
def test_points_are_those_of_the_saliency(pear, capsys):
    shown = []
    for work in (points.run, saliency.run):
        work([str(pear), "--count", "3"])
        shown.append(capsys.readouterr())
    assert shown[0].out == shown[1].out and len(shown[0].out.splitlines()) == 4
    assert shown[0].err.startswith("points: reading pear.ply\npoints: looking at it\npoints: 1,280 faces")


@pytest.mark.slow
def test_they_are_written_where_asked(pear, capsys):
    points.run([str(pear), "--count", "2", "--json", "--out", str(pear.with_suffix(".csv"))])
    first = json.loads(capsys.readouterr().out)[0]
    assert pear.with_suffix(".csv").read_text().splitlines()[1].startswith(f"1,{first['vertex']},")


@pytest.mark.slow
def test_places_to_touch_are_those_of_the_method(pear, capsys):
    shown = []
    for options in (["--purpose", "touch"], ["--method", "touch"], []):
        points.run([str(pear), "--count", "3", *options])
        shown.append(capsys.readouterr().out)
    assert shown[0] == shown[1] != shown[2]
    with pytest.raises(ValueError, match="'touch' chooses the method: leave out method 'itti'"):
        points.run([str(pear), "--purpose", "touch", "--method", "itti"])
    with pytest.raises(SystemExit):
        points.run([str(pear), "--purpose", "lick"])
    assert "look, touch" in capsys.readouterr().err.replace("'", "")


def test_it_writes_no_mesh(pear, capsys):
    with pytest.raises(SystemExit):
        points.run([str(pear), "--picture", "look.png"])

"""The stage on small meshes of a person's own: what is found, what is refused and why, in the order asked for."""

import os
import subprocess
import sys
from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pytest
import trimesh
import yaml

from stages.classes import read_classes, read_object
from stages.classes.__main__ import check
from stages.classes.one_object import items, process
from stages.kit.fetch import FetchError
from stages.kit.files import read_json, read_table
from stages.meshes import MeshError
from stages.salient_points import find_points

ROOT = Path(__file__).parents[2]
NAMES = {"zylinder": ["rod", "tin"], "ball": ["small", "egg"]}


@pytest.fixture
def mine(tmp_path):
    (tmp_path / "mine").mkdir()
    trimesh.creation.cylinder(0.1, 2, sections=12).export(tmp_path / "mine/rod.stl")
    trimesh.creation.cylinder(1, 1, sections=12).export(tmp_path / "mine/tin.stl")
    trimesh.creation.icosphere(2).export(tmp_path / "mine/small.ply")
    egg = trimesh.creation.icosphere(2)
    egg.apply_scale((1, 1, 2))
    egg.export(tmp_path / "mine/egg.ply")
    (tmp_path / "mine/broken.obj").write_bytes(b"\0")
    return tmp_path


def settings(**changed):
    base = {"source": "folder", "folder": "mine", "up": "x", "names": NAMES, "methods": ["random", "heat_kernel"]}
    return base | {"count": 5} | changed


@pytest.fixture
def run(mine):
    def start(**changed):
        values = {"profile": "smoke", "seed": 0, "parallel": {"backend": "sequential", "workers": 1}}
        (mine / "params.yaml").write_text(yaml.safe_dump(values | {"classes": settings(**changed)}, sort_keys=False))
        environment = {**os.environ, "PYTHONPATH": str(ROOT)}
        command = [sys.executable, "-m", "stages.classes"]
        done = subprocess.run(command, cwd=mine, env=environment, capture_output=True, text=True)
        assert "Traceback" not in done.stderr, done.stderr
        return done

    return start


def test_every_object_has_a_mesh_and_points_in_the_order_asked_for(run, mine):
    done = run()
    assert done.returncode == 0 and "2 classes, 4 objects, 40 points, 0 refused" in done.stdout
    assert list(read_classes(mine / "data/classes").items()) == list(NAMES.items())
    table = read_table(mine / "data/classes/classes.csv").set_index("object")
    assert table.file["rod"] == "rod.stl" and table.watertight.all() and table["class"]["egg"] == "ball"
    for name, row in table.iterrows():
        mesh, points = read_object(mine / f"data/classes/{name}.npz")
        assert len(mesh.faces) == row.faces and list(points) == ["random", "heat_kernel"]
        assert np.linalg.norm(mesh.vertices, axis=1).max() == pytest.approx(0.5)
        for ids in points.values():
            assert len(ids) == len(set(ids)) == 5 and set(ids) <= set(range(len(mesh.vertices)))
    egg = read_object(mine / "data/classes/egg.npz")[0]
    assert np.ptp(egg.vertices, axis=0).argmax() == 1  # x is up, so z turns to y
    rows = read_table(mine / "reports/measurements/classes.csv")
    assert set(rows.dataset) == {"folder"} and (rows[rows.metric == "points"].value == 5).all()
    assert read_json(mine / "reports/metrics/classes.json") == {
        "classes": 2, "objects": 4, "points": 40, "refused": 0
    }  # fmt: skip


def test_two_runs_write_the_same_bytes(run, mine):
    run()
    first = {path.name: path.read_bytes() for path in (mine / "data/classes").iterdir()}
    run()
    assert first == {path.name: path.read_bytes() for path in (mine / "data/classes").iterdir()}


def test_a_refused_and_an_unknown_object_are_named_and_the_class_goes_on(run, mine):
    done = run(names={"ball": ["small", "eg", "egg"], "rest": ["tin", "broken"]})
    assert done.returncode == 0 and "refused broken: the file holds no geometry" in done.stderr
    assert read_classes(mine / "data/classes") == {"ball": ["small", "egg"], "rest": ["tin"]}
    refused = read_table(mine / "data/classes/refused.csv").set_index("object")
    assert refused.reason["eg"] == "folder has no such object, but egg" and refused["class"]["broken"] == "rest"
    rows = read_table(mine / "reports/measurements/classes.csv")
    notes = rows[rows.note.notna()].set_index("class")
    assert notes.note["rest"].tolist() == [
        "the file holds no geometry", "class rest has 1 of its 2 objects: none of it can be held out",
    ]  # fmt: skip
    assert read_json(mine / "reports/metrics/classes.json")["refused"] == 2


def test_a_class_without_objects_is_not_read_back_but_noted(run, mine):
    run(names={"ball": ["small", "egg"], "ghost": ["nobody", "broken"]})
    assert list(read_classes(mine / "data/classes")) == ["ball"]
    rows = read_table(mine / "reports/measurements/classes.csv").set_index("class")
    assert rows.note["ghost"].tolist()[-1].startswith("class ghost has 0 of its 2 objects")


def test_nothing_left_is_an_error(run, mine):
    done = run(names={"ghost": ["broken"]})
    assert done.returncode == 1 and "every object was refused" in done.stderr
    assert not (mine / "data/classes").exists()


def test_an_absent_source_names_the_setting():
    with pytest.raises(MeshError, match="classes.folder='yours' is no folder"):
        items(SimpleNamespace(**settings(folder="yours")))
    with pytest.raises(FetchError, match="classes.folder='x.zip' holds no princeton data.* classes=household"):
        items(SimpleNamespace(**settings(source="princeton", folder="x.zip")))


@pytest.mark.parametrize(
    ("changed", "reason"),
    [
        ({"source": "ikea"}, "classes.source='ikea' is not known: household, furniture"),
        ({"names": {}}, "at least one class"),
        ({"names": {"ball": []}}, "every class at least one object"),
        ({"names": {"a": ["egg"], "b": ["egg"]}}, "egg named twice"),
        ({"methods": []}, "methods name at least one"),
        ({"methods": ["enhance"]}, "unknown method 'enhance'"),
        ({"methods": ["svm"]}, "svm must learn from this data first"),
        ({"count": 0}, "count must be 1 or more"),
    ],
)
def test_a_bad_setting_is_named(changed, reason):
    with pytest.raises(ValueError, match=reason):
        check(SimpleNamespace(**settings(**changed)))


def test_one_look_serves_all_detectors_and_finds_what_each_finds_alone(mine):
    chosen = SimpleNamespace(**settings(folder=str(mine / "mine"), methods=["spectral_residual", "random"], up="z"))
    rows = process("egg", mine, chosen, seed=4)
    mesh, points = read_object(mine / "egg.npz")
    assert [row.get("method") for row in rows] == [None, "spectral_residual", "random"]
    np.testing.assert_array_equal(points["random"], find_points(mesh, "random", 5, seed=4, name="egg"))
    np.testing.assert_array_equal(points["spectral_residual"], find_points(mesh, "spectral_residual", 5))

"""The stage's cells: nothing is dropped without a word, and the summary is paired."""

import dataclasses

import numpy as np
import pytest
import trimesh

from stages.kit import Mesh
from stages.kit.files import read_mesh
from stages.lod import take_pictures
from stages.lod.cell import Subject, measure_cells
from stages.lod.schema import Params
from stages.lod.summary import summarise
from stages.lod.targets import face_count, file_name
from stages.views import viewpoint_set

SETTINGS = Params(
    methods=["qem", "enhanced", "itti"], targets=["50%", "10%", "4000"], rings=3, backend="pymeshlab", samples=500,
    viewpoints="four", size=[48, 64],
)  # fmt: skip


@pytest.fixture(scope="module")
def subject():
    ball = trimesh.creation.icosphere(subdivisions=3, radius=0.5)
    mesh = Mesh(ball.vertices, ball.faces)
    pictures = take_pictures(mesh, viewpoint_set("four"), (48, 64))
    return Subject("ball", mesh, {"enhanced": np.array([0, 300])}, pictures)


@pytest.fixture(scope="module")
def rows(subject, tmp_path_factory):
    folder = tmp_path_factory.mktemp("lod")
    return folder, [row for method in SETTINGS.methods for row in measure_cells(subject, method, folder, SETTINGS, 0)]


def cell(rows, method, target):
    return {row["metric"]: row for row in rows if (row["method"], row["target"]) == (method, target)}


def test_a_feasible_cell_has_its_mesh_and_all_metrics(rows):
    folder, rows = rows
    found = cell(rows, "enhanced", "50%")
    assert set(found) == {"faces", "metro_mean", "metro_rms", "metro_max", "ssim_error"}
    mesh = read_mesh(folder / "ball" / "enhanced_50pct.npz")
    assert len(mesh.faces) == found["faces"]["value"] == found["ssim_error"]["faces"] <= 640
    assert all(row["value"] > 0 and row["seconds"] > 0 and row["points"] == 2 for row in found.values())


def test_an_infeasible_cell_says_so_and_names_the_smallest_count(rows):
    folder, rows = rows
    found = cell(rows, "enhanced", "10%")["faces"]
    assert found["value"] is None and found["infeasible"]
    assert found["smallest_feasible"] > 128 and str(found["smallest_feasible"]) in found["note"]
    assert not (folder / "ball" / "enhanced_10pct.npz").exists()


def test_a_target_above_the_mesh_and_a_missing_method_leave_a_note(rows):
    rows = rows[1]
    assert cell(rows, "qem", "4000")["faces"]["note"] == "the object has only 1280 faces"
    assert "salient_points" in cell(rows, "itti", "50%")["faces"]["note"]


def test_every_cell_has_a_row(rows):
    cells = {(row["method"], row["target"]) for row in rows[1] if row["metric"] == "faces"}
    assert cells == {(method, target) for method in SETTINGS.methods for target in SETTINGS.targets}


def test_a_failing_backend_becomes_a_note(subject, tmp_path, monkeypatch):
    def broken(*_):
        raise RuntimeError("no\nluck")

    monkeypatch.setattr("stages.lod.cell.simplify", broken)
    rows = measure_cells(subject, "qem", tmp_path, dataclasses.replace(SETTINGS, targets=["50%"]), 0)
    assert [row["note"] for row in rows] == ["no luck"]


def test_summary_compares_only_cells_that_all_methods_reach():
    def row(method, target, metric, value, infeasible=False):
        return {"object": "a", "method": method, "target": target, "metric": metric, "value": value,
                "infeasible": infeasible}  # fmt: skip

    rows = []
    for method, values in (("qem", (1.0, 9.0)), ("itti", (2.0, None))):
        for target, value in zip(("50%", "10%"), values, strict=True):
            rows.append(row(method, target, "faces", value and 100, value is None))
            if value is not None:
                rows += [row(method, target, "metro_mean", value), row(method, target, "ssim_error", value / 10)]
    found = summarise(rows)
    assert (found["metro_mean_qem"], found["metro_mean_itti"], found["paired_cells"]) == (1.0, 2.0, 1)
    assert (found["share_infeasible"], found["infeasible_itti"], found["meshes"]) == (0.25, 0.5, 3)


@pytest.mark.parametrize(("target", "count"), [("50%", 500), ("12.5%", 125), ("1500", 1500), ("0.01%", 1)])
def test_targets_mean_face_counts(target, count):
    assert face_count(target, 1000) == count


@pytest.mark.parametrize("target", ["", "half", "-5", "0", "0%", "100%", "120%", "1.5k"])
def test_bad_targets_are_named(target):
    with pytest.raises(ValueError, match=r"lod\.targets"):
        face_count(target, 1000)


def test_file_names_hold_no_percent_sign():
    assert file_name("enhanced", "25%") == "enhanced_25pct.npz"

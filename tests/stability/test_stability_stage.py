"""The stage on one small object, and what the report makes of it."""

import dataclasses

import numpy as np
import pandas as pd
import pytest
import trimesh

from stages.kit import Mesh
from stages.kit.files import read_arrays, sha256, write_mesh, write_table
from stages.meshes import normalise
from stages.report.figures import stability as chart
from stages.report.figures import stability_failures as failures
from stages.report.results import NotRun, Results
from stages.report.style import label
from stages.report.style import look as drawn
from stages.report.tables import stability as table
from stages.stability.__main__ import check, chosen, process
from stages.stability.schema import Params
from stages.stability.summary import summarise
from stages.weights.table import weight_table

METHODS = ["itti", "harris", "random"]
SEVERITIES = {"vertex_order": [1.0], "noise": [0.001, 0.02], "light": [60.0], "missing_faces": [0.9, 1.0]}
SETTINGS = Params(
    broken=[],
    objects=["pear"], most=1, methods=METHODS, count=8, size=[120, 160], perturbations=list(SEVERITIES),
    severities=SEVERITIES,
)  # fmt: skip


@pytest.fixture(scope="module")
def run(tmp_path_factory):
    """(root, rows): the stage run on a bumpy ball, its file, and its rows as measurements."""
    root = tmp_path_factory.mktemp("stability")
    ball = trimesh.creation.icosphere(subdivisions=3)
    tops = trimesh.util.unitize(np.array([[1.0, 0.2, 0.1], [-0.3, 1, 0.4], [0.1, -0.6, -1]]))
    height = np.exp(-(2 - 2 * ball.vertices @ tops.T) / (2 * np.array([0.2, 0.25, 0.3]) ** 2)) @ [0.5, 0.4, 0.6]
    mesh = normalise(Mesh(ball.vertices * (1 + height[:, None]), ball.faces))
    with pytest.MonkeyPatch.context() as patch:
        patch.chdir(root)
        write_mesh("data/meshes/pear.npz", mesh)
        write_table("data/weights/weights.csv", weight_table({}, "gaze"))
        rows = process("pear", root / "data/stability", SETTINGS, 0)
        process("pear", root / "again", SETTINGS, 0)
    frame = pd.DataFrame(rows).assign(dataset="test", seed=0)
    write_table(root / "reports/measurements/stability.csv", frame)
    return root, rows


def value(rows, method, perturbation, severity, metric):
    found = [
        row["value"]
        for row in rows
        if (row["method"], row["perturbation"], row["severity"], row["metric"])
        == (method, perturbation, severity, metric)
    ]
    assert len(found) == 1
    return found[0]


def test_a_shuffled_mesh_gives_the_same_points_and_map(run):
    for method in ("itti", "harris"):
        assert value(run[1], method, "vertex_order", 1.0, "repeatability") == 1
        assert value(run[1], method, "vertex_order", 1.0, "drift") < 1e-3


def test_heavy_noise_costs_more_than_light_noise(run):
    for method in ("itti", "harris"):
        light, heavy = (value(run[1], method, "noise", s, "repeatability") for s in (0.001, 0.02))
        assert light > heavy
        assert value(run[1], method, "noise", 0.001, "drift") < value(run[1], method, "noise", 0.02, "drift")


def test_light_is_nothing_to_who_does_not_look(run):
    assert value(run[1], "harris", "light", 60.0, "repeatability") == 1
    assert value(run[1], "itti", "light", 60.0, "repeatability") < 1


def test_random_points_are_at_the_level_of_chance(run):
    """Drawn anew for each case, they are not found again although the object is the same."""
    rows = [row for row in run[1] if row["method"] == "random" and row["value"] is not None]
    mean = {m: np.mean([row["value"] for row in rows if row["metric"] == m]) for m in ("repeatability", "chance")}
    assert mean["repeatability"] < 0.25 and mean["repeatability"] == pytest.approx(mean["chance"], abs=0.12)
    assert not any(row["metric"] == "drift" for row in rows)


def test_what_cannot_be_done_is_a_row_that_says_why(run):
    rows = [row for row in run[1] if row["perturbation"] == "missing_faces" and row["severity"] == 1.0]
    assert [row["method"] for row in rows] == METHODS
    assert all(row["value"] is None and "no surface" in row["note"] for row in rows)


def test_rows_are_complete(run):
    plain = [row for row in run[1] if row["perturbation"] == "none"]
    assert [(row["method"], row["metric"]) for row in plain] == [(method, "points") for method in METHODS]
    measured = {(row["perturbation"], row["severity"]) for row in run[1] if row["metric"] == "chance"}
    assert measured == {(name, s) for name, all_of in SEVERITIES.items() for s in all_of} - {("missing_faces", 1.0)}
    assert all(row["seconds"] > 0 for row in run[1] if row["value"] is not None)


def test_files_hold_the_worst_case_and_are_the_same_twice(run):
    root, _ = run
    stored = read_arrays(root / "data/stability/pear.npz")
    assert {key.rpartition(".")[0] for key in stored} == {"itti", "harris"}
    assert stored["itti.after_points"].max() < len(stored["itti.vertices"]) == len(stored["itti.after_saliency"])
    assert float(stored["harris.repeatability"]) < 1
    assert sha256(root / "data/stability/pear.npz") == sha256(root / "again/pear.npz")


def test_the_gate_gets_a_number_for_every_perturbation_and_method(run):
    found = summarise(run[1])
    keys = {f"{name}.{method}" for name in SEVERITIES for method in METHODS}
    assert set(found["repeatability"]) == set(found["breaking_point"]) == keys
    assert found["breaking_point"]["vertex_order.itti"] is None and found["breaking_point"]["noise.itti"] > 0


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"perturbations": ["rain"]}, "rain.*noise"),
        ({"perturbations": []}, "empty"),
        ({"perturbations": ["tilt"]}, "none for tilt"),
        ({"severities": {"rain": [1.0]}}, "rain"),
        ({"methods": ["sight"]}, "unknown method"),
        ({"methods": []}, "empty"),
        ({"count": 0}, "count"),
    ],
)
def test_mistaken_settings_are_named(change, message):
    with pytest.raises(ValueError, match=message):
        check(dataclasses.replace(SETTINGS, **change))


def test_objects_are_the_wanted_ones_or_else_the_first():
    settings = dataclasses.replace(SETTINGS, objects=["cup", "hand"], most=2)
    assert chosen(settings, ["ant", "cup", "hand"]) == ["cup", "hand"]
    assert chosen(settings, ["ant", "bee", "cat"]) == ["ant", "bee"]


def test_report_shows_the_table_and_the_pictures(run):
    results = Results(None, run[0])
    built = table.build(results)
    shown = built.shown.set_index("perturbation")
    assert shown.loc["vertex order", label("harris")] == "> 1" and float(shown.loc["noise", label("harris")]) < 0.02
    assert label("random") not in shown and any("no surface" in note for note in built.notes)
    with drawn():
        figures = [module.build(results) for module in (chart, failures)]
    assert all(path.stat().st_size > 5000 for figure in figures for path in figure.paths)
    assert "missing faces" in figures[1].caption and label("harris") in figures[0].alt


def test_report_says_which_stage_to_run(tmp_path):
    for module in (table, chart, failures):
        with pytest.raises(NotRun, match="dvc repro stability"):
            module.build(Results(None, tmp_path))

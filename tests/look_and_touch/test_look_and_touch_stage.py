"""The stage look_and_touch on a small run of its own, and what the report makes of its rows."""

import numpy as np
import pandas as pd
import pytest

from haptic_glance.base.files import read_json, write_mesh, write_table
from haptic_glance.know import primitives
from stages.engine.rows import read_rows
from stages.look_and_touch import __main__ as stage
from stages.look_and_touch.measure import PERTURBATIONS, coarse
from stages.look_and_touch.report import breaking, by_class
from stages.salient_points.measure import write_points

SETTINGS = {"poses": 1, "touches": 2, "disturbed": True, "severities": {"noise": [3.0], "coarse_mesh": [100.0]}}
CLASSES = {"ball": "round", "torus": "round", "capsule": "round", "box": "flat"}


@pytest.fixture
def run(tmp_path, make_workspace, monkeypatch):
    """run(**changes) -> (rows, metrics) of a stage run over basic shapes, one of them twice."""
    from types import SimpleNamespace

    shapes = {name: primitives()[name] for name in CLASSES}
    folder = tmp_path / "data/toys"
    for name, mesh in {**shapes, "twin": shapes["box"]}.items():
        write_mesh(folder / f"meshes/{name}.npz", mesh)
        points = SimpleNamespace(points=np.arange(0, len(mesh.vertices), 7), strong=None, saliency=None)
        write_points(folder / f"salient_points/{name}.npz", {"glance": points})
    entries = [*CLASSES.items(), ("twin", "flat")]
    write_table(folder / "meshes/classes.csv", pd.DataFrame(entries, columns=["object", "class"]))

    def call(**changes):
        workspace = make_workspace({"look_and_touch": SETTINGS | changes})
        stage.run(workspace)
        rows = read_rows(workspace.measurements / "look_and_touch.csv.gz")
        return rows, read_json(workspace.metrics / "look_and_touch.json"), folder

    return call


@pytest.mark.slow
def test_a_run_writes_what_each_sense_tells(run, capsys):
    rows, metrics, folder = run()
    assert "the same shapes as others: twin" in capsys.readouterr().out
    assert set(rows["item"].dropna()) == set(CLASSES) and read_json(folder / "look_and_touch/names.json") == CLASSES
    clean = rows[(rows["perturbation"] == "none") & (rows["metric"] == "right")]
    assert set(clean["sight"]) == {"blind", "look", "look_told", "dark", "siblings"}
    assert set(clean.loc[clean["sight"] == "look", "method"]) == {"planned", "spread", "random", "glance", "touch"}
    assert set(clean.loc[clean["sight"] == "siblings", "item"]) == {"ball", "torus", "capsule"}  # box has no sibling
    told = clean[(clean["sight"] == "look_told") & (clean["touches"] == 2)]
    assert told["value"].mean() == 1
    sure = rows[rows["metric"] == "touches_to_sure"]
    assert sure["value"].between(0, 2).all() and metrics["look"]["planned"]["touches_to_sure"]["mean"] <= 2
    assert set(rows.loc[rows["perturbation"] != "none", "perturbation"].dropna()) == {"noise", "coarse_mesh"}
    unseen = rows[rows["metric"] == "class_right"]
    assert set(unseen["item"]) == {"ball", "torus", "capsule"} and (unseen["split"] == "objects").all()
    reliable = rows[rows["metric"] == "reliable"]
    assert reliable["value"].between(0, 1).all() and reliable["item"].isna().all()
    assert reliable.groupby(["sight", "method"])["answers"].sum()["look", "planned"] == 4 * 3
    fewer, _, _ = run(disturbed=False)
    assert set(fewer["perturbation"].dropna()) == {"none"}


def test_classes_are_those_of_the_file_or_of_the_names(tmp_path):
    assert stage.classes_of(tmp_path, ["Ant_81", "mug", "Four_Leg_381"]) == {
        "Ant_81": "Ant", "mug": "mug", "Four_Leg_381": "Four_Leg"
    }  # fmt: skip


def test_reliability_compares_what_is_stated_with_what_is_right():
    answers = [[0.1 * k, 0 if k < 5 else 1] for k in range(10)]
    rows = [{"sight": "look", "method": "planned", "_answers": answers}, {"sight": "look", "method": "planned"}]
    found = stage.reliability(rows)
    assert [row["value"] for row in found] == [0, 0, 0.5, 1, 1] and [row["answers"] for row in found] == [2] * 5
    assert [row["stated"] for row in found] == pytest.approx([0.05, 0.25, 0.45, 0.65, 0.85])


def test_a_mesh_becomes_coarse_and_a_coarse_one_stays():
    ball = primitives()["ball"]
    assert len(coarse(ball, 200).faces) <= 200 and coarse(ball, 10**6) is ball
    assert 4 <= len(coarse(ball, 2).faces) < 100  # two faces are no solid


def test_half_of_the_lead_is_lost_where_it_breaks():
    """Right 0.9 undisturbed among two objects, then 0.8 and 0.6: the lead 0.4 falls to 0.3 and 0.1; half between."""
    values = zip(("noise",) * 3, ("look",) * 3, (1.0, 3.0, 6.0), (0.9, 0.8, 0.6), strict=True)
    frame = pd.DataFrame(values, columns=["perturbation", "sight", "severity", "accuracy"])
    frame = frame.assign(accuracy_low=frame["accuracy"] - 0.2, accuracy_high=frame["accuracy"] + 0.2)
    (line,) = breaking(frame, 2).to_dict("records")
    assert line["breaking_point"] == pytest.approx(4.5, abs=0.01) and np.isnan(line["high"]) and line["low"] < 3
    assert line["unit"] == PERTURBATIONS["noise"].unit and line["harshest"] == 6


def test_objects_of_a_class_count_once():
    rows = pd.DataFrame({"group": ["a", "a", "b"], "value": [0.0, 1.0, 1.0]})
    assert by_class(rows).tolist() == [0.5, 1.0]

"""The whole stage on two classes of two small objects."""

import dataclasses
import json

import numpy as np
import pytest
import trimesh

from haptic_glance.base.files import sha256, write_arrays, write_mesh, write_text
from haptic_glance.mesh.mesh import Mesh
from stages.engine.rows import read_rows
from stages.transfer import __main__ as stage
from stages.transfer import trial

SHAPES = {
    "ball": trimesh.creation.icosphere(2), "egg": trimesh.creation.icosphere(2).apply_scale([1, 1, 1.5]),
    "brick": trimesh.creation.box([1, 1, 0.5]).subdivide().subdivide(),
    "plank": trimesh.creation.box([1, 0.5, 0.2]).subdivide().subdivide(),
}  # fmt: skip
CLASSES = {"round": ["ball", "egg"], "square": ["brick", "plank"]}


@pytest.fixture
def run(make_workspace, small):
    """run({class: objects}, key=value, ...): (workspace, rows) of the stage with those settings."""

    def start(classes, **changes):
        workspace = make_workspace({"transfer": dataclasses.asdict(small.settings(**changes))})
        for name, shape in SHAPES.items():
            mesh = Mesh(np.array(shape.vertices) / 3, np.array(shape.faces))
            write_mesh(workspace.data / f"meshes/{name}.npz", mesh)
            write_arrays(workspace.data / f"salient_points/{name}.npz", **{"thesis_ssim.points": np.arange(4)})
        rows = [f"{label},{name}" for label, names in classes.items() for name in names]
        write_text(workspace.data / "meshes/classes.csv", "\n".join(["class,object", *rows]))
        stage.run(workspace)
        return workspace, read_rows(workspace.measurements / "transfer.csv.gz")

    return start


@pytest.mark.slow
def test_a_run_writes_what_the_report_reads(run):
    workspace, table = run(CLASSES, epochs=2, search_epochs=1)
    accuracy = table[table["metric"] == "accuracy"]
    assert sorted(accuracy["split"]) == ["objects", "random"] and (accuracy["seconds"] > 0).all()
    assert {"data", "weights", "pretrained", "mode", "repetition"} <= set(table)
    of_sets = table[table["metric"] != "object_accuracy"]
    assert of_sets[["item", "group", "note"]].isna().all(axis=None) and (table["dataset"] == "toys").all()
    folder = workspace.data / "transfer"
    made = {path.relative_to(folder).parts[0] for path in folder.rglob("*") if path.is_file()}
    assert made == {"imprints", "networks", "predictions"}
    assert table.loc[table["metric"] == "disturbed_accuracy", ["perturbation", "severity"]].notna().all(axis=None)
    metrics = json.loads((workspace.metrics / "transfer.json").read_text())
    assert set(metrics) == {"chance", "imprints32"}


@pytest.mark.slow
def test_one_training_more_repeats_no_other(run, monkeypatch):
    """Nor does one that was killed after its learning rate was found."""
    trained, train_model = [], trial.train_model

    def counted(task, labels, ids, rate, epochs, **rest):
        trained.append(epochs)
        if killed and epochs == 3:
            raise KeyboardInterrupt
        return train_model(task, labels, ids, rate, epochs, **rest)

    monkeypatch.setattr(trial, "train_model", counted)
    monkeypatch.setattr("haptic_glance.deep.training.train_model", counted)
    short = {"epochs": 3, "search_epochs": 1, "severities": {}, "splits": {"random": 1}}
    killed = True
    with pytest.raises(KeyboardInterrupt):
        run(CLASSES, **short)
    assert trained == [1, 1, 3]  # two learning rates are tried
    killed = False
    workspace, first = run(CLASSES, **short)
    assert trained == [1, 1, 3, 3]
    file = workspace.data / "transfer/networks/imprints32.mobilenet_v2.random.frozen.random.0.npz"
    before = sha256(file)
    _, second = run(CLASSES, **short | {"splits": {"random": 2}})
    assert trained == [1, 1, 3, 3] + [1, 1, 3] and sha256(file) == before
    assert second[second["repetition"] == 0]["value"].tolist() == first["value"].tolist()


def test_one_class_alone_is_a_row_that_says_so(run, capsys):
    _, table = run({"round": ["ball", "egg"]})
    assert len(table) == 1 and np.isnan(table["value"][0])
    assert "two classes or more are needed, got round" in table["note"][0]
    assert "two classes or more are needed" in capsys.readouterr().err


def test_a_detector_that_found_no_points_is_named(run):
    with pytest.raises(ValueError, match="transfer.detector=harris: not among salient_points.methods: thesis_ssim"):
        run(CLASSES, detector="harris")

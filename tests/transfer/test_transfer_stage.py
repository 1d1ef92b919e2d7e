"""The whole stage on two classes of two small objects."""

import dataclasses
import json

import numpy as np
import pytest
import trimesh
import yaml

from stages.classes.files import write_object
from stages.kit import Mesh
from stages.kit.files import read_table, write_text
from stages.kit.params import params
from stages.transfer.__main__ import main

SHAPES = {
    "ball": trimesh.creation.icosphere(2), "egg": trimesh.creation.icosphere(2).apply_scale([1, 1, 1.5]),
    "brick": trimesh.creation.box([1, 1, 0.5]).subdivide().subdivide(),
    "plank": trimesh.creation.box([1, 0.5, 0.2]).subdivide().subdivide(),
}  # fmt: skip


@pytest.fixture
def run(tmp_path, monkeypatch, small):
    """run({class: objects}, key=value, ...) in a folder of its own, with those settings of the stage."""
    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr("sys.argv", ["python -m stages.transfer"])
    params.cache_clear()

    def start(classes, **changes):
        for name, shape in SHAPES.items():
            mesh = Mesh(np.array(shape.vertices) / 3, np.array(shape.faces))
            write_object(tmp_path / f"data/classes/{name}.npz", mesh, {"thesis_ssim": np.arange(4)})
        rows = [f"{name},{label}" for label, names in classes.items() for name in names]
        write_text(tmp_path / "data/classes/classes.csv", "\n".join(["object,class", *rows]))
        settings = dataclasses.asdict(small.settings(**changes))
        kind = {"source": "toys", "folder": "", "up": "z", "names": classes, "methods": ["thesis_ssim"], "count": 4}
        said = {"seed": 0, "parallel": {"backend": "sequential"}, "transfer": settings, "classes": kind}
        write_text(tmp_path / "params.yaml", yaml.safe_dump(said))
        main()
        return read_table(tmp_path / "reports/measurements/transfer.csv")

    yield start
    params.cache_clear()


def test_a_run_writes_what_the_report_reads(run, tmp_path):
    table = run({"round": ["ball", "egg"], "square": ["brick", "plank"]}, epochs=2, search_epochs=1)
    known = ["dataset", "object", "method", "data", "weights", "had", "mode", "split", "repetition"]
    assert list(table.columns) == [*known, "note", "metric", "value", "seconds", "seed"]
    accuracy = table[table["metric"] == "accuracy"]
    assert sorted(accuracy["split"]) == ["objects", "random"] and (accuracy["seconds"] > 0).all()
    assert (table["object"] == "toys").all() and table["note"].isna().all()
    folder = tmp_path / "data/transfer"
    made = {path.relative_to(folder).parts[0] for path in folder.rglob("*") if path.is_file()}
    assert made == {"imprints", "networks", "predictions", "confusion.csv", "stability.csv", "weight_change.csv"}
    disturbed = read_table(folder / "stability.csv")
    assert {"method", "mode", "split", "perturbation", "severity", "metric", "value"} <= set(disturbed)
    metrics = json.loads((tmp_path / "reports/metrics/transfer.json").read_text())
    assert set(metrics) == {"chance", "imprints32"}


def test_one_class_alone_is_a_row_that_says_so(run, tmp_path, capsys):
    table = run({"round": ["ball", "egg"]})
    assert len(table) == 1 and np.isnan(table["value"][0])
    assert "two classes or more are needed, got round" in table["note"][0] and table["object"][0] == "toys"
    assert "two classes or more are needed" in capsys.readouterr().err


def test_a_detector_that_classes_did_not_run_is_named(run):
    with pytest.raises(ValueError, match="transfer.detector=harris: not among classes.methods: thesis_ssim"):
        run({"round": ["ball", "egg"], "square": ["brick", "plank"]}, detector="harris")

"""A saliency of one's own is judged as the stages judge theirs, and what is no saliency is named."""

import json
from pathlib import Path

import numpy as np
import pandas as pd
import pytest

from stages import bench
from stages.kit import Mesh
from stages.kit.rows import read_rows
from stages.weights.agreement import GroundTruth

METHODS = """
def height(mesh):
    return mesh.vertices[:, 2] - mesh.vertices[:, 2].min()

def positions(mesh):
    return mesh.vertices
"""


@pytest.fixture
def file(tmp_path):
    path = tmp_path / "mine.py"
    path.write_text(METHODS)
    return path


@pytest.fixture
def one_mesh(monkeypatch):
    """One triangle pair with gaze at its highest vertex."""
    mesh = Mesh(np.array([[0, 0, 0], [1, 0, 0.2], [0, 1, 0.5], [1, 1, 1.0]]), np.array([[0, 1, 2], [1, 3, 2]]))
    truth = GroundTruth(np.array([0, 0, 0, 1.0]), np.array([0, 0, 0.1, 1.0]), mesh.vertex_areas)
    monkeypatch.setattr(bench, "gazed", lambda archive: iter([("toy", mesh, truth)]))


def test_a_method_is_ranked_by_its_scores_and_compared_on_the_same_meshes():
    rows = [("a", "glance", 2.0), ("b", "glance", 1.0), ("c", "glance", 9.0), ("a", "yours", 2.5), ("b", "yours", 1.1),
            ("c", "yours", 1.2), ("a", "older", 0.1), ("b", "older", 0.3)]  # fmt: skip
    frame = pd.DataFrame(rows, columns=["item", "method", "value"]).assign(seconds=0.5)
    found = bench.leaderboard(pd.concat([frame.assign(metric=metric) for metric in bench.SCORES]))
    assert [row["method"] for row in found] == ["glance", "yours", "older"]
    older = found[2]
    assert older["objects"] == 2 and older["lead"] == pytest.approx((2.4 + 0.8) / 2)
    assert older["lead_low"] < older["lead"] < older["lead_high"] and "lead" not in found[1]
    assert [line.split()[0] for line in bench.as_text(found).splitlines()[1:]] == ["1", ">", "2"]


def test_a_method_is_judged_beside_the_committed_rows(file, one_mesh, capsys):
    bench.run([f"{file}:height", "--json"])
    found = {row["method"]: row for row in json.loads(capsys.readouterr().out)}
    assert found["yours"]["objects"] == 1 and found["yours"]["nss"] > 0 and found["yours"]["auc"] > 0.8
    assert found["glance"]["objects"] == 19 and found["glance"]["nss"] > found["itti"]["nss"]


@pytest.mark.parametrize(
    ("name", "said"), [("positions", "toy: saliency must have shape"), ("none", "has no function 'none'")]
)
def test_what_is_no_saliency_is_named(file, one_mesh, name, said):
    with pytest.raises(ValueError, match=said):
        bench.run([f"{file}:{name}"])


def test_a_file_that_is_not_there_is_named():
    with pytest.raises(ValueError, match="name a file and a function of it"):
        bench.run(["nowhere.py:saliency"])


def test_rows_that_are_not_there_are_named_with_the_remedy(tmp_path):
    with pytest.raises(ValueError, match="rows.csv.gz: run it in a clone of the project, or name the rows by --rows"):
        bench.run(["--rows", str(tmp_path / "rows.csv.gz")])


@pytest.mark.slow
def test_a_method_gets_the_scores_that_the_stage_gave_it(file, monkeypatch):
    if not bench.GAZE.exists():
        pytest.skip(f"{bench.GAZE} is not here")
    from stages.meshes import sources

    every = sources.gaze
    monkeypatch.setattr(sources, "gaze", lambda settings: [item for item in every(settings) if item.name == "bunny"])
    rows = read_rows(Path(bench.ROWS))
    rows = rows[(rows["method"] == "height") & (rows["item"] == "bunny")].set_index("metric")["value"]
    for row in bench.judged(bench.function_of(f"{file}:height"), bench.GAZE):
        assert row["value"] == pytest.approx(rows[row["metric"]], abs=1e-5)

"""Marks that agree, marks that do not, and marks beside gaze."""

import numpy as np
import pytest

from haptic_glance.base.files import read_json, write_arrays, write_mesh, write_text
from stages.annotations.__main__ import found_share, run
from stages.engine.rows import read_rows
from stages.weights.ground_truth import spread_on_surface

SOURCES = {"household": "", "gaze": "gaze/"}


def meshes_section(source):
    return {"source": source, "folder": "", "up": "z", "unit": "m", "objects": [], "classes": {}, "strict": False}


@pytest.fixture
def measured(make_workspace, ball):
    """A function from a source and the marked vertices of each pass to the workspace after a run on one ball."""

    def measure(source, passes):
        section = {"near": 0.05, "draws": 20}
        workspace = make_workspace({"annotations": section, "meshes": meshes_section(source)}, dataset="balls")
        write_mesh(workspace.data / "meshes/ball.npz", ball)
        write_mesh(workspace.data / "meshes/unmarked.npz", ball)
        gaze = np.zeros(len(ball.vertices))
        gaze[top(ball)] = 1.0
        density = spread_on_surface(ball, gaze, 0.05)
        write_arrays(
            workspace.data / "weights/ground_truth/ball.npz", amounts=gaze, density=density, areas=ball.vertex_areas
        )
        lines = ["annotator,time,vertex,x,y,z"]
        for number, vertices in enumerate(passes):
            for vertex in vertices:
                place = ",".join(f"{x:.6f}" for x in ball.vertices[vertex])
                lines.append(f"pass{number},2026-11-20T10:00:00.000Z,{vertex},{place}")
        write_text(workspace.root / f"data/annotations/{SOURCES[source]}ball.csv", "\n".join(lines))
        run(workspace)
        return workspace

    return measure


def top(ball, count=5):
    return np.argsort(-ball.vertices[:, 2])[:count]


def values(workspace):
    rows = read_rows(workspace.measurements / "annotations.csv.gz")
    assert set(rows["item"]) == {"ball"}
    return rows.set_index(["metric", "method"])["value"]


@pytest.mark.slow
def test_equal_passes_find_each_other_and_random_vertices_or_opposite_ends_do_not(measured, ball):
    rows = values(measured("household", [top(ball), top(ball)]))
    assert rows["found", "passes"] == 1 and rows["found", "random"] < 0.3
    assert set(rows.index) == {("found", "passes"), ("found", "random")}
    assert values(measured("household", [top(ball), np.argsort(ball.vertices[:, 2])[:5]]))["found", "passes"] == 0


@pytest.mark.slow
def test_marks_where_people_looked_agree_with_gaze(measured, ball):
    bottom = np.argsort(ball.vertices[:, 2])[:5]
    workspace = measured("gaze", [top(ball), bottom])
    rows = values(workspace)
    assert rows["nss", "passes"] > 1 and rows["auc", "height"] > 0.9
    assert rows["nss", "one"] < rows["nss", "passes"] + 1  # the mean of a pass that agrees and one that does not
    metrics = read_json(workspace.metrics / "annotations.json")
    assert set(metrics) == {f"{metric}.{method}" for metric, method in rows.index}


def test_near_is_a_share_of_the_diagonal(ball):
    ours, theirs = top(ball, 1), np.argsort(ball.vertices[:, 2])[:1]
    assert found_share(ball, ours, theirs, near=0.5) == 0 and found_share(ball, ours, theirs, near=1.0) == 1

"""The stage as a person starts it: files, measurements, and the same bytes whatever the number of workers."""

import os
import subprocess
import sys
from pathlib import Path

import pandas as pd
import pytest

from stages.kit import Mesh
from stages.kit.files import write_mesh, write_text
from stages.views import FOUR, read_view

ROOT = Path(__file__).parents[2]
PARAMS = """
profile: smoke
seed: 0
parallel: {{backend: {backend}, workers: {workers}}}
views: {{viewpoints: {viewpoints}, size: [90, 120], renderer: raycast, background: black}}
"""


def run_stage(folder, **settings):
    write_text(folder / "params.yaml", PARAMS.format(**{"viewpoints": "four"} | settings))
    command = [sys.executable, "-m", "stages.views"]
    environment = os.environ | {"PYTHONPATH": str(ROOT)}
    return subprocess.run(command, cwd=folder, env=environment, capture_output=True, text=True)


@pytest.fixture
def meshes(shapes, tmp_path):
    for name in ("torus", "cube"):
        write_mesh(tmp_path / "data" / "meshes" / f"{name}.npz", shapes[name])
    return tmp_path


def test_stage_writes_every_view_and_its_measurement_the_same_for_any_workers(meshes):
    stored = []
    for backend, workers in (("sequential", 1), ("loky", 2)):
        result = run_stage(meshes, backend=backend, workers=workers)
        assert result.returncode == 0, result.stderr
        assert result.stdout.startswith("views: 2 objects, 8 views by raycast")
        files = sorted((meshes / "data" / "views").rglob("*.*"))
        stored.append({str(path.relative_to(meshes)): path.read_bytes() for path in files})
    assert stored[0] == stored[1]
    assert len(stored[0]) == 2 * 4 + 1
    table = pd.read_csv(meshes / "data" / "views" / "viewpoints.csv")
    assert list(table.viewpoint) == [viewpoint.name for viewpoint in FOUR]
    rows = pd.read_csv(meshes / "reports" / "measurements" / "views.csv")
    assert set(rows.metric) == {"coverage", "seen_share", "fewest_views"} and (rows.seconds > 0).all()
    rows = rows[rows.metric == "coverage"]
    view = read_view(meshes / "data" / "views" / "cube" / f"{FOUR[1].name}.npz")
    share = rows[(rows.object == "cube") & (rows.viewpoint == FOUR[1].name)].value.item()
    assert view.mask.mean() == pytest.approx(share, rel=1e-5)


def test_unknown_set_of_viewpoints_is_one_line_not_a_traceback(meshes):
    result = run_stage(meshes, backend="sequential", workers=1, viewpoints="six")
    assert result.returncode == 1
    assert "twelve, four" in result.stderr and "Traceback" not in result.stderr


def test_mesh_that_leaves_the_frame_is_named_without_a_traceback(meshes, shapes):
    cube = shapes["cube"]
    write_mesh(meshes / "data" / "meshes" / "huge.npz", Mesh(cube.vertices * 9, cube.faces))
    result = run_stage(meshes, backend="loky", workers=2)
    assert result.returncode == 1
    assert "huge: " in result.stderr and "normalise" in result.stderr and "Traceback" not in result.stderr
    assert not (meshes / "data" / "views").exists()

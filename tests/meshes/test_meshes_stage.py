"""The stage on a person's own folder: good meshes pass, bad ones are named, nothing is lost."""

import os
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
import trimesh

from stages.kit.files import read_mesh, read_table
from stages.meshes import normalise
from stages.meshes.normalise import turn_up

ROOT = Path(__file__).parents[2]
PARAMS = """
profile: smoke
seed: 0
parallel: {backend: sequential, workers: 1}
meshes: {source: folder, folder: mine, up: y, unit: mm, objects: [], strict: %s}
"""


@pytest.fixture
def run(tmp_path):
    (tmp_path / "mine" / "sub folder").mkdir(parents=True)
    trimesh.creation.box((1, 2, 4)).export(tmp_path / "mine" / "Kiste à thé.stl")
    trimesh.creation.icosphere(2).export(tmp_path / "mine" / "sub folder" / "ball.ply")
    trimesh.creation.icosphere(1).export(tmp_path / "mine" / "sub folder" / "ball.off")
    (tmp_path / "mine" / "broken.obj").write_bytes(b"\0\1\2")

    def start(strict="false"):
        (tmp_path / "params.yaml").write_text(PARAMS % strict)
        environment = {**os.environ, "PYTHONPATH": str(ROOT)}
        command = [sys.executable, "-m", "stages.meshes"]
        return subprocess.run(command, cwd=tmp_path, env=environment, capture_output=True, text=True)

    return tmp_path, start


def test_good_meshes_pass_and_bad_ones_are_named(run):
    folder, start = run
    done = start()
    assert done.returncode == 0 and "Traceback" not in done.stderr
    assert "refused broken.obj: the file holds no geometry" in done.stderr
    manifest = read_table(folder / "data/meshes/manifest.csv")
    assert sorted(manifest.object) == ["Kiste à thé", "sub folder__ball", "sub folder__ball_ply"]
    assert manifest.watertight.all() and (manifest.unit == "mm").all() and manifest["size"].max() == 4
    assert read_table(folder / "data/meshes/refused.csv").reason.tolist() == ["the file holds no geometry"]
    mesh = read_mesh(folder / "data/meshes/Kiste à thé.npz")
    assert np.linalg.norm(mesh.vertices, axis=1).max() == pytest.approx(0.5)
    assert np.ptp(mesh.vertices, axis=0).argmin() == 1  # x was the shortest side; y up turns x to y


def test_strict_stops_at_the_first_refusal_and_keeps_the_earlier_result(run):
    folder, start = run
    start()
    done = start("true")
    assert done.returncode == 1 and "strict" in done.stderr and "Traceback" not in done.stderr
    assert len(read_table(folder / "data/meshes/manifest.csv")) == 3


def test_missing_folder_is_named(run):
    folder, start = run
    (folder / "mine").rename(folder / "yours")
    done = start()
    assert done.returncode == 1 and "meshes.folder='mine' is no folder" in done.stderr
    assert "Traceback" not in done.stderr


def test_normalise_ignores_vertices_that_no_face_uses():
    box = trimesh.creation.box((1, 2, 4))
    from stages.kit import Mesh

    mesh = normalise(Mesh(np.vstack([box.vertices + 7, [(1000, 0, 0)]]), box.faces))
    used = mesh.vertices[:-1]
    np.testing.assert_allclose(used.min(axis=0) + used.max(axis=0), 0, atol=1e-12)
    assert np.linalg.norm(used, axis=1).max() == pytest.approx(0.5)


@pytest.mark.parametrize("up", "xyz")
def test_turning_up_keeps_handedness(up):
    from stages.kit import Mesh

    axes = Mesh(np.eye(3), np.array([(0, 1, 2)]))
    turned = turn_up(axes, up)
    assert turned.vertices["xyz".index(up)].tolist() == [0, 0, 1]
    assert np.linalg.det(turned.vertices) == pytest.approx(1)

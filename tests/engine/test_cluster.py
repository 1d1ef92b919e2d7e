"""A cluster that shares no folder: the same bytes, also where a worker is killed in the middle."""

import json
import os
import signal
import subprocess
import sys
import time
from pathlib import Path

import numpy as np
import pytest
import trimesh
from omegaconf import OmegaConf

from haptic_glance.base.fetch import cache_folder
from haptic_glance.base.files import write_arrays, write_mesh, write_text
from haptic_glance.mesh.mesh import Mesh
from stages.engine.parallel import Task, finished, parallel_map
from stages.engine.rows import read_rows
from stages.engine.settings import Workspace
from stages.lod import __main__ as lod

pytest.importorskip("distributed", reason="the cluster extra is not installed")
from stages.engine import cluster  # needs that extra

pytestmark = pytest.mark.slow

ROOT = Path(__file__).parents[2]
PATIENCE = 300  # seconds, on a machine that does much else
# In each worker: a stage's code is one file, since a digest of all files takes seconds. A worker ends where it opens a
# file of the run by the run's own path, since it should have a copy. The first worker that begins to write a file of
# some suffix is killed.
PRELOADED = """
import os, signal, sys
from stages.engine import code
code.imported_files = lambda path: set()
def look(event, arguments):
    path = str(arguments[0]) if event == "open" else ""
    if path.startswith(os.environ["FORBIDDEN"]):
        os._exit(3)
    if "/.part-" in path and path.endswith(os.environ["FATAL"]):
        try:
            os.mkdir(os.environ["KILLED"])
        except FileExistsError:
            return
        os.kill(os.getpid(), signal.SIGKILL)
sys.addaudithook(look)
"""
LOD = {"methods": ["qem", "glance"], "targets": ["50%"], "rings": 1, "backend": "pymeshlab", "samples": 200,
       "viewpoints": "four", "size": [48, 64], "shrink": True}  # fmt: skip
MESHES = {"source": "household", "folder": "", "up": "z", "unit": "m", "objects": [], "classes": {}, "strict": False}
SHAPES = {"ball": trimesh.creation.icosphere(2), "brick": trimesh.creation.box([1, 1, 0.5]).subdivide().subdivide()}


def run(root, backend):
    """Runs the stage lod on two objects below `root`; returns ({file: bytes}, its rows without seconds)."""
    values = {"seed": 0, "profile": "test", "parallel": {"backend": backend, "workers": -1}, "sets": ["toys"]}
    values |= {"graph": {"lod": ["toys"]}, "toys": {"lod": LOD, "meshes": MESHES}}
    write_text(root / "params.yaml", OmegaConf.to_yaml(OmegaConf.create(values)))
    workspace = Workspace(root, "toys")
    for name, shape in SHAPES.items():
        mesh = Mesh(np.array(shape.vertices) / 3, np.array(shape.faces))
        write_mesh(workspace.data / f"meshes/{name}.npz", mesh)
        saliency = np.linspace(0, 1, len(mesh.vertices), dtype=np.float32)
        arrays = {"points": np.arange(4), "strong": np.int64(4), "saliency": saliency}
        write_arrays(workspace.data / f"salient_points/{name}.npz", **{f"glance.{key}": x for key, x in arrays.items()})
    write_text(workspace.data / "weights/weights.csv", "none")
    lod.run(workspace)
    folder = workspace.data / "lod"
    files = {path.relative_to(folder): path.read_bytes() for path in folder.rglob("*") if path.is_file()}
    return files, read_rows(workspace.measurements / "lod.csv.gz").drop(columns="seconds").to_csv()


def until(ready):
    """Waits for ready() and returns what it answers."""
    end = time.monotonic() + PATIENCE
    while not (answer := ready()):
        assert time.monotonic() < end, "nothing happens"
        time.sleep(0.01)
    return answer


@pytest.fixture
def machines(tmp_path, monkeypatch):
    """The processes of three workers in folders of their own; the first to write an array is killed."""
    write_text(tmp_path / "preloaded.py", PRELOADED)
    environment = os.environ | {
        "PYTHONPATH": str(ROOT), "HOME": str(tmp_path), "HAPTIC_GLANCE_CACHE": str(cache_folder()),
        "FORBIDDEN": str(tmp_path / "dask"), "FATAL": ".npz",
        "KILLED": str(tmp_path / "killed"), "DASK_DISTRIBUTED__SCHEDULER__ALLOWED_FAILURES": "1",
    }  # fmt: skip
    started = []

    def start(name, *arguments):
        (tmp_path / name).mkdir()
        command = [sys.executable, "-m", "dask", *arguments, "--no-dashboard"]
        with open(tmp_path / f"{name}.log", "w") as log:
            started.append(subprocess.Popen(command, cwd=tmp_path / name, env=environment, stdout=log, stderr=log))

    try:
        file = tmp_path / "scheduler.json"
        start("scheduler", "scheduler", "--host", "127.0.0.1", "--port", "0", "--scheduler-file", str(file))
        until(file.exists)
        address = until(lambda: file.read_text().endswith("}") and json.loads(file.read_text())["address"])
        worker = ("worker", address, "--no-nanny", "--nthreads", "1", "--preload", str(tmp_path / "preloaded.py"))
        for name in ("first", "second", "third"):
            start(name, *worker, "--local-directory", str(tmp_path / name))
        monkeypatch.setenv(cluster.SCHEDULER, address)
        client = cluster.cluster_client(-1)
        client.wait_for_workers(3, timeout=PATIENCE)
        yield started[1:]
        client.close()
    finally:
        cluster.cluster_client.cache_clear()
        for process in started:
            process.kill()
            process.wait()


def test_lost_workers_change_no_byte_and_what_ends_a_run_is_named(machines, tmp_path, monkeypatch):
    """One worker is killed in the middle of an object; no worker can see the run's folder."""
    monkeypatch.setattr("stages.engine.code.imported_files", lambda path: set())
    answers = list(finished(lambda task, folder: os.getpid(), [Task("cup", 0)], tmp_path, "x", "dask", stage="views"))
    assert answers[0][1] in [process.pid for process in machines]
    with monkeypatch.context() as patch:
        patch.setattr(cluster, "stage_digest", lambda stage: "another")
        with pytest.raises(ValueError, match=r"other code of the stage views \(\w{16}\) than this machine \(another\)"):
            list(finished(lambda task, folder: None, [Task("cup", 0)], tmp_path, "x", "dask", stage="views"))
    assert run(tmp_path / "dask", "dask") == run(tmp_path / "alone", "sequential")
    assert sorted(process.poll() or 0 for process in machines) == [-signal.SIGKILL, 0, 0]
    with pytest.raises(OSError, match="^cup: lost 2 workers"):
        list(finished(lambda task, folder: os._exit(1), [Task("cup", 0)], tmp_path, "x", "dask"))


def test_a_process_starts_one_cluster_for_all_its_maps(capsys):
    try:
        for _ in range(2):
            assert parallel_map(abs, [-1, 2, -3], "dask", "dask", 1) == [1, 2, 3]
        assert capsys.readouterr().err.count("dask: dashboard http") == 1
    finally:
        client = cluster.cluster_client(1)
        client.close()
        client.cluster.close()
        cluster.cluster_client.cache_clear()

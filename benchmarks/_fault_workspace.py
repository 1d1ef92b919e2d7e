"""A tiny workspace to try faults in: four analytic meshes, seven stages, and what its results are by content."""

import gzip
import hashlib
import importlib
import io
import os
import shutil
import signal
import subprocess
import sys
import time
from pathlib import Path
from typing import Any

import pandas as pd
import trimesh
import yaml

from stages.engine.settings import Workspace

SET = "folder"
STAGES = ("meshes", "views", "conspicuity", "weights", "salient_points", "lod", "imprints")
SETTINGS = (
    "profile=smoke", "parallel=sequential", "sets=[folder]", "meshes.folder=own", "views.size=[150,200]",
    "views.viewpoints=four", "conspicuity.size=[75,100]", "salient_points.count=4", "lod.size=[75,100]",
    "lod.samples=500", 'lod.targets=["50%"]', "lod.methods=[qem,glance]", "imprints.cells=[8,8]",
)  # fmt: skip
CODE = Path.cwd()
ROOT = CODE / "build/faults"
DATA, ROWS = ROOT / "data" / SET, ROOT / "reports/measurements" / SET


def write_meshes():
    """Writes the meshes of the data set."""
    make, folder = trimesh.creation, ROOT / "own"
    folder.mkdir()
    make.icosphere(3).export(folder / "ball.ply")
    make.torus(1, 0.4, 24, 16).export(folder / "ring.ply")
    make.box((1, 2, 3)).subdivide().subdivide().subdivide().export(folder / "brick.ply")
    make.cylinder(0.5, 2, 24).subdivide().export(folder / "can.ply")


def prepare():
    """A fresh folder with the tiny data set and the seven stages of dvc.yaml, nothing run; the code stays outside."""
    shutil.rmtree(ROOT, ignore_errors=True)
    (ROOT / ".dvc").mkdir(parents=True)
    shutil.copy2(".dvc/config", ROOT / ".dvc")
    shutil.copy2(".dvcignore", ROOT)
    shutil.copytree("data/annotations", ROOT / "data/annotations")
    write_meshes()
    graph = yaml.safe_load(Path("dvc.yaml").read_text())["stages"]
    for name in STAGES:
        graph[name]["do"]["deps"] = [path for path in graph[name]["do"]["deps"] if not path.startswith("build/code")]
    (ROOT / "dvc.yaml").write_text(yaml.safe_dump({"stages": {name: graph[name] for name in STAGES}}))
    subprocess.run(["git", "init", "-q"], cwd=ROOT, check=True)
    command("stages.compose", *SETTINGS).check_returncode()


def environment():
    """That of a command there, which finds the code of this working tree."""
    return os.environ | {"PYTHONPATH": str(CODE)}


def command(module, *arguments, **more):
    """A finished `python -m MODULE ...` there."""
    whole = [sys.executable, "-m", module, *arguments]
    return subprocess.run(whole, cwd=ROOT, env=environment() | more, capture_output=True, text=True, timeout=300)


def started(module, *arguments) -> Any:
    """A running `python -m MODULE ...` there, the leader of its own process group."""
    whole = [sys.executable, "-m", module, *arguments]
    pipes = {"stdout": subprocess.DEVNULL, "stderr": subprocess.PIPE, "text": True}
    return subprocess.Popen(whole, cwd=ROOT, env=environment(), start_new_session=True, **pipes)


def in_namespace(script):
    """A finished shell script whose mounts end with it; needs root, or user namespaces."""
    whole = ["unshare", "--map-root-user", "--mount", "sh", "-c", script]
    return subprocess.run(whole, cwd=ROOT, env=environment(), capture_output=True, text=True, timeout=300)


def run_here(stage):
    """Runs a stage in this process, so that processes forked from it have its code loaded and compiled."""
    os.chdir(ROOT)
    importlib.import_module(f"stages.{stage}.__main__").run(Workspace(Path("."), SET))


def forked(stage, seconds=None):
    """(whether it ended by itself and well, seconds) of a stage in a process that is killed after some seconds."""
    start, child = time.perf_counter(), os.fork()
    if not child:
        os.setsid()
        with open(ROOT / "said", "w") as log:
            os.dup2(log.fileno(), 1)
            os.dup2(log.fileno(), 2)
        try:
            run_here(stage)
        except BaseException:
            os._exit(1)
        os._exit(0)
    if seconds is not None:
        time.sleep(seconds)
        os.kill(child, signal.SIGKILL)  # of sequential runs, which have no other process
    _, status = os.waitpid(child, 0)
    return status == 0, time.perf_counter() - start


def forget(*stages, cache=True):
    """Removes what stages have made, and the cache of objects."""
    for stage in stages:
        shutil.rmtree(DATA / stage, ignore_errors=True)
        (ROWS / f"{stage}.csv.gz").unlink(missing_ok=True)
    if cache:
        for name in ("objects", "scratch", "partial"):
            shutil.rmtree(ROOT / "build" / name, ignore_errors=True)


def content(*stages):
    """{file: SHA-256} of data and of rows without seconds of some stages, of all without names."""
    digests = {}
    for stage in stages or STAGES:
        for path in sorted((DATA / stage).rglob("*")):
            if path.is_file():
                digests[str(path.relative_to(ROOT))] = hashlib.sha256(path.read_bytes()).hexdigest()
        rows = ROWS / f"{stage}.csv.gz"
        if rows.exists():
            frame = pd.read_csv(io.BytesIO(gzip.decompress(rows.read_bytes()))).drop(columns="seconds")
            still = frame[~frame["metric"].astype(str).str.contains("seconds")]
            digests[rows.name] = hashlib.sha256(still.to_csv().encode()).hexdigest()
    return digests

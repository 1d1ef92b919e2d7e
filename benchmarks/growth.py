"""Do time and memory grow with the number of objects as they should? `python -m benchmarks.growth [LARGEST]`

Works in build/growth, on folders of 30, 100, 300, ... LARGEST (300 without it) meshes: copies of four simple shapes,
each with its own noise. Runs every stage of the folder's graph on them with few and small pictures, then lets DVC take
note of it. A run that was stopped goes on with the stage at which it was.

Writes reports/bench/growth.csv, a row a stage and number of objects: stage, objects, seconds and processor (seconds of
all its processes), main_mib and all_mib (the most memory of the process that hands out the work, and of it and its
workers), files and mib (of its results), dvc_seconds (of DVC taking note), and machine. Rows `dvc status` have the
seconds of that command after all stages, when nothing has changed.
"""

import os
import platform
import shutil
import subprocess
import sys
import time
from pathlib import Path

import numpy as np
import pandas as pd
import psutil
import trimesh
import yaml

from benchmarks import arguments
from stages.kit.files import read_table, write_table

OUT, CODE = Path("reports/bench/growth.csv").resolve(), Path.cwd()
ROOT = CODE / "build/growth"
SIZES = (30, 100, 300, 1_000, 3_000, 10_000)
NOISE = 0.005  # standard deviation, units of shapes about 2 wide
STAGES = ("meshes", "views", "conspicuity", "weights", "salient_points", "lod", "imprints")
SETTINGS = (
    "profile=smoke", "sets=[folder]", "meshes.folder=own", "views.size=[150,200]", "views.viewpoints=four",
    "conspicuity.size=[75,100]", "salient_points.methods=[glance]", "salient_points.count=8", "lod.samples=500",
    "lod.size=[75,100]", 'lod.targets=["50%"]', "lod.methods=[qem,glance]", "imprints.methods=[glance]",
)  # fmt: skip
STATUS, MIB = "dvc status", 2**20


def write_meshes(count):
    """Writes copies of the shapes, the same ones for any larger count."""
    make, folder = trimesh.creation, ROOT / "own"
    folder.mkdir()
    cube = make.box((1, 1.5, 2)).subdivide().subdivide().subdivide()
    shapes = {"ball": make.icosphere(3), "ring": make.torus(1, 0.4, 24, 16), "brick": cube,
              "can": make.cylinder(0.5, 2, 24).subdivide().subdivide()}  # fmt: skip
    for number in range(count):
        name, shape = list(shapes.items())[number % len(shapes)]
        moved = shape.vertices + np.random.default_rng([0, number]).normal(scale=NOISE, size=shape.vertices.shape)
        trimesh.Trimesh(moved, shape.faces, process=False).export(folder / f"{name}_{number:05}.ply")


def prepare(count):
    """A folder with the meshes and the stages of dvc.yaml, nothing run; the code stays outside."""
    shutil.rmtree(ROOT, ignore_errors=True)
    (ROOT / ".dvc").mkdir(parents=True)
    shutil.copy2(".dvc/config", ROOT / ".dvc")
    shutil.copy2(".dvcignore", ROOT)
    shutil.copytree("data/annotations", ROOT / "data/annotations")
    write_meshes(count)
    graph = {name: yaml.safe_load(Path("dvc.yaml").read_text())["stages"][name] for name in STAGES}
    for stage in graph.values():
        stage["do"]["deps"] = [path for path in stage["do"]["deps"] if not path.startswith("build/code")]
    (ROOT / "dvc.yaml").write_text(yaml.safe_dump({"stages": graph}))
    run("git", "init", "-q")
    run(sys.executable, "-m", "stages.compose", *SETTINGS)


def run(*command):
    """Runs a command there; {seconds, processor, main_mib, all_mib}, looked at ten times a second."""
    start, used, main, most = time.perf_counter(), {}, 0, 0
    process = psutil.Popen(command, cwd=ROOT, env=os.environ | {"PYTHONPATH": str(CODE)}, stdout=subprocess.DEVNULL)
    while process.poll() is None:
        sizes = [0]
        for one in [process, *_children(process)]:
            try:
                times = one.cpu_times()
                used[one.pid] = times.user + times.system
                sizes.append(one.memory_info().rss)
            except psutil.Error:  # it has just ended
                continue
        main, most = max(main, *sizes[:2]), max(most, sum(sizes))
        time.sleep(0.1)
    if process.returncode:
        raise SystemExit(f"growth: {' '.join(command)} failed")
    seconds = time.perf_counter() - start
    return {"seconds": seconds, "processor": sum(used.values()), "main_mib": main / MIB, "all_mib": most / MIB}


def _children(process):
    try:
        return process.children(recursive=True)
    except psutil.Error:
        return []


def measured(stage):
    """Runs a stage and lets DVC take note; what both cost. What a stopped run of it left in the cache is forgotten."""
    for name in ("objects", "scratch", "partial"):
        shutil.rmtree(ROOT / "build" / name, ignore_errors=True)
    row = run(sys.executable, "-m", f"stages.{stage}", "folder")
    files = [path.stat().st_size for path in (ROOT / "data/folder" / stage).rglob("*") if path.is_file()]
    noted = run("dvc", "commit", "--quiet", "--force", f"{stage}@folder")
    return row | {"files": len(files), "mib": sum(files) / MIB, "dvc_seconds": noted["seconds"]}


def main():
    """Measures what has no row yet, and writes the table after each stage."""
    largest = int(arguments(__doc__, largest="300").largest)
    machine = f"{platform.machine()}, {len(os.sched_getaffinity(0))} cores, Python {platform.python_version()}"
    rows = read_table(OUT).to_dict("records") if OUT.exists() else []
    for count in [size for size in SIZES if size <= largest]:
        there = {row["stage"] for row in rows if row["objects"] == count}
        if STATUS in there:
            continue
        if not there or len(list((ROOT / "own").glob("*"))) != count:
            rows, there = [row for row in rows if row["objects"] != count], set()
            prepare(count)
        for stage in (*STAGES, STATUS):
            if stage in there:
                continue
            row = run("dvc", "status") if stage == STATUS else measured(stage)
            rows.append({"stage": stage, "objects": count, **row, "machine": machine})
            print(pd.DataFrame(rows[-1:]).drop(columns="machine").round(2).to_string(index=False), flush=True)
            write_table(OUT, pd.DataFrame(rows))


if __name__ == "__main__":
    main()

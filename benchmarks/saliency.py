"""How long a look takes: `python -m benchmarks.saliency [PSB.zip]`

Meshes: those of benchmarks.imprints (the least, the middle and the most faces of data/household/meshes and of the
Princeton segmentation benchmark), and bumpy spheres of 41,000 to 1,300,000 faces. Methods take turns, on one core;
`seconds` are those of the process, the least of three rounds, after one to warm up.

Writes reports/bench/saliency.csv. Rows `warm`: `method` is that of `saliency`. Rows `cold`: seconds of a fresh
process from its start to the first answer of `method`, `saliency`, `simplify` or `press`, on 20,480 faces; `cache` says
whether the compiled kernels were there.
"""

import os
import subprocess
import sys
import tempfile
import time
from pathlib import Path

import numpy as np
import pandas as pd
import trimesh

from benchmarks import arguments
from benchmarks.imprints import PSB, meshes
from haptic_glance.base.files import write_table
from haptic_glance.look.points import saliency
from haptic_glance.mesh.mesh import Mesh

OUT = Path("reports/bench/saliency.csv")
METHODS = ("glance", "glance_any_pose")
ROUNDS = 3
BUMPY = {"bumpy_sphere_6": 6, "bumpy_sphere_7": 7, "bumpy_sphere_8": 8}  # subdivisions
FIRST = """
import time, resource, sys
import trimesh
from haptic_glance import Mesh, press, saliency, simplify
ball = trimesh.creation.icosphere(5)
mesh = Mesh(ball.vertices, ball.faces)
doors = {"saliency": lambda: saliency(mesh), "simplify": lambda: simplify(mesh, 2000), "press": lambda: press(mesh, 0)}
doors[sys.argv[1]]()
used = resource.getrusage(resource.RUSAGE_SELF)
print(used.ru_utime + used.ru_stime)
"""


def objects(archive):
    """(name, Mesh)."""
    for _, name, mesh in meshes(archive):
        yield name, mesh
    for name, subdivisions in BUMPY.items():
        ball = trimesh.creation.icosphere(subdivisions, radius=0.4)
        yield name, Mesh(ball.vertices * (1 + 0.1 * np.sin(20 * ball.vertices[:, [0]])), ball.faces)


def warm_rows(name, mesh):
    """Rows `warm` of one object."""
    taken = {method: [] for method in METHODS}
    for turn in range(ROUNDS + 1):
        for method, seconds in taken.items():
            start = time.process_time()
            saliency(Mesh(mesh.vertices, mesh.faces), method)  # a new Mesh: nothing is cached
            seconds += [time.process_time() - start] if turn else []
    common = {"what": "warm", "object": name, "faces": len(mesh.faces), "cache": "full"}
    return [common | {"method": method, "seconds": min(times)} for method, times in taken.items()]


def cold_rows():
    """Rows `cold`: each door in a process of its own, with an empty cache and once more with what that one compiled."""
    rows = []
    for method in ("saliency", "simplify", "press"):
        with tempfile.TemporaryDirectory() as folder:
            for cache in ("empty", "full"):
                run = subprocess.run([sys.executable, "-c", FIRST, method], capture_output=True, text=True, check=True,
                                      env=os.environ | {"HAPTIC_GLANCE_CACHE": folder})  # fmt: skip
                rows.append({"what": "cold", "object": "sphere", "faces": 20_480, "method": method, "cache": cache,
                             "seconds": float(run.stdout)})  # fmt: skip
    return rows


def main():
    """Measures and writes the table."""
    chosen = arguments(__doc__, archive=PSB)
    os.sched_setaffinity(0, {min(os.sched_getaffinity(0))})
    rows = cold_rows()
    for name, mesh in objects(chosen.archive):
        rows += warm_rows(name, mesh)
    frame = pd.DataFrame(rows, columns=["what", "object", "faces", "method", "cache", "seconds"])
    write_table(OUT, frame)
    print(frame.to_string())


if __name__ == "__main__":
    main()

"""Imprints a second, ours beside camera-based simulators: `python -m benchmarks.imprints [PSB.zip] [--tacto PYTHON]`

Meshes: the objects of data/household/meshes and of the Princeton segmentation benchmark (psb.zip in ../shared/data, or
the path given), the least, the middle and the most faces of each. 40 random vertices of each, the same for all
methods; arrays of 16 and 32 cells a side, 0.002 and 0.01 units apart. Methods: `ours`, press_many on a
Surface; `trimesh_embree`, trimesh's intersects_location on embree, one call for all cells, from above, first hits;
`depth_picture`, pyrender's orthographic depth picture, a pixel a cell; `tacto_160x120` and `tacto_32x32`, TACTO's
renderer of a DIGIT at its own resolution and at a small one, its gel as long as the array, one render a touch without
noise, forces and steps of pybullet. Scenes are handed over before; seconds are those of the process on one core, the
least of two rounds in which the methods take turns, after one to warm up.

Writes reports/bench/imprints.csv. Rows `rate`: `value` imprints a second, `seconds` one imprint's, `ratio` the rate to
tacto_160x120's of the same mesh and array. Rows `error`: `value` is the largest distance, in units and along the
array's normal, between what a method measured and an analytic shape, which it is given finely cut; `to_mesh` the same
to the cut itself, the better measure of the method. 31 x 31 cells 0.0093 apart, at no vertices; TACTO at the pixels
that see the object. A peer that cannot run gets a row with the reason.

TACTO runs in an environment of its own, whose python is given by --tacto:
  python -m venv tacto
  tacto/bin/pip install numpy scipy opencv-python-headless omegaconf trimesh networkx lxml pillow six pyopengl imageio
  tacto/bin/pip install freetype-py pyglet==1.5.31 pycollada matplotlib "setuptools<80"
  tacto/bin/pip install --no-deps scikit-robot-pyrender==0.1.50 urdfpy==0.0.22 tacto==0.0.3 pybullet
"""

import json
import os
import subprocess
import tempfile
import time
from pathlib import Path

import numpy as np
import pandas as pd
import trimesh

from benchmarks import arguments
from haptic_glance.base.files import read_mesh, write_arrays, write_table
from haptic_glance.base.rng import rng
from haptic_glance.mesh import normalise
from haptic_glance.mesh.files import parse
from haptic_glance.mesh.mesh import Mesh
from haptic_glance.touch import Surface, distances_at, press_many, sensor_axes, sensor_normals, touchable
from stages.engine.parallel import progress
from stages.meshes.sources import PRINCETON, collection_files

OUT, MESHES, PSB = Path("reports/bench/imprints.csv"), Path("data/household/meshes"), "../shared/data/psb.zip"
CELLS, PITCHES = (16, 32), (0.002, 0.01)
TOUCHES, ROUNDS = 40, 2
CAMERAS = {  # name -> (kind, rows, columns); the depth picture has a pixel a cell
    "tacto_160x120": ("tacto", 160, 120), "tacto_32x32": ("tacto", 32, 32),
    "depth_picture": ("depth", None, None),
}  # fmt: skip
REFERENCE = "tacto_160x120"
ODD, APART = 31, 0.0093  # the array of the errors; its cells are at no vertices, which alone lie on the shape
HALF, CUT = 100, 0.002  # the solids: so many squares from the middle to the rim, of this side
RADIUS = 0.3
SHAPES = {
    "plane": lambda x, y: 0.1 * x + 0.2 * y,
    "sphere": lambda x, y: np.sqrt(RADIUS**2 - x**2 - y**2),
    "cylinder": lambda x, y: np.sqrt(RADIUS**2 - x**2) + 0 * y,
    "saddle": lambda x, y: x**2 - y**2,
}


class Camera:
    """A process of _camera_peers.py, kept between jobs."""

    def __init__(self, python, kind, rows, columns):
        command = [python, str(Path(__file__).with_name("_camera_peers.py")), kind, str(rows), str(columns)]
        # In a pipe that nobody reads a talkative peer would get stuck.
        self.stderr_file = tempfile.TemporaryFile("w+")  # noqa: SIM115
        self.process = subprocess.Popen(command, stdin=subprocess.PIPE, stdout=subprocess.PIPE,
                                        stderr=self.stderr_file, text=True)  # fmt: skip

    def touch(self, job):
        """The answer of the process to a job: seconds, points, gl, version."""
        try:
            self.process.stdin.write(f"{job}\n")
            self.process.stdin.flush()
            return json.loads(self.process.stdout.readline())
        except (OSError, ValueError):
            self.process.kill()
            self.process.wait()
            self.stderr_file.seek(0)
            lines = self.stderr_file.read().strip().splitlines()
            raise ValueError(lines[-1] if lines else "it ended without a word") from None

    def close(self):
        """Ends the process."""
        self.process.stdin.close()
        self.process.wait()
        self.process.stdout.close()
        self.stderr_file.close()


class Cameras:
    """The camera-based peers, each started when it is first asked; python: their interpreter or None."""

    def __init__(self, python):
        self.python, self.running, self.refused = python, {}, {}

    def ask(self, name, cells, job):
        """The answer of a peer; ValueError with the reason where it does not run."""
        kind, rows, columns = CAMERAS[name]
        key = (kind, rows or cells, columns or cells)
        if not self.python:
            raise ValueError("not run: no --tacto PYTHON was given")
        if key in self.refused:
            raise ValueError(self.refused[key])
        try:
            self.running[key] = self.running.get(key) or Camera(self.python, *key)
            return self.running[key].touch(job)
        except (ValueError, OSError) as error:
            self.refused[key] = f"not run: {error}"
            raise ValueError(self.refused[key]) from None

    def close(self):
        """Ends all processes."""
        for camera in self.running.values():
            camera.close()


def meshes(archive):
    """(source, name, Mesh): the least, middle and most faces of the household objects and of psb."""
    household = {path.stem: read_mesh(path) for path in sorted(MESHES.glob("*.npz"))}
    groups = [("household", household)]
    if Path(archive).exists():
        files = collection_files(archive, *PRINCETON)
        first = {path.split("/")[1]: path for path in reversed(sorted(files)) if path.endswith(".off")}
        groups.append(("psb", {name: normalise(parse(files[path](), ".off")) for name, path in sorted(first.items())}))
    for source, named in groups:
        by_size = sorted(named, key=lambda name: len(named[name].faces))
        for place in dict.fromkeys((0, len(by_size) // 2, len(by_size) - 1)) if by_size else ():
            yield source, by_size[place], named[by_size[place]]


def rate_rows(source, name, mesh, cameras, folder):
    """Rows of imprints a second on one mesh."""
    vertices = rng(0, name).permutation(np.flatnonzero(touchable(mesh, np.arange(len(mesh.vertices)))))[:TOUCHES]
    axes = sensor_axes(sensor_normals(mesh, vertices))
    rays = trimesh.Trimesh(mesh.vertices, mesh.faces, process=False).ray
    surface, rows = Surface(mesh), []
    for cells in CELLS:
        for pitch in PITCHES:
            job = folder / "job.npz"
            stand = {"positions": mesh.vertices[vertices], "axes": axes, "cells": (cells, cells), "pitch": pitch}
            write_arrays(job, vertices=mesh.vertices, faces=mesh.faces, **stand)
            works = {
                "ours": timed(lambda cells=cells, pitch=pitch: press_many(surface, vertices, (cells, cells), pitch)),
                "trimesh_embree": timed(lambda stand=stand: by_trimesh(rays, **stand)),
            }
            works |= {camera: lambda camera=camera, cells=cells, job=job: cameras.ask(camera, cells, job)
                      for camera in CAMERAS}  # fmt: skip
            common = {"what": "rate", "mesh": name, "source": source, "faces": len(mesh.faces), "cells": cells}
            rows += in_turns(works, common | {"pitch": pitch, "touches": len(vertices)})
    return rows


def timed(work):
    """A function that does the work and answers as a camera does."""

    def run():
        start = time.process_time()
        work()
        return {"seconds": time.process_time() - start}

    return run


def by_trimesh(rays, positions, axes, cells, pitch):
    """(k, rows, cols) distances by trimesh: rays from the reach above, one call for all."""
    rows, columns = cells
    right, up, normal = axes.transpose(1, 0, 2)[:, :, None, None]
    down = (((rows - 1) / 2 - np.arange(rows)) * pitch)[:, None, None]
    along = ((np.arange(columns) - (columns - 1) / 2) * pitch)[None, :, None]
    reach = max(cells) * pitch
    starts = (positions[:, None, None] + down * up + along * right + reach * normal).reshape(-1, 3)
    ways = np.broadcast_to(-normal, (len(axes), rows, columns, 3)).reshape(-1, 3)
    places, ray, _ = rays.intersects_location(starts, ways, multiple_hits=False)
    distances = np.full(len(starts), reach)
    distances[ray] = np.einsum("ij,ij->i", places - starts[ray], ways[ray]) - reach
    return np.clip(distances, -reach, reach).reshape(len(axes), rows, columns)


def in_turns(works, common):
    """Rows of the works, each with the least seconds of the rounds, one after the other again and again."""
    best, notes = {}, {}
    for turn in range(ROUNDS + 1):
        for name, work in works.items():
            if name in notes:
                continue
            try:
                answer = work()
            except ValueError as error:
                notes[name] = str(error)
                continue
            if turn:  # the first round warms up
                best[name] = min(best.get(name, np.inf), answer["seconds"] / common["touches"])
            if "gl" in answer:
                notes.setdefault(f"{name} by", f"version {answer['version']}, GL {answer['gl']}")
    rows = []
    for name in works:
        seconds = best.get(name)
        row = common | {"method": name, "value": 1 / seconds if seconds else None, "seconds": seconds}
        row["ratio"] = best[REFERENCE] / seconds if seconds and REFERENCE in best else None
        rows.append(row | {"note": notes.get(name, notes.get(f"{name} by", ""))})
    return rows


def solid(top):
    """(closed Mesh, id of the vertex at x = y = 0): the top is z = top(x, y) on a grid, the bottom lies flat."""
    side = 2 * HALF + 1
    line = (np.arange(side) - HALF) * CUT
    x, y = (grid.ravel() for grid in np.meshgrid(line, line, indexing="ij"))
    upper = np.c_[x, y, top(x, y)]
    lower = np.c_[x, y, np.full_like(x, upper[:, 2].min() - 0.5)]
    ids = np.arange(side * side).reshape(side, side)
    a, b, c, d = (part.ravel() for part in (ids[:-1, :-1], ids[1:, :-1], ids[1:, 1:], ids[:-1, 1:]))
    cover = np.r_[np.c_[a, b, c], np.c_[a, c, d]]
    rim = np.r_[ids[:, 0], ids[-1, 1:], ids[-2::-1, -1], ids[0, -2:0:-1]]
    after, n = np.roll(rim, -1), side * side
    walls = np.r_[np.c_[rim, rim + n, after + n], np.c_[rim, after + n, after]]
    return Mesh(np.r_[upper, lower], np.r_[cover, cover[:, ::-1] + n, walls]), int(ids[HALF, HALF])


def error_rows(name, top, cameras, folder):
    """Rows of the largest error of each method on one analytic shape, the array level above its middle."""
    mesh, middle = solid(top)
    centre, axes = mesh.vertices[[middle]], np.eye(3)[None]
    stand = {"positions": centre, "axes": axes, "cells": (ODD, ODD), "pitch": APART}
    job = folder / "job.npz"
    write_arrays(job, vertices=mesh.vertices, faces=mesh.faces, **stand)
    line = (np.arange(ODD) - ODD // 2) * APART
    x, y = np.meshgrid(line, -line)
    rays = trimesh.Trimesh(mesh.vertices, mesh.faces, process=False).ray
    seen = {
        "ours": (x, y, centre[0, 2] - distances_at(Surface(mesh), centre, axes, (ODD, ODD), APART)[0]),
        "trimesh_embree": (x, y, centre[0, 2] - by_trimesh(rays, **stand)[0]),
    }
    notes = {}
    for camera in CAMERAS:
        try:
            seen[camera] = np.array(cameras.ask(camera, ODD, job)["points"]).T
            notes[camera] = f"{seen[camera].shape[1]} pixels"
        except ValueError as error:
            notes[camera] = str(error)
    common = {"what": "error", "mesh": name, "source": "analytic", "faces": len(mesh.faces), "cells": ODD}
    rows = []
    for method in ["ours", "trimesh_embree", *CAMERAS]:
        row = common | {"pitch": APART, "method": method, "touches": 1, "note": notes.get(method, "")}
        if method in seen:
            x, y, z = seen[method]
            row |= {"value": np.abs(z - top(x, y)).max(), "to_mesh": np.abs(z - cut(top, x, y)).max()}
        rows.append(row)
    return rows


def cut(top, x, y):
    """Heights of the solid's triangles at places x, y of any shape."""
    column, row = (np.floor(place / CUT) for place in (x, y))
    s, t = x / CUT - column, y / CUT - row
    low, high = column * CUT, (column + 1) * CUT
    a, c = top(low, row * CUT), top(high, (row + 1) * CUT)
    b, d = top(high, row * CUT), top(low, (row + 1) * CUT)
    return np.where(s >= t, a + s * (b - a) + t * (c - b), a + t * (d - a) + s * (c - d))


def main():
    """Measures and writes the table."""
    chosen = arguments(__doc__, archive=PSB, **{"--tacto": None})
    os.sched_setaffinity(0, {min(os.sched_getaffinity(0))})
    cameras, rows = Cameras(chosen.tacto), []
    with tempfile.TemporaryDirectory() as scratch:
        folder = Path(scratch)
        for name, top in SHAPES.items():
            rows += error_rows(name, top, cameras, folder)
        for source, name, mesh in progress(list(meshes(chosen.archive)), "imprints"):
            rows += rate_rows(source, name, mesh, cameras, folder)
            write_table(OUT, pd.DataFrame(rows))
    cameras.close()
    if not Path(chosen.archive).exists():
        rows.append({"what": "rate", "source": "psb", "note": f"not run: no {chosen.archive}"})
    frame = pd.DataFrame(rows)
    write_table(OUT, frame)
    print(
        frame[frame["what"] == "rate"].pivot_table("value", ["faces", "cells", "pitch"], "method").round(1).to_string()
    )
    print(frame[frame["what"] == "error"].pivot_table("value", "mesh", "method").to_string())


if __name__ == "__main__":
    main()

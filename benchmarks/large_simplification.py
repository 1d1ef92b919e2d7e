"""Millions of faces: `python -m benchmarks.large_simplification [--faces N]`

Simplifies a rippled torus, of 10,000,000 faces unless --faces says otherwise, to 1 %: as a whole, and thinned out block
by block first (haptic_glance/lod/blocks.py), on all cores. Each runs in a process of its own, so that its memory is
its own.

Writes reports/bench/large_simplification.csv: a row a way, with the wall-clock and processor seconds, the most memory
that the process held in GB (with the mesh, before the errors are measured), and the Metro mean and maximum. `ratio` is
the processor seconds over those of the first row.
"""

import multiprocessing
import resource
import time
from concurrent.futures import ProcessPoolExecutor
from pathlib import Path

import numpy as np
import pandas as pd

from benchmarks import arguments
from haptic_glance.base.files import write_table
from haptic_glance.lod import metro
from haptic_glance.lod.blocks import collapse
from haptic_glance.lod.fast import collapse as collapse_whole
from haptic_glance.mesh.mesh import Mesh

OUT = Path("reports/bench/large_simplification.csv")
WAYS = {"whole": collapse_whole, "blocks": collapse}
SHARE = 100  # of the faces, one is left


def torus(faces):
    """A closed torus of about so many faces, its tube rippled coarsely and finely."""
    side = int(np.sqrt(faces / 2))
    turn = 2 * np.pi * np.arange(side) / side
    u, v = (grid.ravel() for grid in np.meshgrid(turn, turn, indexing="ij"))
    tube = 0.35 + 0.01 * np.sin(31 * u) * np.cos(17 * v) + 0.002 * np.sin(211 * u + 101 * v)
    away = 1 + tube * np.cos(v)
    a = np.arange(side * side).reshape(side, side)
    b, d = np.roll(a, -1, axis=0), np.roll(a, -1, axis=1)
    c = np.roll(b, -1, axis=1)
    corners = [np.stack([x.ravel(), y.ravel(), z.ravel()], axis=1) for x, y, z in ((a, b, c), (a, c, d))]
    return Mesh(np.stack([away * np.cos(u), away * np.sin(u), tube * np.sin(v)], axis=1), np.concatenate(corners))


def measured(way, faces):
    """The row of one way."""
    small, mesh = torus(20_000), torus(faces)
    WAYS[way](small, 200, np.zeros(len(small.faces), bool))  # loads compiled code
    nothing = np.zeros(len(mesh.faces), bool)
    wall, start = time.perf_counter(), time.process_time()
    simple = WAYS[way](mesh, len(mesh.faces) // SHARE, nothing)
    taken = {"wall": time.perf_counter() - wall, "seconds": time.process_time() - start}
    memory = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 2**20
    errors = metro(mesh, simple)
    row = {"way": way, "full": len(mesh.faces), "faces": len(simple.faces)} | taken
    return row | {"memory": memory, "metro_mean": errors["mean"], "metro_max": errors["max"]}


def main():
    """Measures both ways and writes the table."""
    chosen = arguments(__doc__, **{"--faces": "10000000"})
    rows = []
    for way in WAYS:
        with ProcessPoolExecutor(1, multiprocessing.get_context("spawn")) as alone:
            rows.append(alone.submit(measured, way, int(chosen.faces)).result())
    table = pd.DataFrame(rows)
    table["ratio"] = table["seconds"] / table["seconds"].iloc[0]
    write_table(OUT, table)
    print(table.to_string(index=False))


if __name__ == "__main__":
    main()

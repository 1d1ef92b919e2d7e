"""Who spares what people look at: `python -m benchmarks.salient_simplification [GAZE.zip] [--meshoptimizer FILE.js]`

Simplifies the meshes with recorded gaze (gaze.zip in ../shared/data, or the path given), most of 40,000 faces, to four
shares of their faces: ours, plain and with the gaze as weights; meshoptimizer, plain and with its priority bit on the
vertices of most gaze, as many as each of PRIORITY says, and with its lock bit on those of LOCKED. Without
meshopt_simplifier.js (see _simplify_peers.py) only ours run.

Writes reports/bench/salient_simplification.csv: a row a mesh, share and method, with the processor seconds (the least
of ROUNDS, in turns, each call with a mesh not seen before), Metro mean, and the error weighted by gaze
(haptic_glance.lod.errors). `bar` is the least of that over meshoptimizer's ways in the same cell, `salient_ratio` the
error over it.
"""

import sys
import time
from pathlib import Path

import numpy as np
import pandas as pd

from benchmarks import arguments
from benchmarks._simplify_peers import LOCK, PRIORITY, fresh, peers
from haptic_glance.base.files import write_table
from haptic_glance.lod import InfeasibleTarget, SimplifyError, metro, salient_error, simplify
from haptic_glance.mesh import normalise
from haptic_glance.mesh.files import parse
from haptic_glance.mesh.mesh import Mesh
from stages.engine.parallel import progress
from stages.lod.cell import warm_up
from stages.weights.ground_truth import ground_truth_amounts, published_files, spread_on_surface

OUT = Path("reports/bench/salient_simplification.csv")
GAZE = "../shared/data/gaze.zip"
SHARES = (0.5, 0.25, 0.1, 0.02)
MOST_GAZE = {"priority": (PRIORITY, (0.01, 0.03, 0.1, 0.25)), "lock": (LOCK, (0.002, 0.005))}  # bit, shares of vertices
SIGMA = 0.02  # of the diagonal: gaze is spread so far over the surface
ROUNDS = 3


def subjects(archive):
    """(name, Mesh, (n,) gaze in 0..1) of each mesh with recorded gaze."""
    for name, files in sorted(published_files("gaze", archive).items()):
        mesh = normalise(parse(files[1][1](), ".obj"))
        mesh = Mesh(mesh.vertices.astype(np.float32), mesh.faces)  # meshoptimizer's precision
        density = spread_on_surface(mesh, ground_truth_amounts(name, "gaze", mesh, files), SIGMA * mesh.diagonal)
        yield name, mesh, density / density.max()


def ways(gaze, meshoptimizer):
    """dict name -> function(mesh, faces) of all ways to simplify."""
    works = {"fast": simplify, "fast_weights": lambda mesh, faces: simplify(mesh, faces, weights=gaze)}
    if meshoptimizer:
        nobody, order = np.zeros(len(gaze), np.uint8), np.argsort(-gaze)
        chosen = {"meshoptimizer": nobody}
        for word, (bit, shares) in MOST_GAZE.items():
            for share in shares:
                bits = nobody.copy()
                bits[order[: int(share * len(gaze))]] = bit
                chosen[f"meshoptimizer_{word}_{share:g}"] = bits
        for name, bits in chosen.items():
            works[name] = lambda mesh, faces, bits=bits: meshoptimizer(mesh, faces, None, bits)
    return works


def cell(mesh, faces, gaze, works):
    """Rows of all ways, on one mesh and target."""
    rows = {}
    for _ in range(ROUNDS):
        for name, work in works.items():
            unseen, start = fresh(mesh), time.process_time()
            try:
                simple = work(unseen, faces)
            except (InfeasibleTarget, SimplifyError) as refusal:
                rows[name] = {"method": name, "outcome": "refused", "note": str(refusal)}
                continue
            seconds = time.process_time() - start
            row = rows.setdefault(name, {"method": name, "seconds": np.inf} | errors(mesh, simple, faces, gaze))
            row["seconds"] = min(row["seconds"], seconds)
    reached = {name: row for name, row in rows.items() if row["outcome"] == "reached"}
    bar = min((row["salient"] for name, row in reached.items() if "meshoptimizer" in name), default=np.nan)
    for row in reached.values():
        row |= {"bar": bar, "salient_ratio": row["salient"] / bar}
    return list(rows.values())


def errors(mesh, simplified, faces, gaze):
    """Errors of one result, and whether it has few enough faces."""
    row = {"outcome": "reached" if len(simplified.faces) <= faces else "missed", "faces": len(simplified.faces)}
    return row | {"metro_mean": metro(mesh, simplified)["mean"], "salient": salient_error(mesh, simplified, gaze)}


def main():
    """Measures everything and writes the table."""
    chosen = arguments(__doc__, archive=GAZE, **{"--meshoptimizer": None})
    if not Path(chosen.archive).exists():
        sys.exit(f"{chosen.archive} is not there: it holds the meshes with gaze")
    meshoptimizer = peers(chosen.meshoptimizer).get("meshoptimizer")
    warm_up()
    rows = []
    for name, mesh, gaze in progress(list(subjects(chosen.archive)), "salient simplification"):
        works = ways(gaze, meshoptimizer)
        for share in SHARES:
            faces = int(share * len(mesh.faces))
            row = {"mesh": name, "share": share, "full": len(mesh.faces), "target": faces}
            rows += [row | columns for columns in cell(mesh, faces, gaze, works)]
        write_table(OUT, pd.DataFrame(rows))
    table = pd.DataFrame(rows).query("outcome == 'reached'")
    print(table.groupby(["share", "method"])[["seconds", "metro_mean", "salient", "salient_ratio"]].median())


if __name__ == "__main__":
    main()

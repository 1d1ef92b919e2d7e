"""Colours in the error: `python -m benchmarks.painted_simplification [GAZE.zip] [--meshoptimizer FILE.js]`

Simplifies painted surfaces to some face counts: a flat square with a straight and with a round step of colour, a ball
of 81,920 faces with a band, with smooth colours and with spots on a ramp, and the meshes with recorded gaze (gaze.zip
in ../shared/data, or the path given) in the colours of their gaze. Ours without colours in the error, and with them at
each weight of WEIGHTS; meshoptimizer's simplifyWithAttributes, which keeps vertices where they are, and its
simplifyWithUpdate, which moves them, at the same weights. Without meshopt_simplifier.js (see _simplify_peers.py) only
ours run.

Writes reports/bench/painted_simplification.csv: a row a surface, face count, method and weight, with the error of the
colours (haptic_glance.lod.errors, of 255), Metro mean, and the processor seconds (the least of ROUNDS, each call with a
mesh not seen before). `ratio` is the error of the colours over the smaller one of meshoptimizer's two at that weight,
where errors below UNSEEN count as equal; `shape_ratio` the Metro mean over the one of the same result.
"""

import time
from pathlib import Path

import numpy as np
import pandas as pd
import trimesh

from benchmarks import arguments
from benchmarks._simplify_peers import peers
from benchmarks.salient_simplification import GAZE, subjects
from haptic_glance.base.files import write_table
from haptic_glance.lod import InfeasibleTarget, SimplifyError, colour_error, metro, simplify
from haptic_glance.mesh.mesh import Mesh
from stages.engine.parallel import progress

OUT = Path("reports/bench/painted_simplification.csv")
WEIGHTS = (0.1, 1.0)
FACES = (1000, 2000, 6000)
ROUNDS = 3
UNSEEN, ROUNDING = 0.01, 1e-7  # of 255, and of the diagonal: errors below count as equal
SIDE, SUBDIVISIONS = 64, 6


def square(paint):
    """A flat square of 2 SIDE^2 faces over 0..1, grey as paint(x, y) in 0..1 says."""
    x, y = np.meshgrid(np.linspace(0, 1, SIDE + 1), np.linspace(0, 1, SIDE + 1), indexing="ij")
    a = np.arange((SIDE + 1) ** 2).reshape(SIDE + 1, SIDE + 1)[:-1, :-1].ravel()
    faces = np.r_[np.c_[a, a + SIDE + 1, a + SIDE + 2], np.c_[a, a + SIDE + 2, a + 1]]
    return coloured(np.c_[x.ravel(), y.ravel(), 0 * x.ravel()], faces, [paint(x.ravel(), y.ravel())] * 3)


def ball(*paints):
    """A ball, its channels as each paint(directions) in 0..1 says; one for all three where there is but one."""
    made = trimesh.creation.icosphere(SUBDIVISIONS)
    channels = [np.asarray(paint(made.vertices), dtype=float) for paint in paints]
    return coloured(made.vertices, made.faces, channels * (3 // len(channels)))


def coloured(vertices, faces, channels):
    """The Mesh, in single precision as meshoptimizer's, with channels of values in 0..1."""
    return Mesh(vertices.astype(np.float32), faces, np.rint(255 * np.stack(channels, axis=1)).astype(np.uint8))


def surfaces(archive):
    """(name, Mesh with colours) of all that is simplified."""
    yield "straight step", square(lambda x, y: x + 0.3 * y < 0.6)
    yield "round step", square(lambda x, y: np.hypot(x - 0.5, y - 0.5) < 0.3)
    yield "band", ball(lambda v: np.abs(v @ [0.6, 0, 0.8]) < 0.2)
    yield "smooth", ball(lambda v: (1 + np.sin(6 * v[:, 0]) * np.cos(5 * v[:, 1])) / 2)
    corners = trimesh.creation.icosahedron().vertices.T
    yield "spots", ball(lambda v: (v @ corners).max(axis=1) > 0.97, lambda v: (1 + v[:, 2]) / 2, lambda v: 0 * v[:, 0])
    if Path(archive).exists():
        for name, mesh, gaze in subjects(archive):
            red = np.sqrt(gaze / gaze.max())  # without the root nearly all is black
            yield f"gaze on {name}", coloured(mesh.vertices, mesh.faces, [red, np.full_like(red, 0.3), 1 - red])


def ways(meshoptimizer):
    """(method, weight, function(mesh, faces)) of all ways to simplify."""
    yield "ours", 0.0, simplify
    for weight in WEIGHTS:
        yield "ours", weight, lambda mesh, faces, w=weight: simplify(mesh, faces, attributes={"colors": w})
        if meshoptimizer:
            for name, update in (("simplifyWithAttributes", False), ("simplifyWithUpdate", True)):
                yield name, weight, lambda mesh, faces, w=weight, u=update: meshoptimizer.painted(mesh, faces, w, u)


def measured(mesh, faces, work):
    """A row of one way, on one mesh and face count."""
    seconds = []
    for _ in range(ROUNDS):
        fresh, start = Mesh(mesh.vertices, mesh.faces, mesh.colors), time.process_time()
        try:
            simple = work(fresh, faces)
        except (InfeasibleTarget, SimplifyError) as refusal:
            return {"note": str(refusal)}
        seconds.append(time.process_time() - start)
    errors = {"colour_error": colour_error(mesh, simple), "metro_mean": metro(mesh, simple)["mean"]}
    return {"faces": len(simple.faces), "seconds": min(seconds)} | errors


def compared(rows):
    """The rows of one surface and face count with the two ratios, where meshoptimizer ran."""
    theirs = [row for row in rows if row["method"] != "ours"]
    for row in rows:
        rivals = [rival for rival in theirs if rival["weight"] == row["weight"]]
        if rivals and "colour_error" in row:
            best = min(rivals, key=lambda rival: rival["colour_error"])
            row["ratio"] = max(row["colour_error"], UNSEEN) / max(best["colour_error"], UNSEEN)
            row["shape_ratio"] = max(row["metro_mean"], ROUNDING) / max(best["metro_mean"], ROUNDING)
    return rows


def main():
    """Measures everything and writes the table."""
    chosen = arguments(__doc__, archive=GAZE, **{"--meshoptimizer": None})
    works = list(ways(peers(chosen.meshoptimizer).get("meshoptimizer")))
    for _, _, work in works:
        work(square(lambda x, y: x), 2000)  # loads compiled code
    rows = []
    for name, mesh in progress(list(surfaces(chosen.archive)), "painted simplification"):
        for faces in FACES:
            head = {"surface": name, "full": len(mesh.faces), "target": faces}
            rows += compared([head | {"method": m, "weight": w} | measured(mesh, faces, work) for m, w, work in works])
        write_table(OUT, pd.DataFrame(rows))
    table = pd.DataFrame(rows)
    figures = ["seconds", "colour_error", "metro_mean", "ratio", "shape_ratio"]
    print(table.groupby(["target", "method", "weight"])[figures].median())


if __name__ == "__main__":
    main()

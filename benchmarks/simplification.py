"""The backends of simplify against each other, from 2,000 to a million faces: `python -m benchmarks.simplification`

Meshes: the Princeton segmentation benchmark (psb.zip in ../shared/data, or the path given). One of each of its classes
as it is, some cut down to 2,000 faces, some subdivided (Loop) to some 200,000 and 900,000; each to three shares of its
faces, the largest to one, with nothing kept and with the three rings around twelve points far from each other. Writes
reports/bench/simplification.csv: a row a mesh, target, kept set and backend. `seconds` is the best of a few runs of the
whole backend, its own check of the result included (pymeshlab_bare: one run of pymeshlab's filter, without check or
second try; fast_simplification keeps nothing). `ratio` and `error_ratio` are those to `pymeshlab` in the same cell;
`kept`: every kept vertex survives bit for bit; `valid`: as many pieces, handles and rim edges as before, and no new
degenerate, folded or non-manifold face. Errors against the input: Metro mean, and 1 - SSIM over the twelve views, of
meshes up to 250,000 faces.
"""

import sys
import time
from pathlib import Path

import fast_simplification
import numpy as np
import pandas as pd
import trimesh

from stages.kit import Mesh
from stages.kit.files import write_table
from stages.kit.parallel import progress
from stages.lod import InfeasibleTarget, SimplifyError, frozen_faces, metro, perceptual
from stages.lod.fast import collapse as fast
from stages.lod.feasibility import smallest_with
from stages.lod.qem import ATTEMPTS, decimated
from stages.lod.qem import collapse as pymeshlab
from stages.lod.topology import faults, topology
from stages.meshes import normalise
from stages.meshes.load import parse
from stages.meshes.sources import PRINCETON, stored_files
from stages.weights.svm_pixels import select_far_points

OUT = Path("reports/bench/simplification.csv")
PSB = "../shared/data/psb.zip"
SHARES = (0.5, 0.1, 0.02)
SMALL, SMALL_OF = 2000, 5  # faces of the small meshes, and how many there are
SUBDIVIDED = {200_000: 2, 900_000: 1}  # faces, and of how many meshes
POINTS = 12
RUNS, LARGE = 2, 100_000  # the best of RUNS runs; of one above LARGE faces
SEEN = 250_000  # faces above which no pictures are taken


def bare(mesh, faces, frozen):
    """One run of pymeshlab's filter."""
    return decimated(mesh, faces, frozen, None, *ATTEMPTS[0])


def unlocked(mesh, faces, frozen):
    """fast_simplification, which cannot keep anything."""
    if frozen.any():
        raise InfeasibleTarget(faces, len(mesh.faces), int(frozen.sum()))
    vertices, left = fast_simplification.simplify(mesh.vertices, mesh.faces.astype(np.int32), target_count=faces)
    return Mesh(vertices, left)


BACKENDS = {"pymeshlab": pymeshlab, "pymeshlab_bare": bare, "fast": fast, "fast_simplification": unlocked}


def meshes(archive):
    """(source, name, Mesh), small to large."""
    files = stored_files(archive, *PRINCETON)
    first = {path.split("/")[1]: path for path in reversed(sorted(files)) if path.endswith(".off")}
    found = {name: normalise(parse(files[path](), ".off")) for name, path in sorted(first.items())}
    by_size = sorted(found, key=lambda name: len(found[name].faces))
    for name in by_size[:: -(len(by_size) // SMALL_OF)][:SMALL_OF]:
        mesh = found[name]
        yield "reduced", name, fast(mesh, SMALL, np.zeros(len(mesh.faces), dtype=bool))
    for name in by_size:
        yield "psb", name, found[name]
    for faces, count in SUBDIVIDED.items():
        for name in by_size[-count:]:
            yield "subdivided", name, subdivided(found[name], faces)


def subdivided(mesh, faces):
    """The mesh with each face cut in four, smoothly (Loop), until it has about `faces` or more."""
    vertices, found = mesh.vertices, mesh.faces
    while len(found) < 0.7 * faces:
        vertices, found = trimesh.remesh.subdivide_loop(vertices, found, iterations=1)
    return Mesh(vertices, found)


def cell(mesh, faces, keep):
    """Rows of one cell: every backend on one mesh, target and kept set."""
    frozen = frozen_faces(mesh, keep)
    row = {"full": len(mesh.faces), "target": faces, "kept_points": len(keep)}
    if faces < smallest_with(mesh, frozen):
        return [row | {"backend": name, "note": "infeasible"} for name in BACKENDS]
    rows = [row | {"backend": name} | measured(mesh, faces, frozen, keep, work) for name, work in BACKENDS.items()]
    reference = rows[0]
    for found in rows:
        for name, of in (("ratio", "seconds"), ("error_ratio", "metro_mean")):
            if found.get(of) is not None and reference.get(of):
                found[name] = found[of] / reference[of]
    return rows


def measured(mesh, faces, frozen, keep, work):
    """Time, errors and checks of one backend."""
    try:
        seconds, found = timed(lambda: work(mesh, faces, frozen), 1 if len(mesh.faces) > LARGE else RUNS)
    except (InfeasibleTarget, SimplifyError) as error:
        return {"note": str(error)}
    row = {"seconds": seconds, "faces": len(found.faces), "metro_mean": metro(mesh, found)["mean"]}
    row |= {"kept": survives(mesh.vertices[keep], found.vertices), "valid": valid(mesh, found), "note": ""}
    if len(mesh.faces) <= SEEN:
        try:
            row["ssim_error"] = perceptual(mesh, found)["ssim"]
        except ValueError as error:  # it leaves the frame
            row["note"] = str(error)
    return row


def timed(work, runs):
    """(least seconds of some runs, the result)."""
    best = np.inf
    for _ in range(runs):
        start = time.perf_counter()
        found = work()
        best = min(best, time.perf_counter() - start)
    return best, found


def survives(places, vertices):
    """True where all places (k, 3) are among the vertices, bit for bit."""
    there = {place.tobytes() for place in np.ascontiguousarray(vertices)}
    return all(place.tobytes() in there for place in np.ascontiguousarray(places))


def valid(mesh, found):
    """True where the surface is made of the same things and has no fault that it had not."""
    return topology(found.faces) == topology(mesh.faces) and not faults(found).added(faults(mesh))


def main():
    """Measures everything and writes the table."""
    archive = sys.argv[1] if len(sys.argv) > 1 else PSB
    rows = []
    for source, name, mesh in progress(list(meshes(archive)), "simplification"):
        far = select_far_points(mesh.vertices, POINTS)
        for share in SHARES if len(mesh.faces) <= LARGE else SHARES[1:2]:
            for keep in (far[:0], far):
                found = cell(mesh, int(share * len(mesh.faces)), keep)
                rows += [{"mesh": name, "source": source} | row for row in found]
        write_table(OUT, pd.DataFrame(rows))
    table = pd.DataFrame(rows)
    for label, part in table.groupby(["kept_points", "backend"]):
        times = np.exp(np.log(1 / part["ratio"].astype(float)).mean())
        errors = np.exp(np.log(part["error_ratio"].astype(float)).mean())
        print(*label, f"{times:.1f} times faster, {errors:.3f} times the error", f"{part['valid'].mean():.0%} valid")


if __name__ == "__main__":
    main()

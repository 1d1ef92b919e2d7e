"""The backends of simplify against each other and others': `python -m benchmarks.simplification [PSB.zip]`

Others that are not installed are named and left out; for the newest meshoptimizer, `npm pack meshoptimizer@1.3.0`,
unpack it and add --meshoptimizer package/meshopt_simplifier.js (see _simplify_peers.py).

Meshes: the Princeton segmentation benchmark (psb.zip in ../shared/data, or the path given). One of each of its classes
as it is, some cut down to 2,000 faces, some subdivided (Loop) to 200,000 and to a million; each to three shares of its
faces, those above 100,000 to one; once with nothing kept and once with points far from each other, as many and with as
wide rings as the target leaves room for (KEPT), so that there is a kept set at every size. Writes
reports/bench/simplification.csv.gz: a row a mesh, share, kept set and backend.

`seconds` is the time of the process (all its threads, not that of other programs) in the backend alone, its own check
of the result included; `whole_seconds` that of all of `simplify`, with the kept faces found and the target tested;
`colours_seconds` the same where every vertex has a colour to be carried over. Each is the least of some rounds, in
which the backends take turns, all warmed up before (pymeshlab_bare: one run of pymeshlab's filter, without check or
second try). Each call gets a mesh that was not seen before, so that nothing is kept from one to the next; coordinates
are rounded to single precision, in which some of the others work. The ratios are those to `pymeshlab` in the same cell.
`outcome`: reached; missed: more faces came back than were asked for, so that there are no ratios; refused, by the
backend, the reason in `note`; infeasible: the target was refused before any backend began. `kept`: every kept vertex
survives bit for bit; `valid`: components, genus and boundary edges as before, and no new degenerate, folded or
non-manifold face. Errors against the input: Metro mean and maximum, and 1 - SSIM over the twelve views, of meshes up to
250,000 faces, not of those in UNSEEN.
"""

import functools
import time
from pathlib import Path

import numpy as np
import pandas as pd
import trimesh

from benchmarks import arguments
from benchmarks._simplify_peers import UNABLE, fresh, peers
from haptic_glance.base.files import write_table
from haptic_glance.lod import InfeasibleTarget, SimplifyError, frozen_faces, metro, perceptual, simplify
from haptic_glance.lod.fast import collapse as fast
from haptic_glance.lod.feasibility import smallest_with
from haptic_glance.lod.qem import ATTEMPTS, decimated
from haptic_glance.lod.qem import collapse as pymeshlab
from haptic_glance.lod.topology import faults, topology
from haptic_glance.look.weights.svm import select_far_points
from haptic_glance.mesh import normalise
from haptic_glance.mesh.files import parse
from haptic_glance.mesh.mesh import Mesh
from stages.engine.parallel import progress
from stages.lod.cell import warm_up
from stages.meshes.sources import PRINCETON, collection_files

OUT = Path("reports/bench/simplification.csv.gz")
PSB = "../shared/data/psb.zip"
SHARES = (0.5, 0.1, 0.02)
SMALL, SMALL_OF = 2000, 5  # faces of the small meshes, and how many there are
SUBDIVIDED = {200_000: 3, 1_000_000: 1}  # least faces, and of how many meshes
KEPT = ((12, 3), (12, 2), (12, 1), (6, 1), (3, 1), (3, 0), (1, 0))  # (points, rings), the first that is feasible
ROUNDS, LARGE = 3, 100_000  # a cell is timed this often; above LARGE faces twice
SEEN = 250_000  # faces above which no pictures are taken
UNSEEN = ("meshoptimizer_native", "vtk", "pyfqmr")  # of whose meshes none are taken: they cost more than all the rest
RATIOS = {"ratio": "seconds", "whole_ratio": "whole_seconds", "colours_ratio": "colours_seconds"}
RATIOS |= {"error_ratio": "metro_mean", "largest_ratio": "metro_max"}


def bare(mesh, faces, frozen):
    """One run of pymeshlab's filter."""
    return decimated(mesh, faces, frozen, None, *ATTEMPTS[0])


BACKENDS = {"pymeshlab": pymeshlab, "pymeshlab_bare": bare, "fast": fast}
WHOLE = ("pymeshlab", "fast")  # those that simplify takes


def meshes(archive):
    """(source, name, Mesh), small to large."""
    files = collection_files(archive, *PRINCETON)
    first = {path.split("/")[1]: path for path in reversed(sorted(files)) if path.endswith(".off")}
    named = {name: single(normalise(parse(files[path](), ".off"))) for name, path in sorted(first.items())}
    by_size = sorted(named, key=lambda name: len(named[name].faces))
    for name in by_size[:: -(len(by_size) // SMALL_OF)][:SMALL_OF]:
        mesh = named[name]
        yield "reduced", name, single(fast(mesh, SMALL, np.zeros(len(mesh.faces), dtype=bool)))
    for name in by_size:
        yield "psb", name, named[name]
    for faces, count in SUBDIVIDED.items():
        for name in sorted(named, key=lambda name: 4 ** cuts(named[name], faces) * len(named[name].faces))[:count]:
            yield "subdivided", name, single(subdivided(named[name], faces))


def single(mesh):
    """The mesh with coordinates rounded to single precision."""
    return Mesh(mesh.vertices.astype(np.float32), mesh.faces)


def cuts(mesh, faces):
    """How often each face must be cut in four for the mesh to have `faces` or more."""
    return max(int(np.ceil(np.log(faces / len(mesh.faces)) / np.log(4))), 0)


def subdivided(mesh, faces):
    """The mesh with each face cut in four, smoothly (Loop), until it has `faces` or more."""
    vertices, triangles = mesh.vertices, mesh.faces
    for _ in range(cuts(mesh, faces)):
        vertices, triangles = trimesh.remesh.subdivide_loop(vertices, triangles, iterations=1)
    return Mesh(vertices, triangles)


def kept_set(mesh, far, faces):
    """(vertex ids, rings): the largest of KEPT with which the target is feasible, else the smallest."""
    for points, rings in KEPT:
        if smallest_with(mesh, frozen_faces(mesh, far[:points], rings)) <= faces:
            break
    return far[:points], rings


def cell(mesh, faces, keep, rings):
    """Rows of one cell: every backend on one mesh, target and kept set."""
    frozen = frozen_faces(mesh, keep, rings)
    row = {"full": len(mesh.faces), "target": faces, "kept_points": len(keep), "rings": rings if len(keep) else None}
    able = [name for name in BACKENDS if name not in UNABLE or not len(keep)]
    if faces < smallest_with(mesh, frozen):
        return [row | {"backend": name, "outcome": "infeasible"} for name in able]
    works = {name: lambda work=BACKENDS[name]: work(fresh(mesh), faces, frozen) for name in able}
    tints = np.rint(255 * np.clip(mesh.vertices + 0.5, 0, 1)).astype(np.uint8)
    for column, colours in (("whole", None), ("colours", tints)):
        for name in WHOLE:
            works[f"{column} {name}"] = functools.partial(unseen, mesh, colours, faces, keep, rings, name)
    timed = in_turns(works, 2 if len(mesh.faces) > LARGE else ROUNDS)
    return with_ratios([row | {"backend": name} | measured(mesh, faces, keep, timed, name) for name in able])


def unseen(mesh, colours, *task):
    """All of simplify, on a mesh of its own."""
    return simplify(fresh(mesh, colours), *task)


def with_ratios(rows):
    """The rows of a cell with the RATIOS of those that reached the target to the first, where that reached it."""
    for row in rows:
        for name, of in RATIOS.items():
            if row["outcome"] == rows[0]["outcome"] == "reached" and row.get(of) is not None and rows[0].get(of):
                row[name] = row[of] / rows[0][of]
    return rows


def in_turns(works, rounds):
    """dict name -> (least seconds of the process, what came back or the refusal); one after the other, again and again.

    What refused once is not asked again.
    """
    best = {}
    for _ in range(rounds):
        for name, work in works.items():
            before, known = best.get(name, (np.inf, None))
            if not isinstance(known, ValueError):
                start = time.process_time()
                try:
                    answer = work()
                except (InfeasibleTarget, SimplifyError) as error:
                    answer = error
                best[name] = min(before, time.process_time() - start), answer
    return best


def measured(mesh, faces, keep, timed, name):
    """Time, errors and checks of one backend."""
    seconds, answer = timed[name]
    if isinstance(answer, ValueError):
        return {"outcome": "refused", "note": str(answer)}
    outcome = "reached" if len(answer.faces) <= faces else "missed"
    row = {"outcome": outcome, "seconds": seconds, "faces": len(answer.faces)}
    errors = metro(mesh, answer)
    row |= {"metro_mean": errors["mean"], "metro_max": errors["max"], "valid": valid(mesh, answer), "note": ""}
    row |= {"kept": survives(mesh.vertices[keep], answer.vertices)}
    if name in WHOLE:
        row |= {f"{column}_seconds": timed[f"{column} {name}"][0] for column in ("whole", "colours")}
    if len(mesh.faces) <= SEEN and name not in UNSEEN:
        try:
            row["ssim_error"] = perceptual(mesh, answer)["ssim"]
        except ValueError as error:  # it leaves the frame
            row["note"] = str(error)
    return row


def survives(places, vertices):
    """True where all places (k, 3) are among the vertices, bit for bit."""
    stored = {place.tobytes() for place in np.ascontiguousarray(vertices)}
    return all(place.tobytes() in stored for place in np.ascontiguousarray(places))


def valid(mesh, result):
    """True where the topology is the same and there is no new fault."""
    return topology(result.faces) == topology(mesh.faces) and not faults(result).added(faults(mesh))


def main():
    """Measures everything and writes the table."""
    chosen = arguments(__doc__, archive=PSB, **{"--meshoptimizer": None})
    BACKENDS.update(peers(chosen.meshoptimizer))
    for backend in WHOLE:
        warm_up(backend)
    rows = []
    for source, name, mesh in progress(list(meshes(chosen.archive)), "simplification"):
        far = select_far_points(mesh.vertices, KEPT[0][0])
        for share in SHARES if len(mesh.faces) <= LARGE else SHARES[1:2]:
            faces = int(share * len(mesh.faces))
            for keep, rings in ((far[:0], 0), kept_set(mesh, far, faces)):
                cells = cell(mesh, faces, keep, rings)
                rows += [{"mesh": name, "source": source, "share": share} | row for row in cells]
        write_table(OUT, pd.DataFrame(rows))
    table = pd.DataFrame(rows)
    print(pd.crosstab(table["backend"], table["outcome"]))
    table = table[table["outcome"] == "reached"].assign(with_points=table["kept_points"] > 0)
    for label, part in table.groupby(["with_points", "backend"]):
        ratios = [f"{name} {np.exp(np.log(part[name].astype(float)).mean()):.3f}" for name in RATIOS]
        print(*label, *ratios, f"{part['valid'].mean():.0%} valid")


if __name__ == "__main__":
    main()

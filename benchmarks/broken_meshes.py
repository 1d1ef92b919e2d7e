"""The simplifiers on real broken meshes, those that CGAL tries its repairs on: `python -m benchmarks.broken_meshes`

Fetches Debian's package libcgal-demo once (by `apt-get download`, hash checked; never installed), takes the meshes out
of it, and asks every backend for 4 faces and more, with and without kept vertices, each mesh in a process of its own
with a limit of time and memory. Writes reports/bench/broken_meshes.csv.gz: a row a case, with what the surface is
(faces, pieces, rim edges, flat faces, folds, crowded edges, pinches) and what came of it: valid, refused, ruined or
crash (stages.stability.simplification), with the reason and the seconds. A file that the loader refuses has one row.
Both backends are warmed up before the processes fork, or each would first load compiled code.
"""

import json
import multiprocessing
import os
import resource
import tarfile
import tempfile
from pathlib import Path

import pandas as pd

from benchmarks import arguments
from haptic_glance.base.fetch import cache_folder, debian_files, fetch_debian
from haptic_glance.base.files import write_table
from haptic_glance.lod import BACKENDS
from haptic_glance.mesh import load
from haptic_glance.mesh.files import FORMATS
from stages.engine.parallel import progress
from stages.lod.cell import warm_up
from stages.stability.simplification import run_cases
from stages.stability.surface import Case, QemErrorCurve, Specimen

OUT = Path("reports/bench/broken_meshes.csv.gz")
PACKAGE = "libcgal-demo_5.5.1-2_all.deb"
DIGEST = "78b09b23d4d6d1bf15552a1060b419ab3fc09918486462faed197e5fc6ac3735"
INNER = "usr/share/doc/libcgal-dev/data.tar.gz"
CASES = [Case(budget, kept) for budget in ("4", "64", "256", "50%", "90%") for kept in ("none", "5")]
CASES += [Case("50%", "60"), Case("50%", "half")]
SECONDS, MEMORY = 120, 6 * 2**30  # of one mesh and backend, all cases
LARGEST = 20_000  # faces; above it the cases take minutes each with pymeshlab


def unpacked():
    """The mesh files, taken out of the package into the cache: sorted paths."""
    folder = cache_folder() / "cgal-5.5.1"
    if not folder.exists():
        part = folder.with_suffix(".part")
        part.mkdir(parents=True, exist_ok=True)
        files = debian_files(fetch_debian(PACKAGE, DIGEST))
        inner = next(stream for name, stream in files if name == INNER)
        with tarfile.open(fileobj=inner, mode="r|gz") as stored:
            for member in stored:
                if member.isfile() and Path(member.name).suffix in FORMATS:
                    (part / Path(member.name).name).write_bytes(stored.extractfile(member).read())
        part.rename(folder)
    return sorted(folder.iterdir())


def measure(path, backend, out):
    """Writes the rows of one file and backend to the file `out`, one JSON object a line, as they come."""
    resource.setrlimit(resource.RLIMIT_AS, (MEMORY, MEMORY))
    with open(out, "a", encoding="utf-8") as stream:
        for row in _rows(path, backend):
            print(json.dumps(row), file=stream, flush=True)


def _rows(path, backend):
    try:
        mesh = load(path)
    except ValueError as error:
        yield {"outcome": "not read", "note": str(error)}
        return
    if len(mesh.faces) > LARGEST:
        yield {"has": len(mesh.faces), "outcome": "not tried", "note": f"more than {LARGEST} faces"}
        return
    specimen = Specimen(mesh, QemErrorCurve(mesh), "sound", path.stem, 0)
    look = specimen.surface
    counts = {
        "has": len(mesh.faces),
        "pieces": look.components,
        "rim": len(look.boundary_edges),
        "flat": look.degenerate_faces,
    }
    counts |= {
        "folds": int(look.folds.max()),
        "crowded": look.non_manifold_edges,
        "pinches": look.non_manifold_vertices,
    }
    for case, answer in run_cases(specimen, backend, CASES):
        row = {"budget": case.budget, "kept": case.kept, "asked": answer.asked, "outcome": answer.outcome}
        row |= {"faces": 0 if answer.mesh is None else len(answer.mesh.faces), "error": answer.error}
        yield counts | row | {"note": answer.note, "seconds": answer.seconds}


def rows_of(path, backend):
    """The rows of one file and backend, measured in a process of its own; its death is a row, too."""
    with tempfile.NamedTemporaryFile("r", encoding="utf-8") as out:
        work = multiprocessing.get_context("fork").Process(target=measure, args=(path, backend, out.name))
        work.start()
        work.join(SECONDS)
        end = f"not done in {SECONDS} s" if work.is_alive() else work.exitcode and f"ended with {work.exitcode}"
        if work.exitcode == 1:
            raise RuntimeError(f"{path.stem}, {backend}: the measurement itself failed, see above")
        work.kill()
        work.join()
        rows = [json.loads(line) for line in out]
    if end:
        rows.append({"outcome": "crash", "note": end})
    return [{"mesh": path.stem, "backend": backend} | row for row in rows]


def main():
    """Tries every mesh with every backend and writes the table."""
    arguments(__doc__)
    for backend in BACKENDS:
        warm_up(backend)
    cells = [(path, backend) for path in unpacked() for backend in BACKENDS]
    frame = pd.DataFrame([row for cell in progress(cells, "broken meshes") for row in rows_of(*cell)])
    write_table(OUT, frame)
    print(frame.groupby(["backend", "outcome"]).agg(cases=("outcome", "size"), seconds=("seconds", "sum")))
    bad = frame[frame["outcome"].isin(["ruined", "crash"])]
    print(bad[["mesh", "backend", "budget", "kept", "outcome", "note"]].to_string(index=False))


if __name__ == "__main__":
    os.environ.setdefault("OMP_NUM_THREADS", "1")
    main()

"""Simplifies one mesh and spares the places that people look at.

Reads STL, OBJ, PLY, OFF or GLB and writes the mesh in its own coordinates, with its colours and pictures. An error
counts more the more people look at a place, so that faces go where they matter; nothing is frozen but open borders.
With --neighbourhood the faces around the salient points stay exactly as they are: on 50 household objects that costs
half as much error again over the whole. Prints the errors, beside those of plain quadric edge collapse (QEM) with as
many faces. Without MESH the stage `lod` of the pipeline runs, by the settings of params.yaml.

examples:
  python -m stages.lod bunny.stl --faces 1500 --out small.glb
  python -m stages.lod chair.obj --tolerance 0.2% --up y --out chair_small.obj --picture chair.png
  python -m stages.lod bunny.stl --faces 10% --neighbourhood adaptive --keep 8 --out small.ply
"""

import sys

import numpy as np

from stages.kit import Stopwatch
from stages.meshes import load
from stages.salient_points import find_points, saliency

from .errors_table import NAMES, measured, table
from .export import COLORLESS, painted, write_any
from .feasibility import InfeasibleTarget, SimplifyError, smallest_feasible
from .fewest import fewest_faces
from .kernels.jit import FOLDER
from .neighbourhood import RINGS, neighbourhoods
from .one_mesh import OneMesh, repaired
from .options import check_places, check_way, parser
from .targets import face_count
from .topology import topology
from .variant import PLAIN, SOFT

LEAST_EXTENT = 1e-60  # units: areas, and products of two, fall below the least number near 1e-80


def run(argv):
    """Does what the command line `argv`, without the program's name, asks for."""
    chosen = parser(__doc__).parse_args(argv)
    check_places(chosen)
    check_way(chosen)
    if not any(FOLDER.rglob("*.nbc")):
        say("the first run on a machine compiles the simplifier, which takes a minute")
    try:
        one = prepare(read(chosen.mesh), chosen)
        found = reduced(one, chosen)
    except ValueError as error:
        raise ValueError(f"{chosen.mesh}: {error}").with_traceback(error.__traceback__) from None
    write_any(chosen.out, one.restored(found))
    print(summary(one, found, chosen))
    if chosen.picture:
        from .picture import write_picture  # brings matplotlib, which nothing else here needs

        points = one.points[one.survivors(found)]
        write_picture(chosen.picture, one.seen(one.mesh), one.seen(found), one.saliency, points)
    print("written: " + ", ".join(str(path) for path in (chosen.out, chosen.picture) if path))
    if chosen.out.suffix.lower() in COLORLESS and (one.given.texture or one.given.colors is not None):
        say(f"{chosen.out.suffix} holds no colours: write .glb, .obj or .ply to keep them")


def read(path):
    """The repaired mesh of a file; ValueError where it cannot be used."""
    if not path.is_file():
        raise ValueError("is a folder, not a mesh" if path.is_dir() else "no such file")
    say(f"reading {path.name}")
    mesh = load(path)
    extent = np.ptp(mesh.vertices, axis=0).max()
    if extent < LEAST_EXTENT:
        raise ValueError(f"its extent is {extent:g}: write it in smaller units, or with more digits")
    mesh, notes = repaired(mesh)
    say(number(len(mesh.faces), "face") + "".join(f"; {note}" for note in notes))
    return mesh


def prepare(mesh, chosen):
    """The OneMesh: where people look at it, and the points to keep."""
    up = chosen.up or ("y" if chosen.mesh.suffix.lower() == ".glb" else "z")
    asked, target = chosen.faces, len(mesh.faces)
    if asked and face_count(asked, target, "--faces") >= target:
        raise ValueError(f"--faces {asked}: the object has only {number(target, 'face')}, nothing to take away")
    looked = painted(mesh)
    say(f"looking at it from twelve sides, {up} up" + ("" if chosen.up else " (else say --up)"))
    method = "enhanced" if chosen.method == PLAIN else chosen.method
    with Stopwatch() as watch:
        seen = saliency(looked, method, up=up)
    say(f"saliency by {method} in {watch.seconds:.1f} s")
    points = np.zeros(0, dtype=np.int64)
    if chosen.neighbourhood != SOFT:
        points = find_points(looked, method, chosen.keep, up=up, seed=chosen.seed, name=chosen.mesh.stem)
        say(f"around {number(len(points), 'point')} the faces stay as they are")
    way = "fixed" if chosen.neighbourhood == SOFT else chosen.neighbourhood
    rings = neighbourhoods(mesh, points, way, seen, RINGS if chosen.rings is None else chosen.rings)
    soft = chosen.neighbourhood == SOFT and chosen.method != PLAIN
    return OneMesh(mesh, up, seen, points, rings, seen if soft else None, chosen.backend, chosen.shrink)


def reduced(one, chosen):
    """The Mesh with the faces, or within the tolerance, that were asked for."""
    say("simplifying")
    try:
        if chosen.tolerance is None:
            return one.simplified(face_count(chosen.faces, len(one.mesh.faces), "--faces"))
        found = fewest_faces(one.mesh, one.simplified, one.least, chosen.tolerance, chosen.seed, say)
    except InfeasibleTarget as error:
        raise ValueError(infeasible(one, error, chosen)) from None
    if found is one.mesh:
        say("no fewer faces stay within the tolerance: the mesh is written with all of them")
    return found


def infeasible(one, error, chosen):
    """What to tell a person whose target is too low: what is in the way, and what can be had."""
    said = [f"{number(error.frozen, 'face')} around {number(len(one.points), 'point')}"] if error.frozen else []
    if len(one.open_border):
        said.append(f"{number(len(one.open_border), 'edge')} of open borders")
    why = f", since {' and '.join(said)} stay as they are" if said else ""
    ways = remedies(one, error, chosen) or ["nothing can be taken away"]
    return f"{number(error.faces, 'face')} cannot be had{why}: {', or '.join(ways)}"


def remedies(one, error, chosen):
    """What a person may do about it, none where nothing would help."""
    total = len(one.mesh.faces)
    if smallest_feasible(one.mesh) >= total:  # not even with nothing frozen
        return ["join its pieces first"] if len(one.open_border) and topology(one.mesh.faces).pieces > 1 else []
    ways = [f"ask for --faces {error.smallest} or more"] if error.smallest < total else []
    if error.frozen and len(one.points) > 1:
        ways += ["--keep fewer points"]
    if error.frozen and chosen.neighbourhood == "fixed" and one.rings.any():
        ways += ["take fewer --rings"]
    if error.frozen:
        ways += [*(() if one.shrink else ("let them --shrink",)), "leave --neighbourhood out"]
    return ways


def summary(one, found, chosen):
    """The table that the command prints."""
    rivals = [] if chosen.method == PLAIN else [plain(one, len(found.faces))]
    meshes = [found, *(rival for rival in rivals if rival is not None)]
    say("measuring the errors")
    errors = measured(one, meshes, chosen.seed, say)
    rest = [None] * (len(meshes) - 1)
    rows = [("faces", len(one.mesh.faces), *(len(mesh.faces) for mesh in meshes))]
    if len(one.points):
        rows += [("points kept", len(one.points), int(one.survivors(found).sum()), *rest)]
    if len(one.border):
        rows += [("border edges kept", len(one.border), one.held(found), *rest)]
    if len(one.points) or len(one.border):
        rows += [("fewest faces that keep them", None, one.smallest_with_borders, *rest)]
    rows += [(NAMES[name], None, *(each[name] for each in errors)) for name in NAMES]
    return table(["before", way(chosen), *["plain QEM"] * len(rest)], rows)


def way(chosen):
    """The name of what was done, as the stage `lod` has it."""
    return PLAIN if chosen.method == PLAIN else f"{chosen.method}-{chosen.neighbourhood}"


def plain(one, faces):
    """The Mesh of as many faces by plain QEM; None where there is none that is sound, which is said."""
    try:
        return one.plain(faces)
    except (InfeasibleTarget, SimplifyError) as error:
        say(f"no plain QEM beside it: {error}")
        return None


def number(count, word):
    """`1 face`, `1,280 faces`."""
    return f"{count:,} {word}{'' if count == 1 else 's'}"


def say(text):
    """Progress, apart from the results."""
    print(f"lod: {text}", file=sys.stderr, flush=True)

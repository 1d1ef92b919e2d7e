"""Simplifies one mesh and keeps the places that people look at as they are.

Reads STL, OBJ, PLY, OFF or GLB, finds the salient points, simplifies with their neighbourhoods kept, and writes the
mesh in its own coordinates, with its colours and pictures. Prints the errors, beside those of plain quadric edge
collapse (QEM) with as many faces. Without MESH the stage `lod` of the pipeline runs, by the settings of params.yaml.

examples:
  python -m stages.lod bunny.stl --faces 1500 --out small.glb
  python -m stages.lod bunny.stl --faces 10% --keep 8 --out small.ply --picture saliency.png
  python -m stages.lod chair.obj --tolerance 0.2% --neighbourhood adaptive --up y --out chair_small.obj
"""

import argparse
import re
import sys
from pathlib import Path

import numpy as np

from stages.kit import Stopwatch
from stages.kit.run import errors_in_one_line
from stages.meshes import MeshError, clean, load
from stages.meshes.normalise import TO_Z_UP
from stages.salient_points import find_points, saliency

from .errors_table import NAMES, measured, table
from .export import COLORLESS, FORMATS, painted, write_any
from .feasibility import InfeasibleTarget, SimplifyError
from .fewest import fewest_faces
from .neighbourhood import RINGS, WAYS, neighbourhoods
from .one_mesh import OneMesh
from .picture import check_picture, write_picture
from .simplify import BACKEND, BACKENDS
from .targets import face_count
from .variant import PLAIN, SOFT


def run(argv):
    """Does what the command line `argv`, without the program's name, asks for."""
    chosen = parser().parse_args(argv)
    errors_in_one_line("lod")
    check_places(chosen)
    one = prepare(read(chosen.mesh), chosen)
    found = reduced(one, chosen)
    write_any(chosen.out, one.restored(found))
    print(summary(one, found, chosen))
    if chosen.picture:
        points = one.points[one.survivors(found)]
        write_picture(chosen.picture, one.seen(one.mesh), one.seen(found), one.saliency, points)
    print("written: " + ", ".join(str(path) for path in (chosen.out, chosen.picture) if path))
    if chosen.out.suffix.lower() in COLORLESS and (one.given.texture or one.given.colors is not None):
        say(f"{chosen.out.suffix} holds no colours: write .glb, .obj or .ply to keep them")


def parser():
    """The command line."""
    first, _, rest = __doc__.partition("\n")
    form = argparse.RawDescriptionHelpFormatter
    made = argparse.ArgumentParser("python -m stages.lod", description=first, epilog=rest, formatter_class=form)
    made.add_argument("mesh", metavar="MESH", type=Path, help="the file to simplify")
    target = made.add_mutually_exclusive_group(required=True)
    target.add_argument("--faces", metavar="N", help="how many faces to have: 1500, or a share such as 10%%")
    help_tolerance = "the fewest faces with a Metro mean error of at most so much of the diagonal: 0.2%%"
    target.add_argument("--tolerance", metavar="SHARE", type=share, help=help_tolerance)
    made.add_argument("--out", metavar="FILE", type=Path, required=True, help=f"the result: {', '.join(FORMATS)}")
    made.add_argument("--picture", metavar="FILE", type=Path, help="a picture of the saliency, and of before and after")
    made.add_argument("--method", default="enhanced", help="who finds the points (default: enhanced; qem: nobody)")
    made.add_argument("--keep", metavar="N", type=int, help="how many points (default: those past the threshold)")
    ways = [*WAYS, SOFT]
    help_ways = f"how much around a point stays: {RINGS} rings, or by the mesh's density, or by the salient area; soft:"
    help_ways += " nothing is frozen, the saliency weighs the error (default: fixed)"
    made.add_argument("--neighbourhood", choices=ways, default="fixed", help=help_ways)
    made.add_argument("--rings", metavar="N", type=int, default=RINGS, help="rings of `fixed` (default: %(default)s)")
    made.add_argument("--shrink", action="store_true", help="smaller neighbourhoods where N faces are too few for all")
    made.add_argument("--up", choices=list(TO_Z_UP), help="the axis that points up (default: y for a glb, else z)")
    made.add_argument("--backend", choices=list(BACKENDS), default=BACKEND, help="default: %(default)s")
    made.add_argument("--seed", type=int, default=0, help="of the samples of the errors (default: %(default)s)")
    return made


def share(text):
    """A share of the diagonal from `0.2%` or `0.002`."""
    match = re.fullmatch(r"(\d*\.?\d+(?:e-?\d+)?)(%?)", text.strip(), re.IGNORECASE)
    value = float(match[1]) / (100 if match[2] else 1) if match else np.inf
    if not value < 1:
        raise argparse.ArgumentTypeError(f"{text!r} is no share of the diagonal: write one like 0.2% or 0.002")
    return value


def check_places(chosen):
    """Raises ValueError before any work where the result or the picture could not be written."""
    if chosen.out.suffix.lower() not in FORMATS:
        raise ValueError(f"--out {chosen.out}: meshes are written as {', '.join(FORMATS)}")
    for path in filter(None, (chosen.out, chosen.picture)):
        if not path.absolute().parent.is_dir():
            raise ValueError(f"{path}: no such folder {path.parent}")
    if chosen.picture:
        check_picture(chosen.picture)
    if chosen.keep is not None and chosen.keep < 0:
        raise ValueError(f"--keep {chosen.keep}: give 0 or more points")


def read(path):
    """The repaired mesh of a file; ValueError that names it where it cannot be used."""
    try:
        mesh, notes = clean(load(path))
    except MeshError as error:
        raise ValueError(f"{path}: {error}") from None
    say(f"{path.name}: {len(mesh.faces):,} faces" + "".join(f"; {note}" for note in notes))
    return mesh


def prepare(mesh, chosen):
    """The OneMesh: where people look at it, and the points to keep."""
    up = chosen.up or ("y" if chosen.mesh.suffix.lower() == ".glb" else "z")
    asked, target = chosen.faces, len(mesh.faces)
    if asked and face_count(asked, target) >= target:
        raise ValueError(f"--faces {asked}: the object has only {target} faces")
    looked = painted(mesh)
    say(f"looking at it from twelve sides ({up} is up)")
    method = "enhanced" if chosen.method == PLAIN else chosen.method
    with Stopwatch() as watch:
        seen = saliency(looked, method, up=up)
        points = np.zeros(0, dtype=np.int64)
        if chosen.method != PLAIN and chosen.keep != 0:
            points = find_points(looked, method, chosen.keep, up=up, seed=chosen.seed, name=chosen.mesh.stem)
    say(f"{len(points)} points by {chosen.method} in {watch.seconds:.1f} s; simplifying")
    soft = chosen.neighbourhood == SOFT
    if soft:
        points = points[:0]
    rings = neighbourhoods(mesh, points, "fixed" if soft else chosen.neighbourhood, seen, chosen.rings)
    return OneMesh(mesh, up, seen, points, rings, seen if soft else None, chosen.backend, chosen.shrink)


def reduced(one, chosen):
    """The Mesh with the faces, or within the tolerance, that were asked for."""
    try:
        if chosen.tolerance is None:
            return one.simplified(face_count(chosen.faces, len(one.mesh.faces)))
        return fewest_faces(one.mesh, one.simplified, one.least, chosen.tolerance, chosen.seed, say)
    except InfeasibleTarget as error:
        ways = "" if chosen.shrink else ", or --shrink the neighbourhoods, or --keep fewer points"
        raise ValueError(f"{error}: ask for {error.smallest} or more{ways}") from None


def summary(one, found, chosen):
    """The table that the command prints."""
    rivals = [] if chosen.method == PLAIN else [plain(one, len(found.faces))]
    meshes = [found, *(rival for rival in rivals if rival is not None)]
    say("measuring the errors")
    errors = measured(one, meshes, chosen.seed)
    rest = [None] * (len(meshes) - 1)
    rows = [("faces", len(one.mesh.faces), *(len(mesh.faces) for mesh in meshes))]
    if len(one.points):
        rows += [("points kept", len(one.points), int(one.survivors(found).sum()), *rest)]
    rows += [("smallest feasible", None, one.smallest, *rest)]
    rows += [(NAMES[name], None, *(each[name] for each in errors)) for name in NAMES]
    return table(["before", chosen.method, *["plain QEM"] * len(rest)], rows)


def plain(one, faces):
    """The Mesh of as many faces by plain QEM; None where there is none that is sound, which is said."""
    try:
        return one.plain(faces)
    except (InfeasibleTarget, SimplifyError) as error:
        say(f"no plain QEM beside it: {error}")
        return None


def say(text):
    """Progress, apart from the results."""
    print(f"lod: {text}", file=sys.stderr, flush=True)

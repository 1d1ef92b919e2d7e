"""What `python -m stages.lod MESH` may be asked for, and what is refused before any work."""

import argparse
import os
import re
from pathlib import Path

import numpy as np

from stages.meshes.normalise import TO_Z_UP
from stages.salient_points import METHODS
from stages.salient_points.methods import teachable
from stages.weights import Learned

from .export import FORMATS
from .neighbourhood import RINGS, WAYS
from .simplify import BACKEND, BACKENDS
from .targets import face_count
from .variant import PLAIN, SOFT


def parser(about):
    """The command line; about: what --help says, its first line at the top."""
    first, _, rest = about.partition("\n")
    form = argparse.RawDescriptionHelpFormatter
    made = argparse.ArgumentParser("python -m stages.lod", description=first, epilog=rest, formatter_class=form)
    made.add_argument("mesh", metavar="MESH", type=Path, help="the file to simplify")
    target = made.add_mutually_exclusive_group(required=True)
    target.add_argument("--faces", metavar="N", help="how many faces to have: 1500, or a share such as 10%%")
    help_tolerance = "the fewest faces with a Metro mean error of at most so much of the diagonal: 0.2%%"
    target.add_argument("--tolerance", metavar="SHARE", type=share, help=help_tolerance)
    made.add_argument("--out", metavar="FILE", type=Path, required=True, help=f"the result: {', '.join(FORMATS)}")
    made.add_argument("--picture", metavar="FILE", type=Path, help="a picture of the saliency, and of before and after")
    help_method = "whose saliency, and whose points (default: enhanced; qem: nobody's, every place counts the same)"
    made.add_argument("--method", default="enhanced", help=help_method)
    help_ways = "soft: the saliency weighs the error, nothing is frozen (default); the others freeze the faces around"
    help_ways += f" the salient points, within {RINGS} rings, or by the mesh's density, or by the salient area"
    made.add_argument("--neighbourhood", choices=[SOFT, *WAYS], default=SOFT, help=help_ways)
    help_keep = "how many points to freeze the faces around (default: those past the method's threshold)"
    made.add_argument("--keep", metavar="N", type=int, help=help_keep)
    made.add_argument("--rings", metavar="N", type=int, help=f"rings of --neighbourhood fixed (default: {RINGS})")
    made.add_argument("--shrink", action="store_true", help="freeze fewer faces where N is too low for all of them")
    made.add_argument("--up", choices=list(TO_Z_UP), help="the axis that points up (default: y for a glb, else z)")
    made.add_argument("--backend", choices=list(BACKENDS), default=BACKEND, help="default: %(default)s")
    made.add_argument("--seed", type=int, default=0, help="of the samples of the errors (default: %(default)s)")
    return made


def share(text):
    """A share of the diagonal from `0.2%` or `0.002`."""
    match = re.fullmatch(r"(\d*\.?\d+(?:e-?\d+)?)(%?)", text.strip(), re.IGNORECASE)
    value = float(match[1]) / (100 if match[2] else 1) if match else np.inf
    if value == 0:
        reason = "rounding alone is more than 0: allow a little, such as 0.001%"
        raise argparse.ArgumentTypeError(f"{text!r}: {reason}")
    if not value < 1:
        raise argparse.ArgumentTypeError(f"{text!r} is no share of the diagonal: write one like 0.2% or 0.002")
    return value


def check_places(chosen):
    """Raises ValueError before any work where the result or the picture could not be written, or over the mesh."""
    if chosen.out.suffix.lower() not in FORMATS:
        raise ValueError(f"--out {chosen.out}: meshes are written as {', '.join(FORMATS)}")
    for path in filter(None, (chosen.out, chosen.picture)):
        if path.is_dir():
            raise ValueError(f"{path} is a folder: name a file")
        if not path.absolute().parent.is_dir():
            raise ValueError(f"{path}: no such folder {path.parent}")
        if not os.access(path.absolute().parent, os.W_OK):
            raise ValueError(f"{path}: nothing can be written to {path.parent}")
        if path.exists() and chosen.mesh.exists() and path.samefile(chosen.mesh):
            raise ValueError(f"{path} is the mesh itself, which would be lost: write to another file")
    if chosen.picture:
        from .picture import check_picture  # brings matplotlib, which nothing else here needs

        check_picture(chosen.picture)


def check_way(chosen):
    """Raises ValueError for options that would change nothing together, unknown methods, and counts that are none."""
    if chosen.faces:
        face_count(chosen.faces, 1, "--faces")
    if chosen.seed < 0:
        raise ValueError(f"--seed {chosen.seed}: give 0 or more")
    check_method(chosen.method)
    hard = {"--keep": chosen.keep, "--rings": chosen.rings, "--shrink": chosen.shrink or None}
    given = next((name for name, value in hard.items() if value is not None), None)
    if chosen.method == PLAIN and (given or chosen.neighbourhood != SOFT):
        raise ValueError(f"{given or '--neighbourhood'} does nothing with --method {PLAIN}, which keeps no place")
    if given and chosen.neighbourhood == SOFT:
        remedy = f"add --neighbourhood {' or '.join(WAYS)}, or leave it out"
        raise ValueError(f"{given} does nothing where no faces are frozen: {remedy}")
    if chosen.rings is not None and chosen.neighbourhood != "fixed":
        raise ValueError(f"--rings does nothing with --neighbourhood {chosen.neighbourhood}: it is for fixed")
    if chosen.keep is not None and chosen.keep < 1:
        raise ValueError(f"--keep {chosen.keep}: give 1 or more points; --method {PLAIN} keeps none")
    if chosen.rings is not None and chosen.rings < 0:
        raise ValueError(f"--rings {chosen.rings}: give 0 (the faces that touch a point) or more")


def check_method(method):
    """Raises ValueError for a method that cannot say where people look at a mesh that the pipeline has not seen."""
    runs, others = teachable(METHODS, Learned())
    usable = [PLAIN, *(name for name in runs if hasattr(METHODS[name], "saliency"))]
    if method in usable:
        return
    reason = "there is no such method"
    if method in METHODS:
        reason = "it learns from the pipeline's objects" if method in others else "it looks at nothing"
    raise ValueError(f"--method {method}: {reason}; choose one of {', '.join(usable)}")

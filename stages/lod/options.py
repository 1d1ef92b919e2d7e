"""The command line of `haptic-glance simplify MESH`, and its checks before any work."""

import argparse
import os
import re
from pathlib import Path

import numpy as np

from stages.meshes.up import add_up
from stages.salient_points.names import HELP, check_name

from .export import FORMATS
from .levels import levels
from .neighbourhood import NEIGHBOURHOODS, RINGS
from .simplify import BACKEND, BACKENDS
from .targets import face_count
from .variant import PLAIN, SOFT

LEAST_PERCENT = 0.01  # a bare tolerance from here on is more likely one in percent: few want 1 % of the diagonal


def parser(about: str) -> argparse.ArgumentParser:
    """The parser; about: the text of --help, whose first line comes first."""
    first, _, rest = about.partition("\n")
    form = argparse.RawDescriptionHelpFormatter
    command = argparse.ArgumentParser("haptic-glance simplify", description=first, epilog=rest, formatter_class=form)
    command.add_argument("mesh", metavar="MESH", type=Path, help="the file to simplify, or a folder of files")
    target = command.add_mutually_exclusive_group(required=True)
    help_levels = "several results from one look: face counts or shares, such as 50%%,25%%,10%%"
    target.add_argument("--levels", metavar="N,N,...", type=levels, help=help_levels)
    target.add_argument("--faces", metavar="N", help="target face count: 1500, or a share such as 10%%")
    help_tolerance = "the fewest faces with a Metro mean error of at most this share of the diagonal: 0.2%%, or 0.002"
    help_tolerance += f" (from {LEAST_PERCENT:g} on the sign is required: 0.2 could mean 20%% or 0.2%%)"
    target.add_argument("--tolerance", metavar="SHARE", type=share, help=help_tolerance)
    help_out = f"the result: {', '.join(FORMATS)}; with --levels, or of a folder: the folder for them"
    command.add_argument("--out", metavar="PATH", type=Path, required=True, help=help_out)
    help_format = "of the files in that folder (default: that of the mesh, or glb)"
    command.add_argument("--format", choices=[suffix[1:] for suffix in FORMATS], help=help_format)
    command.add_argument(
        "--picture", metavar="FILE", type=Path, help="also draw the saliency, and the mesh before and after"
    )
    help_method = f"whose saliency and points: {HELP}; qem: nobody's, every place has the same weight"
    command.add_argument("--method", default="glance", help=help_method)
    help_ways = "soft: the saliency weights the error, nothing is frozen (default); the others freeze the faces around"
    help_ways += f" the salient points, within {RINGS} rings, or by the mesh's density, or by the salient area"
    command.add_argument("--neighbourhood", choices=[SOFT, *NEIGHBOURHOODS], default=SOFT, help=help_ways)
    help_keep = "how many points to freeze the faces around (default: those past the method's threshold)"
    command.add_argument("--keep", metavar="N", type=int, help=help_keep)
    command.add_argument("--rings", metavar="N", type=int, help=f"rings of --neighbourhood fixed (default: {RINGS})")
    command.add_argument(
        "--shrink", action="store_true", help="freeze fewer faces where the target is too low for all of them"
    )
    help_weights = "what the error counts beside the shape, and how much: colors=1,uv=1,normals=0.03 or some of them;"
    help_weights += " with colors=1, black and white differ as much as two ends of the mesh (default: nothing)"
    command.add_argument(
        "--attributes", metavar="NAME=WEIGHT,...", type=attribute_weights, default={}, help=help_weights
    )
    help_borders = "simplify the boundary, too: for scans and open surfaces, whose edges stay as they are otherwise"
    command.add_argument("--free-borders", action="store_true", help=help_borders)
    add_up(command)
    command.add_argument("--backend", choices=list(BACKENDS), default=BACKEND, help="default: %(default)s")
    command.add_argument("--json", action="store_true", help="print the figures as JSON")
    command.add_argument("--seed", type=int, default=0, help="for the samples of the errors (default: %(default)s)")
    return command


def share(text: str) -> float:
    """A share of the diagonal from `0.2%` or `0.002`; a bare number that may well be one in percent is refused."""
    match = re.fullmatch(r"(\d*\.?\d+(?:e-?\d+)?)(%?)", text.strip(), re.IGNORECASE)
    value = float(match[1]) / (100 if match[2] else 1) if match else np.inf
    if value == 0:
        reason = "rounding alone exceeds 0: allow a little, such as 0.001%"
        raise argparse.ArgumentTypeError(f"{text!r}: {reason}")
    if match and not match[2] and value >= LEAST_PERCENT:
        percent = f"{100 * value:g}%, " if value < 1 else ""
        raise argparse.ArgumentTypeError(f"{text!r}: write {percent}{match[1]}% or what else of the diagonal is meant")
    if not value < 1:
        raise argparse.ArgumentTypeError(f"{text!r} is not a share of the diagonal: write one like 0.2% or 0.002")
    return value


def attribute_weights(text: str) -> dict[str, float]:
    """Weights by name from `colors=1,uv=0.5`; which ones a mesh has shows later."""
    try:
        return {name.strip(): float(weight) for name, weight in (pair.split("=") for pair in text.split(","))}
    except ValueError:
        raise argparse.ArgumentTypeError(f"{text!r}: write names and weights such as colors=1,uv=0.5") from None


def check_paths(chosen: argparse.Namespace) -> None:
    """Raises ValueError where the result or the picture cannot be written, or would overwrite the mesh."""
    if not one_file(chosen):
        check_folder(chosen)
    elif chosen.out.suffix.lower() not in FORMATS:
        raise ValueError(f"--out {chosen.out}: meshes are written as {', '.join(FORMATS)}")
    elif chosen.format:
        raise ValueError("--format is for the files in a folder: --out says that of one file")
    check_outputs(chosen.mesh, chosen.out if one_file(chosen) else None, chosen.picture)
    if chosen.picture:
        from .picture import check_picture  # brings matplotlib, which nothing else here needs

        check_picture(chosen.picture)


def one_file(chosen: argparse.Namespace) -> bool:
    """Whether --out is a file, and not the folder of several."""
    return not chosen.levels and not chosen.mesh.is_dir()


def targets(chosen: argparse.Namespace) -> list[str]:
    """The face counts asked for; of a tolerance one text that names it."""
    return chosen.levels or [chosen.faces or f"within_{100 * chosen.tolerance:g}%"]


def check_folder(chosen: argparse.Namespace) -> None:
    """Raises ValueError where --out is no folder, or not another one than that of the meshes."""
    if chosen.out.is_file() or chosen.out.suffix.lower() in FORMATS:
        raise ValueError(f"--out {chosen.out}: name a folder, since there are several results")
    if chosen.out.resolve() == (chosen.mesh if chosen.mesh.is_dir() else chosen.mesh.parent).resolve():
        raise ValueError(f"--out {chosen.out} is the folder of the meshes: name another one")
    if chosen.picture:
        raise ValueError("--picture is for one result")


def check_outputs(mesh: Path, *paths: Path | None) -> None:
    """Raises ValueError where one of the paths cannot be written, or would overwrite the mesh."""
    for path in filter(None, paths):
        if path.is_dir():
            raise ValueError(f"{path} is a folder: name a file")
        if not path.absolute().parent.is_dir():
            raise ValueError(f"{path}: no such folder {path.parent}")
        if not os.access(path.absolute().parent, os.W_OK):
            raise ValueError(f"{path}: the folder {path.parent} is not writable")
        if path.exists() and mesh.exists() and path.samefile(mesh):
            raise ValueError(f"{path} is the mesh itself, which would be overwritten: write to another file")


def check_options(chosen: argparse.Namespace) -> None:
    """Raises ValueError for options without effect, unknown methods, and invalid counts."""
    if chosen.faces:
        face_count(chosen.faces, 1, "--faces")
    if chosen.seed < 0:
        raise ValueError(f"--seed {chosen.seed}: give 0 or more")
    check_name(chosen.method, [PLAIN])
    freezing = {"--keep": chosen.keep, "--rings": chosen.rings, "--shrink": chosen.shrink or None}
    given = next((name for name, value in freezing.items() if value is not None), None)
    if chosen.method == PLAIN and (given or chosen.neighbourhood != SOFT):
        raise ValueError(f"{given or '--neighbourhood'} has no effect with --method {PLAIN}, which freezes nothing")
    if given and chosen.neighbourhood == SOFT:
        remedy = f"add --neighbourhood {' or '.join(NEIGHBOURHOODS)}, or leave it out"
        raise ValueError(f"{given} has no effect where no faces are frozen: {remedy}")
    if chosen.attributes and chosen.backend == "pymeshlab":
        raise ValueError("--attributes has no effect with --backend pymeshlab: choose fast or qslim")
    if chosen.free_borders and (chosen.attributes or chosen.backend == "pymeshlab"):
        given = "--attributes" if chosen.attributes else "--backend pymeshlab"
        raise ValueError(f"--free-borders has no effect with {given}: leave one of them out")
    if chosen.rings is not None and chosen.neighbourhood != "fixed":
        raise ValueError(f"--rings has no effect with --neighbourhood {chosen.neighbourhood}: it is for fixed")
    if chosen.keep is not None and chosen.keep < 1:
        raise ValueError(f"--keep {chosen.keep}: give 1 or more points; --method {PLAIN} keeps none")
    if chosen.rings is not None and chosen.rings < 0:
        raise ValueError(f"--rings {chosen.rings}: give 0 (the faces that touch a point) or more")

"""What `python -m stages.imprints MESH` may be asked for, and what is refused before any work."""

import argparse
import os
import re
from dataclasses import fields
from pathlib import Path

from stages.meshes.normalise import TO_Z_UP
from stages.salient_points.methods import METHODS, teachable
from stages.weights import Learned

from .contact import CONTACTS
from .distances import check_sensor
from .skin import Skin

WAYS = ("salient", "random")  # of choosing the places, which --count goes with
COUNT = 6
POINT = re.compile(r"-?[\d.][^,]*,[^,]+,[^,]+")  # a position, which may begin as an option does


def parser(about):
    """The command line; about: what --help says, its first line at the top."""
    first, _, rest = about.partition("\n")
    form = argparse.RawDescriptionHelpFormatter
    usage = "%(prog)s MESH [--at PLACE ...] [options]"
    made = argparse.ArgumentParser("python -m stages.imprints", usage, first, rest, formatter_class=form)
    made.add_argument("mesh", metavar="MESH", type=Path, help="the file to touch: STL, OBJ, PLY, OFF or GLB")
    help_at = "where: salient (default), random, ids of vertices, or positions x,y,z in the file's coordinates"
    made.add_argument("--at", metavar="PLACE", nargs="+", default=[WAYS[0]], help=help_at)
    help_cells = "of the array (default: 16 16)"
    made.add_argument("--cells", metavar=("ROWS", "COLS"), nargs=2, type=int, default=[16, 16], help=help_cells)
    help_pitch = "from cell to cell, in units of the object, whose bounding sphere is 1 across (default: %(default)s)"
    made.add_argument("--pitch", metavar="UNITS", type=float, default=0.01, help=help_pitch)
    help_count = f"how many places to choose, salient or random (default: {COUNT})"
    made.add_argument("--count", metavar="N", type=int, help=help_count)
    made.add_argument("--method", help="who says what is salient (default: enhanced, our model of human gaze)")
    help_contact = "tangent: the array stands at the place (default); rigid: it rests on what it meets first"
    made.add_argument("--contact", choices=CONTACTS, default=CONTACTS[0], help=help_contact)
    help_depth = "how deep the object goes into the skin at its highest point (default: each imprint's own relief)"
    made.add_argument("--depth", metavar="UNITS", type=float, help=help_depth)
    names = ", ".join(field.name for field in fields(Skin) if field.name != "seed")
    help_skin = f"faults of a real sensor, such as blur=0.8,noise=0.02; of {names}"
    made.add_argument("--skin", metavar="NAME=VALUE,...", help=help_skin)
    made.add_argument("--up", choices=list(TO_Z_UP), help="the axis that points up (default: y for a glb, else z)")
    made.add_argument("--seed", type=int, default=0, help="of random places and of the skin (default: %(default)s)")
    made.add_argument("--out", metavar="FOLDER", type=Path, help="for what is written (default: MESH_imprints)")
    made.add_argument("--show", action="store_true", help="open the picture in a window as well")
    return made


def parse(about, argv):
    """The options of a command line, checked; a position that begins with a minus is no option."""
    chosen = parser(about).parse_args([f" {word}" if POINT.fullmatch(word) else word for word in argv])
    check_sensor(chosen.cells, chosen.pitch)
    if chosen.pitch >= 1 and max(chosen.cells) > 1:
        raise ValueError(f"--pitch {chosen.pitch:g} is larger than the object, which is 1 unit across: try 0.01")
    if chosen.depth is not None and not 0 < chosen.depth < float("inf"):
        raise ValueError(f"--depth {chosen.depth:g}: give a positive number of units")
    if chosen.seed < 0:
        raise ValueError(f"--seed {chosen.seed}: give 0 or more")
    _check_choice(chosen)
    chosen.skin = skin(chosen.skin, chosen.seed)
    chosen.out = chosen.out or Path(f"{chosen.mesh.stem}_imprints")
    check_folder(chosen.out)
    return chosen


def skin(text, seed):
    """The Skin of a text such as `blur=0.8,noise=0.02`; None of None."""
    if text is None:
        return None
    known = [field.name for field in fields(Skin) if field.name != "seed"]
    values = {}
    for part in text.split(","):
        name, _, value = (word.strip() for word in part.partition("="))
        if name not in known:
            raise ValueError(f"--skin {part}: there is no {name!r}; write NAME=VALUE with one of {', '.join(known)}")
        try:
            values[name] = float(value)
        except ValueError:
            raise ValueError(f"--skin {part}: {value!r} is no number") from None
    return Skin(**values, seed=seed)


def check_folder(folder):
    """Raises ValueError where nothing could be written to the folder, or one above it."""
    if folder.exists() and not folder.is_dir():
        raise ValueError(f"--out {folder} is a file: name a folder")
    there = next(place for place in [folder.absolute(), *folder.absolute().parents] if place.exists())
    if not there.is_dir() or not os.access(there, os.W_OK):
        raise ValueError(f"--out {folder}: nothing can be written to {there}")


def _check_choice(chosen):
    """Raises ValueError for options that would change nothing together, and for methods that cannot look."""
    way = chosen.at[0] if len(chosen.at) == 1 and chosen.at[0] in WAYS else None
    if any(word in WAYS for word in chosen.at) and way is None:
        raise ValueError(f"--at {' '.join(chosen.at)}: `salient` and `random` stand alone")
    if chosen.count is not None and way is None:
        raise ValueError("--count goes with --at salient or --at random: the places are counted already")
    if chosen.count is not None and chosen.count < 1:
        raise ValueError(f"--count {chosen.count}: give 1 or more")
    if chosen.method is not None and way != "salient":
        raise ValueError("--method goes with --at salient")
    runs, others = teachable(METHODS, Learned())
    usable = [name for name in runs if name != "random"]
    if chosen.method is not None and chosen.method not in usable:
        reason = "it learns from the pipeline's objects" if chosen.method in others else "there is no such method"
        reason = "that is --at random" if chosen.method == "random" else reason
        raise ValueError(f"--method {chosen.method}: {reason}; choose one of {', '.join(usable)}")

"""The options of `haptic-glance touch MESH`, and their checks before any work."""

import argparse
import os
import re
from dataclasses import fields
from pathlib import Path
from typing import Any

from stages.meshes.up import add_up
from stages.salient_points.names import HELP, check_name

from .contact import CONTACTS
from .distances import check_array
from .layer import Layer
from .lengths import METRES, Metres, length
from .skin import Skin
from .user_mesh import DEFAULT_COUNT

SELECTIONS = ("salient", "random")  # of places, which --count applies to
POINT = re.compile(r"-?[\d.][^,]*,[^,]+,[^,]+")  # a position, which may begin with a minus like an option


def parser(description: str) -> argparse.ArgumentParser:
    """The parser of the command line; description: the text of --help."""
    first, _, rest = description.partition("\n")
    form = argparse.RawDescriptionHelpFormatter
    usage = "%(prog)s MESH [--at PLACE ...] [options]"
    result = argparse.ArgumentParser("haptic-glance touch", usage, first, rest, formatter_class=form)
    result.add_argument("mesh", metavar="MESH", type=Path, help="the file to touch: STL, OBJ, PLY, OFF or GLB")
    help_at = "places: salient (default), random, ids of vertices, or positions x,y,z in the file's coordinates"
    result.add_argument("--at", metavar="PLACE", nargs="+", default=[SELECTIONS[0]], help=help_at)
    help_cells = "size of the array (default: 16 16)"
    result.add_argument("--cells", metavar=("ROWS", "COLS"), nargs=2, type=int, default=[16, 16], help=help_cells)
    help_pitch = "distance of two cells: a length such as 1mm, or in units, of which the bounding sphere is 1 across"
    result.add_argument("--pitch", metavar="LENGTH", type=length, default=0.01, help=f"{help_pitch} (default: 0.01)")
    help_count = f"number of salient or random places (default: {DEFAULT_COUNT})"
    result.add_argument("--count", metavar="N", type=int, help=help_count)
    result.add_argument("--method", help=f"of the salient places: {HELP}")
    help_contact = "tangent: the array stands at the place (default); rigid: it rests on the first contact"
    result.add_argument("--contact", choices=CONTACTS, default=CONTACTS[0], help=help_contact)
    help_depth = (
        "how deep the object's highest point goes into the skin, as --pitch (default: the relief of each imprint)"
    )
    result.add_argument("--depth", metavar="LENGTH", type=length, help=help_depth)
    help_skin = f"faults of a real sensor, such as blur=0.8,noise=0.02; the names are {', '.join(names_of(Skin))}"
    result.add_argument("--skin", metavar="NAME=VALUE,...", help=help_skin)
    help_load = "also write the force on each cell, in newtons, at which the whole array bears this load"
    result.add_argument("--load", metavar="NEWTONS", type=float, help=help_load)
    help_unit = "what the coordinates of the file are in; --load and lengths such as 1mm need it"
    result.add_argument("--unit", choices=list(METRES), help=help_unit)
    help_layer = f"the foam on the array, for --load; the names are {', '.join(names_of(Layer))}"
    result.add_argument("--layer", metavar="NAME=VALUE,...", help=help_layer)
    add_up(result)
    result.add_argument(
        "--seed", type=int, default=0, help="seed of random places and of the skin (default: %(default)s)"
    )
    result.add_argument("--out", metavar="FOLDER", type=Path, help="output folder (default: MESH_imprints)")
    result.add_argument("--json", action="store_true", help="print the places as JSON, as places.csv has them")
    result.add_argument("--show", action="store_true", help="also open the picture in a window")
    return result


def parse_options(description: str, argv: list[str]) -> argparse.Namespace:
    """The options of a command line, checked; a position may begin with a minus."""
    options = parser(description).parse_args([f" {word}" if POINT.fullmatch(word) else word for word in argv])
    check_lengths(options)
    if options.seed < 0:
        raise ValueError(f"--seed {options.seed}: give 0 or more")
    _check_combination(options)
    _check_load(options)
    options.metres = METRES.get(options.unit)
    options.skin = parse_skin(options.skin, options.seed)
    options.layer = Layer(**parse_values("--layer", Layer, options.layer))
    options.out = options.out or Path(f"{options.mesh.stem}_imprints")
    check_folder(options.out)
    return options


def lengths_in_units(options: argparse.Namespace, unit: float) -> None:
    """Converts the lengths of the options in metres to units of the mesh, one of which is `unit` units of the file."""
    for name in ("pitch", "depth"):
        if isinstance(value := getattr(options, name), Metres):
            setattr(options, name, float(value / (unit * options.metres)))
    check_lengths(options)


def check_lengths(options: argparse.Namespace) -> None:
    """Raises ValueError for a pitch or a depth that is not positive, and for a pitch larger than the object."""
    check_array(options.cells, options.pitch)
    if not isinstance(options.pitch, Metres) and options.pitch >= 1 and max(options.cells) > 1:
        raise ValueError(f"--pitch {options.pitch:g} is larger than the object, which is 1 unit across: try 0.01")
    if options.depth is not None and not 0 < options.depth < float("inf"):
        raise ValueError(f"--depth {options.depth:g}: give a positive length")


def parse_skin(text: str | None, seed: int) -> Skin | None:
    """The Skin of a text such as `blur=0.8,noise=0.02`; None of None."""
    return None if text is None else Skin(**parse_values("--skin", Skin, text), seed=seed)


def names_of(kind: type) -> list[str]:
    """The fields of a Skin or a Layer that a text can set."""
    return [field.name for field in fields(kind) if field.name != "seed"]


def parse_values(option: str, kind: type, text: str | None) -> dict[str, Any]:
    """{name: number} of a text such as `blur=0.8,noise=0.02` with names of a Skin or a Layer; empty of None."""
    names, values = names_of(kind), {}
    for part in text.split(",") if text is not None else ():
        name, _, value = (word.strip() for word in part.partition("="))
        if name not in names:
            raise ValueError(f"{option} {part}: {name!r} is unknown; write NAME=VALUE with one of {', '.join(names)}")
        try:
            values[name] = float(value)
        except ValueError:
            raise ValueError(f"{option} {part}: {value!r} is not a number") from None
    return values


def check_folder(folder: Path) -> None:
    """Raises ValueError unless the folder can be written to, or created."""
    if folder.exists() and not folder.is_dir():
        raise ValueError(f"--out {folder} is a file: name a folder")
    existing = next(place for place in [folder.absolute(), *folder.absolute().parents] if place.exists())
    if not existing.is_dir() or not os.access(existing, os.W_OK):
        raise ValueError(f"--out {folder}: {existing} is not writable")


def _check_load(options):
    """Raises ValueError for a load that is not positive, a missing unit, and a unit or a layer without use."""
    if options.load is not None and not 0 < options.load < float("inf"):
        raise ValueError(f"--load {options.load:g}: give a positive number")
    if options.load is None and options.layer is not None:
        raise ValueError("--layer applies to --load only")
    real = [f"--{name}" for name in ("pitch", "depth") if isinstance(getattr(options, name), Metres)]
    real += ["--load"] if options.load is not None else []
    if real and options.unit is None:
        raise ValueError(f"{real[0]} needs --unit, what the file is in: {', '.join(METRES)}")
    if options.unit is not None and not real:
        raise ValueError("--unit applies to --load, and to a --pitch or --depth such as 1mm")


def _check_combination(options):
    """Raises ValueError for options that do not apply together, and for methods that cannot run on a single mesh."""
    selection = options.at[0] if len(options.at) == 1 and options.at[0] in SELECTIONS else None
    if any(word in SELECTIONS for word in options.at) and selection is None:
        raise ValueError(f"--at {' '.join(options.at)}: `salient` and `random` cannot be combined with other places")
    if options.count is not None and selection is None:
        raise ValueError("--count applies to --at salient or --at random only")
    if options.count is not None and options.count < 1:
        raise ValueError(f"--count {options.count}: give 1 or more")
    if options.method is not None and selection != "salient":
        raise ValueError("--method applies to --at salient only")
    if options.method == "random":
        raise ValueError("--method random: use --at random")
    if options.method is not None:
        check_name(options.method, points_alone=True)

"""Touches one mesh with the virtual pressure array; shows and saves what it measures, and where.

Reads STL, OBJ, PLY, OFF, GLB or glTF. The mesh is first scaled so that its bounding sphere is 1 unit across.
--pitch and --depth are in these units, whose size in units of the file is printed, or lengths such as 1mm. All
positions, given and written, are in the file's coordinates. Writes into the folder of --out:
  imprints.png  the mesh with numbered places and outlines of the array to scale, and the imprints beside it
  imprints.npz  images (k, rows, cols) in 0..1, 0 at first contact; distances (k, rows, cols) before the skin, in units;
                vertices, positions, normals and axes (rows right, up, normal) in the file's coordinates; pitch; unit
  places.csv    index, vertex (empty if it is none), position, normal, relief in units and in the file's units
imprints.png needs the extra `pictures`; the others are written without it.
With --load a rigid array is pressed from above. Then imprints.npz also has forces (k, rows, cols) in newtons, and
places.csv has the highest force of each place and the depth of the indentation of the layer, in metres. --skin
does not change forces.

examples:
  haptic-glance touch bunny.stl --at salient
  haptic-glance touch chair.obj --at random --count 12 --cells 32 32 --pitch 0.005 --up y --out chair_touched
  haptic-glance touch bunny.stl --unit mm --pitch 1mm --load 2 --layer thickness=0.003,modulus=1e5
  haptic-glance touch part.ply --at 120 455 0.031,-0.2,1.5 --contact rigid --skin blur=0.8,noise=0.02,dead=0.03
"""

import argparse
import csv
import io
import json
import re
from collections.abc import Sequence
from dataclasses import fields
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np

from haptic_glance.base import progress
from haptic_glance.base.extras import MissingExtra, about, from_extra
from haptic_glance.base.files import check_folder, existing, said_of, write_arrays, write_text
from haptic_glance.look.points.find import HELP, check_name
from haptic_glance.mesh.up import add_up
from haptic_glance.touch.distances import CONTACTS, check_array, distances_at
from haptic_glance.touch.force import press_forces
from haptic_glance.touch.places import DEFAULT_COUNT, Places, UserMesh, read_user_mesh
from haptic_glance.touch.press import normalise
from haptic_glance.touch.quasi_tangent import misfit, misfit_of_layer
from haptic_glance.touch.skin import LAYER_UNITS, METRES, Layer, Metres, Skin, indent, length
from haptic_glance.touch.surface import sensor_axes

from .arguments import command_parser

report = partial(progress.report, "touch")
SELECTIONS = ("salient", "random")  # of places, which --count applies to
POINT = re.compile(r"-[\d.][^,]*,[^,]+,[^,]+")  # a position that begins with a minus like an option


def parser() -> argparse.ArgumentParser:
    """The parser of the command line."""
    result = command_parser("touch", __doc__ or "", "%(prog)s MESH [--at PLACE ...] [options]")
    result.add_argument("mesh", metavar="MESH", type=Path, help="the file to touch: STL, OBJ, PLY, OFF, GLB or glTF")
    help_at = "places: salient (default), random, ids of vertices, or positions x,y,z in the file's coordinates"
    result.add_argument("--at", metavar="PLACE", nargs="+", default=[SELECTIONS[0]], help=help_at)
    help_cells = "size of the array (default: 16 16)"
    result.add_argument("--cells", metavar=("ROWS", "COLS"), nargs=2, type=int, default=[16, 16], help=help_cells)
    help_pitch = "distance of two cells: a length such as 1mm, or a number of units (the bounding sphere is 1 across)"
    result.add_argument(
        "--pitch", metavar="LENGTH", type=length_option, default=0.01, help=f"{help_pitch} (default: 0.01)"
    )
    help_count = f"number of salient or random places (default: {DEFAULT_COUNT})"
    result.add_argument("--count", metavar="N", type=int, help=help_count)
    result.add_argument("--method", help=f"method of the salient places: {HELP}")
    help_contact = "tangent: the array stands at the place (default); rigid: it rests on the first contact"
    result.add_argument("--contact", choices=CONTACTS, default=CONTACTS[0], help=help_contact)
    help_depth = (
        "how deep the object's highest point goes into the skin, as --pitch (default: the relief of each imprint)"
    )
    result.add_argument("--depth", metavar="LENGTH", type=length_option, help=help_depth)
    help_skin = f"faults of a real sensor, such as blur=0.8,noise=0.02; the names are {', '.join(names_of(Skin))}"
    result.add_argument("--skin", metavar="NAME=VALUE,...", help=help_skin)
    help_load = "load on the whole array in newtons: also write the force on each cell, in newtons"
    result.add_argument("--load", metavar="NEWTONS", type=newtons, help=help_load)
    help_unit = "unit of the file's coordinates; --load and lengths such as 1mm need it"
    result.add_argument("--unit", choices=list(METRES), help=help_unit)
    names = [f"{name} in {LAYER_UNITS[name]}" if name in LAYER_UNITS else name for name in names_of(Layer)]
    help_layer = f"the foam on the array, for --load; the names are {', '.join(names)}"
    result.add_argument("--layer", metavar="NAME=VALUE,...", help=help_layer)
    add_up(result)
    result.add_argument(
        "--seed", type=int, default=0, help="seed of random places and of the skin (default: %(default)s)"
    )
    result.add_argument("--out", metavar="FOLDER", type=Path, help="output folder (default: MESH_imprints)")
    result.add_argument("--json", action="store_true", help="print the places as JSON, as places.csv has them")
    result.add_argument("--show", action="store_true", help="also open the picture in a window")
    return result


def parse_options(argv: list[str]) -> argparse.Namespace:
    """The options of a command line, checked; a position may begin with a minus."""
    options = parser().parse_args([f" {word}" if POINT.fullmatch(word) else word for word in argv])
    check_lengths(options)
    if options.seed < 0:
        raise ValueError(f"--seed {options.seed}: give 0 or more")
    _check_combination(options)
    _check_load(options)
    options.metres = METRES.get(options.unit)
    if options.skin is not None:
        options.skin = Skin(**parse_values("--skin", Skin, options.skin), seed=options.seed)
    options.layer = Layer(**parse_values("--layer", Layer, options.layer))
    options.out = options.out or Path(f"{options.mesh.stem}_imprints")
    check_folder(options.out, f"--out {options.out}")
    return options


def length_option(text: str) -> float:
    """A number of units, or Metres of a text such as 1mm; an error of argparse that says so."""
    try:
        return length(text)
    except ValueError:
        units = ", ".join(METRES)
        raise argparse.ArgumentTypeError(f"{text!r}: give a number, or a length such as 1mm, in {units}") from None


def newtons(text: str) -> float:
    """Newtons of a text such as 5 or 5N; an error of argparse that says so."""
    try:
        return float(text.strip().removesuffix("N"))
    except ValueError:
        raise argparse.ArgumentTypeError(f"{text!r}: give a number of newtons, such as 5") from None


def lengths_in_units(options: argparse.Namespace, unit: float) -> None:
    """Converts the lengths of the options in metres to units of the mesh, one of which is `unit` units of the file."""
    for name in ("pitch", "depth"):
        if isinstance(value := getattr(options, name), Metres):
            setattr(options, name, float(value / (unit * options.metres)))
            if name == "pitch" and options.pitch >= 1 and max(options.cells) > 1:
                across = 1000 * unit * options.metres
                raise ValueError(
                    f"--pitch {1000 * value:g}mm is larger than the object, which is {across:.3g} mm across if its "
                    f"coordinates are in {options.unit}: is --unit {options.unit} right?"
                )
    check_lengths(options)


def check_lengths(options: argparse.Namespace) -> None:
    """Raises ValueError for a pitch or a depth that is not positive, and for a pitch larger than the object."""
    check_array(options.cells, options.pitch)
    if not isinstance(options.pitch, Metres) and options.pitch >= 1 and max(options.cells) > 1:
        remedy = f"try 0.01, or write {options.pitch:g}{options.unit}" if options.unit else "try 0.01"
        raise ValueError(f"--pitch {options.pitch:g} is larger than the object, which is 1 unit across: {remedy}")
    if options.depth is not None and not 0 < options.depth < float("inf"):
        raise ValueError(f"--depth {options.depth:g}: give a positive length")


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
        if name in values:
            raise ValueError(f"{option} {text}: {name} is given twice")
        try:
            values[name] = float(value)
        except ValueError:
            unit = f" of {LAYER_UNITS[name]}" if kind is Layer and name in LAYER_UNITS else ""
            raise ValueError(f"{option} {part}: {value!r} is not a number{unit}") from None
    return values


def _check_load(options):
    """Raises ValueError for a load that is not positive, a missing unit, and a unit or a layer without use."""
    if options.load is not None and not 0 < options.load < float("inf"):
        raise ValueError(f"--load {options.load:g}: give a positive number")
    if options.load is None and options.layer is not None:
        raise ValueError("--layer applies to --load only")
    real = [f"--{name}" for name in ("pitch", "depth") if isinstance(getattr(options, name), Metres)]
    real += ["--load"] if options.load is not None else []
    if real and options.unit is None:
        raise ValueError(f"{real[0]} needs --unit, the unit of the file: {', '.join(METRES)}")
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


ARRAYS, PICTURE, TABLE = "imprints.npz", "imprints.png", "places.csv"
MAX_CELLS = 50_000_000  # of all places together, which need about 2 GB of memory


def run(argv: list[str]) -> None:
    """Runs the command line `argv`, which excludes the program's name."""
    options = parse_options(argv)
    if options.show:
        with from_extra("--show needs matplotlib, which "):
            from haptic_glance.touch.imprint_pictures import check_window

        check_window()
    with about(options.mesh):
        user_mesh = open_mesh(options)
        places = user_mesh.places(options.at, options.count, options.method, options.seed)
        check_size(len(places.positions), options.cells)
    if places.note:
        report(places.note)
    report("pressing")
    axes = sensor_axes(places.normals)
    raw = distances_at(user_mesh.surface, places.positions, axes, options.cells, options.pitch, contact=options.contact)
    images = make_images(raw, options, user_mesh.name)
    if (raw == raw.max(axis=(1, 2), keepdims=True)).all():
        report("every imprint is flat: the array is small compared with the shape, or touches nothing")
    with about(options.mesh):
        forces = press_load(user_mesh, places.positions, axes, options)
    rows = places_rows(user_mesh, places, raw)
    if len(forces):
        stiffness = options.layer.stiffness * (options.pitch * user_mesh.unit * options.metres) ** 2
        for row, peak in zip(rows, forces.max(axis=(1, 2)).tolist(), strict=True):
            row |= {"peak_newtons": peak, "indentation_metres": peak / stiffness}
    options.out.mkdir(parents=True, exist_ok=True)
    before = existing(*(options.out / name for name in (PICTURE, ARRAYS, TABLE)))
    arrays = saved_arrays(user_mesh, places, axes, raw, images, options.pitch)
    write_arrays(options.out / ARRAYS, **arrays, **({"forces": forces} if len(forces) else {}))
    write_text(options.out / TABLE, as_csv(rows, user_mesh.digits))
    file_names = [ARRAYS, TABLE]
    try:
        draw_picture(options, user_mesh, places, axes, images, [row["relief"] for row in rows])
        file_names = [PICTURE, *file_names]
    except MissingExtra as error:
        report(f"no {PICTURE}: {error}")
    print(json.dumps(rows) if options.json else summary(user_mesh, rows, options))
    report(said_of([options.out / name for name in file_names], before))
    if options.show:
        from haptic_glance.touch.imprint_pictures import open_window

        open_window(options.out / PICTURE)


def check_size(places: int, cells: list[int]) -> None:
    """Raises ValueError if the imprints of this many places would not fit into memory."""
    rows, columns = cells
    if places * rows * columns > MAX_CELLS:
        raise ValueError(f"--cells {rows} {columns}, {places} places: at most {MAX_CELLS:,} cells in all; use fewer")


def open_mesh(options: argparse.Namespace) -> UserMesh:
    """The UserMesh of the file; reports its size and that of the array."""
    report(f"reading {options.mesh.name}")
    user_mesh, notes = read_user_mesh(options.mesh, options.up)
    count = len(user_mesh.mesh.faces)
    report("; ".join([f"{count:,} face{'s' * (count != 1)}", *notes]))
    lengths_in_units(options, user_mesh.unit)
    if wrong := misfit(options.cells, options.pitch):
        report(wrong)
    if options.load is not None:
        size = user_mesh.unit * options.metres
        if wrong := misfit_of_layer(options.layer, max(options.cells) * options.pitch * size, size):
            report(f"{wrong}: is --unit {options.unit} right?")
    if options.at[0] == "salient":
        report("looking at it, to find what is salient")
    return user_mesh


def make_images(raw: np.ndarray, options: argparse.Namespace, name: str) -> np.ndarray:
    """The imprints (k, rows, cols) f4 in 0..1 of distances, with the options' depth and skin."""
    images = normalise(raw, options.pitch) if options.depth is None else indent(raw, options.depth)
    return images if options.skin is None else options.skin(images, name)


def press_load(user_mesh: UserMesh, positions: np.ndarray, axes: np.ndarray, options: argparse.Namespace) -> np.ndarray:
    """(k, rows, cols) newtons on the cells at the options' load; (0,) without a load."""
    if options.load is None:
        return np.zeros(0)
    cells, unit = tuple(options.cells), user_mesh.unit * options.metres
    try:
        return press_forces(user_mesh.surface, positions, axes, options.layer, cells, options.pitch, options.load,
                            unit=unit)  # fmt: skip
    except ValueError as error:
        reason = re.sub(r"^touch (\d+)", lambda match: f"place {int(match[1]) + 1}", str(error))  # as the table counts
        raise ValueError(f"--load {options.load:g}: {reason}") from None


def draw_picture(
    options: argparse.Namespace, user_mesh: UserMesh, places: Places, axes: np.ndarray, images: np.ndarray,
    reliefs: Sequence[float],
) -> None:  # fmt: skip
    """Writes imprints.png; MissingExtra without matplotlib."""
    with from_extra("it is drawn by matplotlib, which "):
        from haptic_glance.touch.imprint_pictures import write_picture

    report("drawing")
    scale = "the depth" if options.depth else "the imprint's relief"
    write_picture(options.out / PICTURE, user_mesh.mesh, places.positions, axes, images, np.asarray(reliefs),
                  options.pitch, scale, user_mesh.source.up)  # fmt: skip


def places_rows(user_mesh: UserMesh, places: Places, raw: np.ndarray) -> list[dict[str, Any]]:
    """One dict per place, in the file's coordinates; vertex is None where the place is none."""
    positions, normals = user_mesh.to_file(places.positions), user_mesh.to_file_directions(places.normals)
    rows = []
    for index, (vertex, depths) in enumerate(zip(places.vertices.tolist(), raw, strict=True)):
        place = dict(zip(("x", "y", "z", "nx", "ny", "nz"), [*positions[index], *normals[index]], strict=True))
        relief = float(np.ptp(depths))
        row = {"index": index + 1, "vertex": None if vertex < 0 else vertex} | {k: float(v) for k, v in place.items()}
        rows.append(row | {"relief": relief, "relief_in_file": relief * user_mesh.unit})
    return rows


def as_csv(rows: Sequence[dict[str, Any]], digits: int) -> str:
    """Rows as CSV, six digits; digits: of positions, since six are too few far from the origin."""
    text = io.StringIO()
    writer = csv.writer(text, lineterminator="\n")
    writer.writerow(rows[0])
    for row in rows:
        writer.writerow(f"{v:.{digits if k in 'xyz' else 6}g}" if isinstance(v, float) else v for k, v in row.items())
    return text.getvalue()


def saved_arrays(
    user_mesh: UserMesh, places: Places, axes: np.ndarray, raw: np.ndarray, images: np.ndarray, pitch: float
) -> dict[str, object]:
    """The arrays of the NPZ file."""
    return {
        "images": images, "distances": raw, "vertices": places.vertices,
        "positions": user_mesh.to_file(places.positions), "normals": user_mesh.to_file_directions(places.normals),
        "axes": user_mesh.to_file_directions(axes), "pitch": pitch, "unit": user_mesh.unit,
    }  # fmt: skip


def summary(user_mesh: UserMesh, rows: Sequence[dict[str, Any]], options: argparse.Namespace) -> str:
    """The printed table."""
    high, wide = options.cells
    width = user_mesh.digits + 5
    lines = [
        f"array: {high} x {wide} cells, {options.pitch:g} units apart "
        f"({options.pitch * user_mesh.unit:.4g} in the file's units; 1 unit is {user_mesh.unit:.4g}), "
        f"{options.contact}",
        f"{'place':>5} {'vertex':>8} {'x':>{width}} {'y':>{width}} {'z':>{width}} {'relief':>8} {'in file':>9}",
    ]
    for row in rows:
        vertex = "-" if row["vertex"] is None else row["vertex"]
        place = " ".join(f"{row[axis]:>{width}.{user_mesh.digits - 1}g}" for axis in "xyz")
        lines.append(f"{row['index']:>5} {vertex:>8} {place} {row['relief']:>8.4f} {row['relief_in_file']:>9.4g}")
    if options.load is not None:
        indented = [1000 * row["indentation_metres"] for row in rows]
        lines.append(
            f"load: {options.load:g} N a place; the highest force on a cell is "
            f"{max(row['peak_newtons'] for row in rows):.4g} N; "
            f"the layer is indented by {min(indented):.4g} to {max(indented):.4g} mm"
        )
    return "\n".join(lines)

"""Touches one mesh with the virtual pressure array; shows and saves what it measures, and where.

Reads STL, OBJ, PLY, OFF or GLB. The mesh is first scaled so that its bounding sphere is 1 unit across.
--pitch and --depth are in these units, whose size in units of the file is printed, or lengths such as 1mm. All
positions, given and written, are in the file's coordinates. Writes into the folder of --out:
  imprints.png  the mesh with numbered places and outlines of the array to scale, and the imprints beside it
  imprints.npz  images (k, rows, cols) in 0..1, 0 at first contact; distances (k, rows, cols) before the skin, in units;
                vertices, positions, normals and axes (rows right, up, normal) in the file's coordinates; pitch; unit
  places.csv    index, vertex (empty if it is none), position, normal, relief in units and in the file's units
With --load a rigid array comes from above: imprints.npz also has forces (k, rows, cols) in newtons, and places.csv the
highest of each place and how deep its layer is indented, in metres.

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
import sys
from collections.abc import Sequence
from typing import Any

import numpy as np

from stages.kit.files import write_arrays, write_text
from stages.kit.sensor_axes import sensor_axes

from .distances import distances_at
from .force import press_forces
from .options import lengths_in_units, parse_options
from .press import normalise
from .sensor import misfit
from .skin import indent
from .user_mesh import Places, UserMesh, read_user_mesh

ARRAYS, PICTURE, TABLE = "imprints.npz", "imprints.png", "places.csv"
MAX_CELLS = 50_000_000  # of all places together, which need about 2 GB of memory


def run(argv: list[str]) -> None:
    """Runs the command line `argv`, which excludes the program's name."""
    options = parse_options(__doc__ or "", argv)
    if options.show:
        from .pictures import check_window

        check_window()
    try:
        user_mesh = open_mesh(options)
        places = user_mesh.places(options.at, options.count, options.method, options.seed)
        check_size(len(places.positions), options.cells)
    except ValueError as error:
        raise ValueError(f"{options.mesh}: {error}").with_traceback(error.__traceback__) from None
    if places.note:
        report_progress(places.note)
    axes = sensor_axes(places.normals)
    raw = distances_at(user_mesh.surface, places.positions, axes, options.cells, options.pitch, contact=options.contact)
    images = make_images(raw, options, user_mesh.name)
    if (raw == raw.max(axis=(1, 2), keepdims=True)).all():
        report_progress("every imprint is flat: the array is small compared with the shape, or touches nothing")
    pressed = press_load(user_mesh, places.positions, axes, options)
    rows = places_rows(user_mesh, places, raw)
    if len(pressed):
        stiffness = options.layer.stiffness * (options.pitch * user_mesh.unit * options.metres) ** 2
        for row, peak in zip(rows, pressed.max(axis=(1, 2)).tolist(), strict=True):
            row |= {"peak_newtons": peak, "indentation_metres": peak / stiffness}
    options.out.mkdir(parents=True, exist_ok=True)
    arrays = saved_arrays(user_mesh, places, axes, raw, images, options.pitch)
    write_arrays(options.out / ARRAYS, **arrays, **({"forces": pressed} if len(pressed) else {}))
    write_text(options.out / TABLE, as_csv(rows, user_mesh.digits))
    draw_picture(options, user_mesh, places, axes, images, [row["relief"] for row in rows])
    print(json.dumps(rows) if options.json else summary(user_mesh, rows, options))
    report_progress("written: " + ", ".join(str(options.out / name) for name in (PICTURE, ARRAYS, TABLE)))
    if options.show:
        from .pictures import open_window

        open_window(options.out / PICTURE)


def check_size(places: int, cells: list[int]) -> None:
    """Raises ValueError if the imprints of this many places would not fit into memory."""
    rows, columns = cells
    if places * rows * columns > MAX_CELLS:
        raise ValueError(f"--cells {rows} {columns}, {places} places: at most {MAX_CELLS:,} cells in all; use fewer")


def open_mesh(options: argparse.Namespace) -> UserMesh:
    """The UserMesh of the file; reports its size and that of the array."""
    report_progress(f"reading {options.mesh.name}")
    user_mesh, notes = read_user_mesh(options.mesh, options.up)
    report_progress("; ".join([f"{len(user_mesh.mesh.faces):,} faces", *notes]))
    lengths_in_units(options, user_mesh.unit)
    if wrong := misfit(options.cells, options.pitch):
        report_progress(wrong)
    if options.at[0] == "salient":
        report_progress("looking at it, to find what is salient")
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
        raise ValueError(f"--load {options.load:g}: {error}") from None


def draw_picture(
    options: argparse.Namespace, user_mesh: UserMesh, places: Places, axes: np.ndarray, images: np.ndarray,
    reliefs: Sequence[float],
) -> None:  # fmt: skip
    """Writes imprints.png."""
    from .pictures import write_picture  # brings matplotlib, which nothing else here needs

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


def report_progress(text: str) -> None:
    """Prints a line of progress to stderr, apart from the results."""
    print(f"touch: {text}", file=sys.stderr, flush=True)

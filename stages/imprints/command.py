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
With a data set of params.yaml instead of MESH, the pipeline's stage `imprints` runs on it.

examples:
  python -m stages.imprints bunny.stl --at salient
  python -m stages.imprints chair.obj --at random --count 12 --cells 32 32 --pitch 0.005 --up y --out chair_touched
  python -m stages.imprints bunny.stl --unit mm --pitch 1mm --load 2 --layer thickness=0.003,modulus=1e5
  python -m stages.imprints part.ply --at 120 455 0.031,-0.2,1.5 --contact rigid --skin blur=0.8,noise=0.02,dead=0.03
"""

import argparse
import sys

import numpy as np
import pandas as pd

from stages.kit.files import write_arrays, write_table

from .distances import distances_at
from .force import press_forces
from .frame import sensor_axes
from .options import lengths_in_units, parse_options
from .press import normalise
from .sensor import misfit
from .skin import indent
from .user_mesh import Places, UserMesh, read_user_mesh

ARRAYS, PICTURE, TABLE = "imprints.npz", "imprints.png", "places.csv"
MAX_CELLS = 50_000_000  # of all places together, which need about 2 GB of memory


def run(argv: list[str]) -> None:
    """Runs the command line `argv`, which excludes the program's name."""
    from .pictures import check_window, open_window, write_picture  # imports matplotlib, which nothing else here needs

    options = parse_options(__doc__ or "", argv)
    if options.show:
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
    frame = places_table(user_mesh, places, raw)
    if len(pressed):
        peaks = pressed.max(axis=(1, 2))
        stiffness = options.layer.stiffness * (options.pitch * user_mesh.unit * options.metres) ** 2
        frame = frame.assign(peak_newtons=peaks, indentation_metres=peaks / stiffness)
    options.out.mkdir(parents=True, exist_ok=True)
    arrays = saved_arrays(user_mesh, places, axes, raw, images, options.pitch)
    write_arrays(options.out / ARRAYS, **arrays, **({"forces": pressed} if len(pressed) else {}))
    exact = {
        axis: frame[axis].map(f"{{:.{user_mesh.digits}g}}".format) for axis in "xyz"
    }  # six digits are too few far from the origin
    write_table(options.out / TABLE, frame.assign(**exact))
    picture = options.out / PICTURE
    scale = "the depth" if options.depth else "the imprint's relief"
    write_picture(
        picture, user_mesh.mesh, places.positions, axes, images, frame["relief"].to_numpy(), options.pitch, scale,
        user_mesh.source.up,
    )  # fmt: skip
    print(summary(user_mesh, frame, options))
    print("written: " + ", ".join(str(options.out / name) for name in (PICTURE, ARRAYS, TABLE)))
    if options.show:
        open_window(picture)


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
        report_progress("rendering it from twelve sides, to find what is salient")
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


def places_table(user_mesh: UserMesh, places: Places, raw: np.ndarray) -> pd.DataFrame:
    """A frame with one row per place, in the file's coordinates."""
    columns = {"index": np.arange(1, len(raw) + 1), "vertex": pd.array(places.vertices, dtype="Int64")}
    columns |= dict(zip("xyz", user_mesh.to_file(places.positions).T, strict=True))
    columns |= dict(zip(("nx", "ny", "nz"), user_mesh.to_file_directions(places.normals).T, strict=True))
    relief = np.ptp(raw, axis=(1, 2))
    frame = pd.DataFrame(columns | {"relief": relief, "relief_in_file": relief * user_mesh.unit})
    return frame.assign(vertex=frame["vertex"].mask(frame["vertex"] < 0))


def saved_arrays(
    user_mesh: UserMesh, places: Places, axes: np.ndarray, raw: np.ndarray, images: np.ndarray, pitch: float
) -> dict[str, object]:
    """The arrays of the NPZ file."""
    return {
        "images": images, "distances": raw, "vertices": places.vertices,
        "positions": user_mesh.to_file(places.positions), "normals": user_mesh.to_file_directions(places.normals),
        "axes": user_mesh.to_file_directions(axes), "pitch": pitch, "unit": user_mesh.unit,
    }  # fmt: skip


def summary(user_mesh: UserMesh, frame: pd.DataFrame, options: argparse.Namespace) -> str:
    """The printed table."""
    rows, columns = options.cells
    width = user_mesh.digits + 5
    lines = [
        f"array: {rows} x {columns} cells, {options.pitch:g} units apart "
        f"({options.pitch * user_mesh.unit:.4g} in the file's units; 1 unit is {user_mesh.unit:.4g}), "
        f"{options.contact}",
        f"{'place':>5} {'vertex':>8} {'x':>{width}} {'y':>{width}} {'z':>{width}} {'relief':>8} {'in file':>9}",
    ]
    for row in frame.to_dict("records"):
        vertex = "-" if pd.isna(row["vertex"]) else row["vertex"]
        place = " ".join(f"{row[axis]:>{width}.{user_mesh.digits - 1}g}" for axis in "xyz")
        lines.append(f"{row['index']:>5} {vertex:>8} {place} {row['relief']:>8.4f} {row['relief_in_file']:>9.4g}")
    if "peak_newtons" in frame:
        indented, peak = frame["indentation_metres"] * 1000, frame["peak_newtons"]
        lines.append(
            f"load: {options.load:g} N a place; the highest force on a cell is {peak.max():.4g} N; "
            f"the layer is indented by {indented.min():.4g} to {indented.max():.4g} mm"
        )
    return "\n".join(lines)


def report_progress(text: str) -> None:
    """Prints a line of progress to stderr, apart from the results."""
    print(f"imprints: {text}", file=sys.stderr, flush=True)

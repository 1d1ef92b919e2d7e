"""Touches one mesh with the virtual pressure array; shows and saves what it feels, and where.

Reads STL, OBJ, PLY, OFF or GLB. The mesh is first scaled to a bounding sphere 1 unit across, as everywhere in this
project: --pitch and --depth are in these units, and what they are in the file's own is printed. Positions are in the
file's coordinates, on the way in and out. Writes into the folder of --out:
  imprints.png  the mesh with the places numbered and the array drawn to size, the imprints beside it
  imprints.npz  images (k, rows, cols) in 0..1, 0 pressed first; distances (k, rows, cols) in units, before the skin;
                vertices, positions, normals and axes (rows right, up, normal) in the file's coordinates; pitch; unit
  places.csv    index, vertex (empty where the place is at none), position, normal, relief in units and in the file's
Without MESH the stage `imprints` of the pipeline runs, by the settings of params.yaml.

examples:
  python -m stages.imprints bunny.stl --at salient
  python -m stages.imprints chair.obj --at random --count 12 --cells 32 32 --pitch 0.005 --up y --out chair_touched
  python -m stages.imprints part.ply --at 120 455 0.031,-0.2,1.5 --contact rigid --skin blur=0.8,noise=0.02,dead=0.03
"""

import sys

import numpy as np
import pandas as pd

from stages.kit.files import write_arrays, write_table

from .distances import distances_at
from .frame import sensor_axes
from .options import parse
from .own_mesh import read
from .press import normalise
from .skin import indent

ARRAYS, PICTURE, TABLE = "imprints.npz", "imprints.png", "places.csv"
MOST = 50_000_000  # cells of all places: about 2 GB while they are worked on


def run(argv):
    """Does what the command line `argv`, without the program's name, asks for."""
    from .pictures import check_window, open_window, write_picture  # brings matplotlib, which nothing else here needs

    chosen = parse(__doc__, argv)
    if chosen.show:
        check_window()
    try:
        own = opened(chosen)
        places = own.places(chosen.at, chosen.count, chosen.method, chosen.seed)
        check_size(len(places.positions), chosen.cells)
    except ValueError as error:
        raise ValueError(f"{chosen.mesh}: {error}").with_traceback(error.__traceback__) from None
    if places.note:
        say(places.note)
    axes = sensor_axes(places.normals)
    raw = distances_at(own.surface, places.positions, axes, chosen.cells, chosen.pitch, contact=chosen.contact)
    images = felt(raw, chosen, own.name)
    if (raw == raw.max(axis=(1, 2), keepdims=True)).all():
        say("every imprint is flat: the array is small beside the shape, or has met nothing")
    found = table(own, places, raw)
    chosen.out.mkdir(parents=True, exist_ok=True)
    write_arrays(chosen.out / ARRAYS, **arrays(own, places, axes, raw, images, chosen.pitch))
    exact = {axis: found[axis].map(f"{{:.{own.digits}g}}".format) for axis in "xyz"}  # six do not do far off
    write_table(chosen.out / TABLE, found.assign(**exact))
    picture = chosen.out / PICTURE
    scale = "the depth" if chosen.depth else "the imprint's relief"
    write_picture(picture, own.mesh, places.positions, axes, images, found["relief"], chosen.pitch, scale)
    print(summary(own, found, chosen))
    print("written: " + ", ".join(str(chosen.out / name) for name in (PICTURE, ARRAYS, TABLE)))
    if chosen.show:
        open_window(picture)


def check_size(places, cells):
    """Raises ValueError where the imprints of so many places would not fit into memory."""
    rows, columns = cells
    if places * rows * columns > MOST:
        raise ValueError(f"--cells {rows} {columns}, {places} places: at most {MOST:,} cells in all; take fewer")


def opened(chosen):
    """The OwnMesh of the file, and what the array is on it, said."""
    say(f"reading {chosen.mesh.name}")
    own, notes = read(chosen.mesh, chosen.up)
    say("".join([f"{len(own.mesh.faces):,} faces, {own.up} up", *(f"; {note}" for note in notes)]))
    if max(chosen.cells) * chosen.pitch > 1:
        say(f"the array is {max(chosen.cells) * chosen.pitch:g} units long, the object 1: most cells will miss it")
    if chosen.at[0] == "salient":
        say("looking at it from twelve sides, to see what is salient")
    return own


def felt(raw, chosen, name):
    """The imprints (k, rows, cols) f4 in 0..1 of distances, with the depth and the skin that were asked for."""
    images = normalise(raw, chosen.pitch) if chosen.depth is None else indent(raw, chosen.depth)
    return images if chosen.skin is None else chosen.skin(images, name)


def table(own, places, raw):
    """A row a place, in the file's coordinates."""
    columns = {"index": np.arange(1, len(raw) + 1), "vertex": pd.array(places.vertices, dtype="Int64")}
    columns |= dict(zip("xyz", own.to_file(places.positions).T, strict=True))
    columns |= dict(zip(("nx", "ny", "nz"), own.to_file_directions(places.normals).T, strict=True))
    relief = np.ptp(raw, axis=(1, 2))
    frame = pd.DataFrame(columns | {"relief": relief, "relief_in_file": relief * own.unit})
    return frame.assign(vertex=frame["vertex"].mask(frame["vertex"] < 0))


def arrays(own, places, axes, raw, images, pitch):
    """What the NPZ holds."""
    return {
        "images": images, "distances": raw, "vertices": places.vertices, "positions": own.to_file(places.positions),
        "normals": own.to_file_directions(places.normals), "axes": own.to_file_directions(axes), "pitch": pitch,
        "unit": own.unit,
    }  # fmt: skip


def summary(own, found, chosen):
    """The table that the command prints."""
    rows, columns = chosen.cells
    wide = own.digits + 5
    lines = [
        f"array: {rows} x {columns} cells, {chosen.pitch:g} units apart ({chosen.pitch * own.unit:.4g} in the file's "
        f"units; 1 unit is {own.unit:.4g}), {chosen.contact}",
        f"{'place':>5} {'vertex':>8} {'x':>{wide}} {'y':>{wide}} {'z':>{wide}} {'relief':>8} {'in file':>9}",
    ]
    for row in found.itertuples():
        vertex = "-" if row.vertex is pd.NA else row.vertex
        place = " ".join(f"{value:>{wide}.{own.digits - 1}g}" for value in (row.x, row.y, row.z))
        lines.append(f"{row.index:>5} {vertex:>8} {place} {row.relief:>8.4f} {row.relief_in_file:>9.4g}")
    return "\n".join(lines)


def say(text):
    """Progress, apart from the results."""
    print(f"imprints: {text}", file=sys.stderr, flush=True)

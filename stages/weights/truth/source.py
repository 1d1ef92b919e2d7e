"""The ground truth of an object, whichever collection its mesh is from."""

import sys
from pathlib import Path

import numpy as np

from stages.meshes.load import parse
from stages.meshes.sources import GAZE, INTEREST_POINTS, named, stored_files

from .annotations import annotations_on_vertices
from .gaze import gaze_on_vertices, match_rows, read_gaze
from .interest_points import read_interest_points

ANNOTATIONS = Path("data/annotations")


def truth_of(name, source, mesh, folder="", annotations=ANNOTATIONS):
    """(n,) f8 amounts on the vertices of the normalised mesh of an object, or None where the object has no truth.

    name, source, folder: the object and the settings meshes.source and meshes.folder that it came from. The amounts are
    seconds of gaze (source gaze), marks of the users (interest_points), or the number of annotators who marked a vertex
    (any other source, from `annotations`/NAME.csv). Amounts sit at single vertices: `spread_on_surface` makes a density
    of them. Raises ValueError when the truth does not fit the mesh, FetchError when the collection is not there.
    """
    if source == "gaze":
        amounts = _gaze(name, folder)
    elif source == "interest_points":
        amounts = _interest_points(name, folder, len(mesh.vertices))
    else:
        path = Path(annotations) / f"{name}.csv"
        amounts = annotations_on_vertices(mesh, path) if path.exists() else None
    if amounts is not None and len(amounts) != len(mesh.vertices):
        raise ValueError(f"{name}: the published mesh has {len(amounts)} vertices, this one {len(mesh.vertices)}")
    return amounts


def _gaze(name, folder):
    files = stored_files(folder, *GAZE)
    tables, models = named(files, r"dataset_[^/]+/([^/]+)\.txt"), named(files, r"Models_3D/([^/]+)\.obj")
    if name not in tables or name not in models:
        return None
    # Coordinates agree digit by digit only with the mesh as published; normalising keeps the order of the vertices.
    mesh = parse(models[name][1](), ".obj")
    positions, _, seconds = read_gaze(tables[name][1]())
    vertex, distance = match_rows(mesh, positions)
    left = np.flatnonzero(vertex < 0)
    amounts = gaze_on_vertices(mesh, positions, seconds)
    if len(left):
        off, lines = distance[left] / mesh.diagonal, ", ".join(str(row + 1) for row in left[:3])
        print(
            f"{tables[name][0]}: {len(left)} of {len(positions)} rows match no vertex and are left out, with"
            f" {seconds[left].sum():.0f} of {seconds.sum():.0f} s of gaze; {off.min():.2%} to {off.max():.2%} of the"
            f" diagonal off; lines {lines}{', ...' if len(left) > 3 else ''}",
            file=sys.stderr,
        )
    return amounts


def _interest_points(name, folder, count):
    found = named(stored_files(folder, *INTEREST_POINTS), r"GROUND_TRUTH_B/([^/]+)\.mat")
    if name not in found:
        return None
    vertices, marks = read_interest_points(found[name][1]())
    if vertices.max(initial=-1) >= count:
        raise ValueError(f"{found[name][0]} names vertex {vertices.max()}, the mesh has {count}")
    return np.bincount(vertices, marks, minlength=count)

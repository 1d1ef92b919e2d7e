"""Readers of human gaze, of marks and of fixations, as amounts at the vertices of a mesh.

Gaze is published in the repository FandosA/3D_Mesh_Saliency_Prediction_PyTorch. A file dataset_SPLIT/NAME.txt has one
row per vertex, shuffled: x y z nx ny nz, the total seconds that 32 people in virtual reality looked there, and a binary
label that is not used. Most files have exactly the vertices of Models_3D/NAME.obj. Larger meshes are sub-sampled to
20,000 rows, smaller ones padded with points between vertices.

Marks are the files in data/annotations that fit a mesh.

Fixation density maps are those of Lavoue et al. 2018, Visual Attention for Rendered 3D Shapes (T3.3.2, T [236]).
Nineteen people looked at images of 32 meshes from three viewpoints, 300, 413 and 599. The published archives
FixationMaps.zip and CentricityAndVisibilityMaps.zip hold FixationMaps/NAME_VIEWnorm.txt (a density, spread by one
degree of visual angle) and CentricityAndVisibilityMaps/NAME_VIEW_visibility.txt (0 or 1), with one line per vertex. The
vertices are those of 3DModels-Simplif/NAME.obj.
"""

import re
import sys
from collections.abc import Callable, Iterable, Mapping
from functools import partial
from pathlib import Path

import numpy as np
from scipy.spatial import KDTree

from haptic_glance.base.text import NUMBER, lines_of, text_of
from haptic_glance.look.marks import MarksError, read_marks
from haptic_glance.mesh.mesh import Mesh

COLUMNS = 8
SECONDS_AT, SECONDS = 6, ("sec", "dur", "time", "gaze", "fix", "dwell")  # the column, and how its names begin
ORDER = "x y z nx ny nz seconds"
MIN_MATCHED = 0.5  # of the rows; the published file with most padding (sofa) has 0.758
OFF_MESH = 0.05  # of the diagonal; padding lies up to 0.033 from the nearest vertex (sofa)


def read_gaze(path_or_bytes: str | Path | bytes) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """(positions (k, 3), normals (k, 3), seconds (k,)), f8, units of the mesh file, from a file or its bytes.

    Normals are as published: not unit, and invalid in some files. Raises ValueError for other than eight columns, NaN
    or negative seconds, and for a header whose columns have another order.
    """
    content = path_or_bytes if isinstance(path_or_bytes, bytes) else Path(path_or_bytes).read_bytes()
    rows = _rows(content, COLUMNS)
    return rows[:, :3], rows[:, 3:6], rows[:, 6]


def read_cloud_gaze(content: bytes) -> np.ndarray:
    """(k, 7) f8 x y z nx ny nz seconds, of the bytes of a cloud of the same experiment, which lacks the last column."""
    return _rows(content, COLUMNS - 1)


def _rows(content, columns):
    if not content.strip():
        raise ValueError("the gaze file is empty")
    lines, first, header = lines_of(text_of(content))
    numbers = [i for i, line in enumerate(lines) if line.strip() and not line.lstrip().startswith("#")]
    if not numbers:
        raise ValueError(f"not a gaze file of numbers in {columns} columns: no line begins with a number")
    if header and header[0][0] not in "#/" and sum(map(bool, map(NUMBER.match, header))) >= columns // 2:
        raise ValueError(f"line {first} is no row of numbers, and no header: {' '.join(header)[:80]}")
    names = [name for word in header if (name := word.strip("#/").lower())]
    place = next((i for i, name in enumerate(names) if name.startswith(SECONDS)), SECONDS_AT)
    if len(names) == columns and ("x" in names[1:] or place != SECONDS_AT):
        order = f"{ORDER}{' label' if columns == COLUMNS else ''}"
        raise ValueError(f"its columns are {' '.join(names)}: order them as {order}")
    try:
        rows = np.loadtxt([lines[i] for i in numbers], ndmin=2)
    except ValueError as error:
        raise ValueError(f"not a gaze file of numbers in {columns} columns: {error}") from None
    if rows.shape[1] != columns:
        raise ValueError(f"a gaze file has {columns} columns, got {rows.shape[0]} rows of {rows.shape[1]}")
    bad = np.flatnonzero(~np.isfinite(rows).all(axis=1) | (rows[:, SECONDS_AT] < 0))
    if len(bad):
        line, remedy = first + numbers[bad[0]] + 1, "remove them, or write 0 seconds"
        raise ValueError(f"{len(bad)} rows hold NaN or negative seconds, the first in line {line}: {remedy}")
    return rows


def match_rows(mesh: Mesh, positions: np.ndarray, tolerance: float = 0.0) -> tuple[np.ndarray, np.ndarray]:
    """The vertex of each position: (vertex (k,) i8, -1 if none; distance (k,) to the nearest vertex).

    mesh: as read from the file, before rotation and scaling. Of vertices at the same position the lowest id is given.
    """
    places, first = np.unique(mesh.vertices, axis=0, return_index=True)
    distance, nearest = KDTree(places).query(positions)
    return np.where(distance <= tolerance, first[nearest], -1), distance


def gaze_on_vertices(mesh: Mesh, positions: np.ndarray, seconds: np.ndarray, tolerance: float = 0.0) -> np.ndarray:
    """(n,) f8: the seconds of gaze summed at the vertices of the mesh as published, before rotation and scaling.

    positions (k, 3) and seconds (k,): of `read_gaze`; tolerance: in units of the file, 0 since the published rows
    repeat the coordinates exactly. Vertices at the same position share its seconds equally. Rows without a vertex
    (`match_rows`) are left out: they are interpolated from their neighbours. Raises ValueError with the distances when
    rows are off the mesh or less than half of them match, and for NaN and negative seconds.
    """
    seconds = np.asarray(seconds, dtype=np.float64)
    if not len(seconds):
        raise ValueError("no row of gaze: positions and seconds are empty")
    if not (np.isfinite(positions).all() and (seconds >= 0).all() and (seconds < np.inf).all()):
        raise ValueError("positions must be finite, and seconds finite and not negative: leave the other rows out")
    vertex, distance = match_rows(mesh, positions, tolerance)
    size = max(mesh.diagonal, np.finfo(float).tiny)
    times = np.linalg.norm(np.ptp(positions, axis=0)) / size
    _check_matches(vertex < 0, distance / size, f"The rows are {times:.4g} times as large" * (not 0.2 < times < 5))
    n = len(mesh.vertices)
    amounts = np.bincount(vertex[vertex >= 0], seconds[vertex >= 0], minlength=n)
    _, first, place, count = np.unique(
        mesh.vertices, axis=0, return_index=True, return_inverse=True, return_counts=True
    )
    return (amounts[first] / count)[place.ravel()]


def _check_matches(unmatched, distance, scale):
    off = np.flatnonzero(unmatched & (distance > OFF_MESH))
    if len(off) == 0 and unmatched.mean() <= 1 - MIN_MATCHED:
        return
    worst = np.argsort(-distance, kind="stable")[:3]
    rows = ", ".join(f"row {row + 1}: {distance[row]:.2%}" for row in worst)
    raise ValueError(
        f"{unmatched.sum()} of {len(unmatched)} gaze rows match no vertex and {len(off)} are off the mesh; distances as"
        f" shares of its diagonal: median {np.median(distance[unmatched]):.2%}, largest {rows}. Is it the file of this"
        f" mesh, in the units of the mesh file?{scale and f' {scale} as the mesh.'}"
    )


TOLERANCE = 0.01  # of the diagonal, between the position of a mark and its vertex; larger if the mesh was changed


def annotations_on_vertices(mesh: Mesh, path: str | Path, content: bytes | None = None) -> np.ndarray:
    """(n,) f8: how many annotators marked each vertex of the normalised mesh.

    path: a CSV with columns annotator, time, vertex, x, y, z (haptic_glance.look.marks); content: what it holds, where
    that is known. Since vertices are stored by
    id, marks would move on a mesh that was changed. Raises ValueError with the file, the rows and their distances when
    a vertex does not exist or is farther than 1 % of the diagonal from the position of the mark.
    """
    marks, n = read_marks(path, content), len(mesh.vertices)
    vertex, positions = marks.vertex.to_numpy(), marks[["x", "y", "z"]].to_numpy()
    limit = TOLERANCE * max(mesh.diagonal, np.finfo(float).tiny)
    if len(vertex) and vertex.min() > 0 and vertex.max() <= n:
        as_counted, one_less = (
            np.linalg.norm(positions - mesh.vertices[ids], axis=1) for ids in (np.minimum(vertex, n - 1), vertex - 1)
        )
        if (as_counted > limit).any() and (one_less <= limit).all():
            raise ValueError(f"{path}: its vertices are counted from 1; count them from 0")
    outside = np.flatnonzero((vertex < 0) | (vertex >= n))
    if len(outside):
        raise ValueError(f"{path}, row {outside[0] + 1}: vertex {vertex[outside[0]]} is not in 0..{n - 1}")
    lengths = np.linalg.norm(positions - mesh.vertices[vertex], axis=1)
    distance = lengths / max(mesh.diagonal, np.finfo(float).tiny)
    far = np.flatnonzero(distance > TOLERANCE)
    if len(far):
        lines = ", ".join(f"row {row + 1}: {distance[row]:.2%}" for row in far[:5])
        raise ValueError(
            f"{path}: {len(far)} of {len(marks)} marks are off the mesh, as shares of its diagonal {lines}; they belong"
            " to another mesh or to an earlier version, or are not in units of the normalised mesh, and are not used:"
            " mark this mesh in the studio"
        )
    distinct = marks.drop_duplicates(["annotator", "vertex"])
    return np.bincount(distinct.vertex, minlength=n).astype(np.float64)


def marked_files(meshes: Iterable[tuple[str, Mesh]], folder: str | Path) -> dict[str, list[tuple[str, partial[bytes]]]]:
    """{object: its file of marks, (path, function that gives the bytes)} of the objects that a file fits.

    meshes: (name, normalised mesh) of each object. A file fits the mesh on whose vertices its marks lie, whatever both
    are called; the file of the object's own name is tried first. An object whose namesake fits no mesh at hand keeps
    it, so that its reader can say why it is of no use.
    """
    files = {path.stem: path for path in sorted(Path(folder).glob("*.csv"))}
    for path in files.values():
        try:
            read_marks(path)
        except MarksError as error:
            print(f"marks are not used: {error}", file=sys.stderr)
    stems, strange = {}, {}
    for name, mesh in meshes:
        namesake = [name] if name in files else []
        fitting = next((stem for stem in [*namesake, *files] if _fits(mesh, files[stem])), None)
        stems |= {name: fitting} if fitting else {}
        strange |= {name: name for name in namesake if not fitting}
    stems |= {name: stem for name, stem in strange.items() if stem not in stems.values()}
    return {name: [(str(files[stem]), partial(bytes, files[stem].read_bytes()))] for name, stem in stems.items()}


def _fits(mesh, path):
    try:
        return bool(annotations_on_vertices(mesh, path).any())
    except ValueError:
        return False


VIEWS = ("300", "413", "599")
DENSITY, VISIBLE = "FixationMaps/{}_{}norm.txt", "CentricityAndVisibilityMaps/{}_{}_visibility.txt"
Files = list[tuple[str, Callable[[], bytes]]]  # (path, function that reads the bytes) of each


def fixation_files(files: Mapping[str, Callable[[], bytes]]) -> dict[str, Files]:
    """{object: its files, density and visibility of each view} of a collection (stages.meshes.sources).

    Raises ValueError that names a map which an object lacks.
    """
    matches = [(re.search(r"(FixationMaps|CentricityAndVisibilityMaps)/[^/]+\.txt$", path), path) for path in files]
    maps = {match[0]: (path, files[path]) for match, path in matches if match}
    names = sorted({path.split("/")[1].rsplit("_", 1)[0] for path in maps if path.endswith("norm.txt")})
    by_name = {name: [form.format(name, view) for view in VIEWS for form in (DENSITY, VISIBLE)] for name in names}
    missing = sorted(path for paths in by_name.values() for path in paths if path not in maps)
    if missing:
        raise ValueError(f"no {', '.join(missing)}: unpack both archives")
    return {name: [maps[path] for path in paths] for name, paths in by_name.items()}


def fixations_on_vertices(files: Files, mesh: Mesh) -> np.ndarray:
    """(n,) f8: how much people looked at each vertex of a mesh, the mean of the views that see it.

    files: of one object, as fixation_files gives them. A density counts by the area of its vertex. Raises ValueError
    that names the file where a map is not a list of numbers, one per vertex (the map of turbine is published with one
    line too few).
    """
    values = np.array([_values(path, content(), len(mesh.vertices)) for path, content in files])
    densities, visible = values[0::2], values[1::2] > 0
    return (densities * visible).sum(axis=0) / np.maximum(visible.sum(axis=0), 1) * mesh.vertex_areas


def _values(path, content, vertices):
    try:
        values = np.array(text_of(content).replace(",", ".").split(), dtype=np.float64)
    except ValueError as error:
        raise ValueError(f"{path}: not one number per line ({error})") from None
    if len(values) != vertices:
        raise ValueError(f"{path} has {len(values)} values for {vertices} vertices: is it the map of this mesh?")
    if not (np.isfinite(values) & (values >= 0)).all():
        raise ValueError(f"{path} holds NaN or negative values")
    return values

"""Ground truth of an object of any collection, at vertices and as maps (T3.2.1.3).

The map of a view has a Gaussian at each visible point. Amounts at vertices are spread over the surface by heat flow,
which is a Gaussian in the plane.

Interest points are those of the NIST benchmark (Dutagaci, Cheung and Godil 2012, T [7]). Its folder IP_BENCHMARK holds
MODEL_DATASET/NAME.mat (V, F, counted from 1) and OUTPUT_DATA/GROUND_TRUTH_A/NAME.mat (24 models, 23 users) and
GROUND_TRUTH_B/NAME.mat (43 models, 16 users). Each file holds GT_MODEL, a cell array of ten radii by the minimum number
of users 2..N by two: the vertices of the points, and for each point the marks of its cluster.
"""

import hashlib
import sys
from collections.abc import Callable, Iterable
from functools import lru_cache
from pathlib import Path

import numpy as np
import robust_laplacian
from scipy import sparse
from scipy.sparse.linalg import splu
from scipy.spatial import KDTree

from haptic_glance.base.warner import warn_caller
from haptic_glance.look.camera import Viewpoint, pixel_rays, project
from haptic_glance.mesh.files import parse
from haptic_glance.mesh.mesh import Mesh
from haptic_glance.mesh.rays import RayScene
from stages.meshes.sources import (
    FIXATION_MAPS,
    GAZE,
    GAZE_CLOUDS,
    INTEREST_POINTS,
    collection_files,
    match_files,
    read_mat,
)

from .gaze import (
    MIN_MATCHED,
    annotations_on_vertices,
    fixation_files,
    fixations_on_vertices,
    gaze_on_vertices,
    marked_files,
    match_rows,
    read_cloud_gaze,
    read_gaze,
)

PUBLISHED = (
    "gaze",
    "gaze_clouds",
    "interest_points",
    "fixation_maps",
)  # the sources whose collection holds ground truth

Files = list[tuple[str, Callable[[], bytes]]]  # (path, function that reads the bytes) of each


def ground_truth_amounts(name: str, source: str, mesh: Mesh, files: Files) -> np.ndarray | None:
    """(n,) f8 amounts at the vertices of the normalised mesh of an object, or None if it has no ground truth.

    name, source: the object, and the setting meshes.source that it was read with. files: of ground_truth_files. The
    amounts are seconds of gaze (source gaze), marks of the users (interest_points), densities of fixations by area
    (fixation_maps), or the number of annotators who marked a vertex (any other source).
    `spread_on_surface` turns them into a density. Raises ValueError when the ground truth does not fit the mesh.
    """
    if not files:
        return None
    amounts = READERS.get(source, _marks)(files, mesh)
    if len(amounts) != len(mesh.vertices):
        raise ValueError(f"{name}: the published mesh has {len(amounts)} vertices, this one {len(mesh.vertices)}")
    return amounts


def ground_truth_files(
    meshes: Iterable[tuple[str, Mesh]], source: str, published: str | Path, marks: Path
) -> dict[str, Files]:
    """{object: the files that its ground truth comes from} of the objects that have ground truth, in their order.

    meshes: (name, normalised mesh) of each; published: meshes.folder; marks: the folder of annotations.
    """
    if source not in PUBLISHED:
        return dict(marked_files(meshes, marks))
    files = published_files(source, published)
    return {name: files[name] for name, _ in meshes if name in files}


def digest(files: Files) -> str:
    """The hash of the content of files."""
    return hashlib.sha256(b"".join(hashlib.sha256(reader()).digest() for _, reader in files)).hexdigest()


def published_files(source: str, folder: str | Path) -> dict[str, Files]:
    """{object: the published files that its ground truth comes from}; {} for a source that has none.

    folder: meshes.folder. Raises FetchError when the collection is missing.
    """
    if source not in PUBLISHED:
        return {}
    if source == "interest_points":
        points = match_files(collection_files(folder, *INTEREST_POINTS), r"GROUND_TRUTH_B/([^/]+)\.mat")
        return {name: [file] for name, file in points.items()}
    if source == "fixation_maps":
        return fixation_files(collection_files(folder, *FIXATION_MAPS))
    if source == "gaze_clouds":
        clouds = match_files(collection_files(folder, *GAZE_CLOUDS), r"([^/]+)\.txt")
        return {name: [file] for name, file in clouds.items()}
    files = collection_files(folder, *GAZE)
    tables, models = match_files(files, r"dataset_[^/]+/([^/]+)\.txt"), match_files(files, r"Models_3D/([^/]+)\.obj")
    for name in sorted(set(tables) - set(models)):
        warn_caller(f"{name} is left out: no Models_3D/{name}.obj holds its mesh")
    return {name: [tables[name], models[name]] for name in tables if name in models}


ROUNDED = 5e-4  # of the diagonal: a row this near a vertex, where most have been rounded, is of the vertex


def _gaze(files, _):
    (path, table), (_, model) = files
    # Coordinates agree exactly only with the mesh as published; normalising keeps the order of the vertices.
    mesh = parse(model(), ".obj")
    positions, _, seconds = _named(path, read_gaze, table())
    vertex, distance = match_rows(mesh, positions)
    tolerance = 0.0
    if np.mean(vertex < 0) > 1 - MIN_MATCHED:  # another program rounded the coordinates
        tolerance = ROUNDED * mesh.diagonal
        vertex, distance = match_rows(mesh, positions, tolerance)
    unmatched = np.flatnonzero(vertex < 0)
    amounts = _named(path, lambda rows: gaze_on_vertices(mesh, rows, seconds, tolerance), positions)
    if len(unmatched):
        shares, rows = distance[unmatched] / mesh.diagonal, ", ".join(str(row + 1) for row in unmatched[:3])
        print(
            f"{path}: {len(unmatched)} of {len(positions)} rows match no vertex and are left out, with"
            f" {seconds[unmatched].sum():.0f} of {seconds.sum():.0f} s of gaze; they are {shares.min():.2%} to"
            f" {shares.max():.2%} of the diagonal off; rows {rows}{', ...' if len(unmatched) > 3 else ''}",
            file=sys.stderr,
        )
    return amounts


def _gaze_clouds(files, _):
    ((path, content),) = files
    rows, surface = _named(path, read_cloud_gaze, content()), parse(content(), ".xyz")
    nearest = KDTree(surface.vertices).query(rows[:, :3])[1]
    return np.bincount(nearest, rows[:, 6], minlength=len(surface.vertices))


def _named(path, read, content):
    """The result of read(content); its ValueError gets the name of the file."""
    try:
        return read(content)
    except ValueError as error:
        raise ValueError(f"{path}: {error}") from None


def _marks(files, mesh):
    ((path, content),) = files
    return annotations_on_vertices(mesh, path, content())


def _interest_points(files, mesh):
    ((path, content),), count = files, len(mesh.vertices)
    vertices, marks = _named(path, read_interest_points, content())
    if vertices.max(initial=-1) >= count:
        raise ValueError(f"{path} names vertex {vertices.max()}, the mesh has {count}")
    return np.bincount(vertices, marks, minlength=count)


READERS = {
    "gaze": _gaze,
    "gaze_clouds": _gaze_clouds,
    "interest_points": _interest_points,
    "fixation_maps": fixations_on_vertices,
}


ROWS = 900  # of the thesis's images, for which the kernel size is stated
KERNEL = 50  # pixels per side at 900 rows; T3.2.1.3
SIGMA = 0.15  # of the kernel's side: 7.5 pixels at 900 rows
SAME_DEPTH = 1e-6  # units: above the rounding of a ray, far below the thinnest wall


def gts_map(rows: np.ndarray, columns: np.ndarray, mask: np.ndarray) -> np.ndarray:
    """(h, w) f8 in 0..1: the ground truth saliency map of points at fractional pixels rows (k,), columns (k,).

    T3.2.1.3: a Gaussian kernel of 50 by 50 pixels with sigma 0.15 at each point, zero off the object (mask (h, w)
    boolean). The thesis does not state the unit of sigma. In pixels, the kernel would be a single bright pixel, not the
    "round region of saliency" of the text. As a share of the kernel's side, sigma is 7.5 pixels. At the border of the
    kernel, 25 pixels from the point, the Gaussian is then 0.0039, one grey level of 255, so that the kernel contains
    the visible part of a round region. The kernel scales with the rows of smaller maps. Where regions overlap the
    maximum is taken, so that all points are equally bright. Raises ValueError for rows and columns of different lengths
    or with NaN.
    """
    rows, columns, mask = np.asarray(rows, dtype=float), np.asarray(columns, dtype=float), np.asarray(mask, dtype=bool)
    if rows.shape != columns.shape or rows.ndim != 1 or mask.ndim != 2:
        shapes = f"{rows.shape}, {columns.shape} and {mask.shape}"
        raise ValueError(f"rows, columns and mask must be (k,), (k,) and (h, w), got {shapes}")
    if not np.isfinite([rows, columns]).all():
        raise ValueError("rows or columns hold NaN or infinite values")
    side = KERNEL * mask.shape[0] / ROWS
    values = np.zeros(mask.shape)
    for row, column in zip(rows, columns, strict=True):
        r, across = _profile(row, side, mask.shape[0])
        c, down = _profile(column, side, mask.shape[1])
        values[r, c] = np.maximum(values[r, c], across[:, None] * down)
    return np.where(mask, values, 0)


def _profile(centre, side, count):
    """The pixels of a row or column within the kernel, as a slice, and the Gaussian's values there."""
    low = int(np.clip(np.ceil(centre - side / 2), 0, count))
    high = int(np.clip(np.floor(centre + side / 2) + 1, low, count))
    return slice(low, high), np.exp(-(((np.arange(low, high) - centre) / (SIGMA * side)) ** 2) / 2)


def visible_points(
    mesh: Mesh, vertices: np.ndarray, viewpoint: Viewpoint, size: tuple[int, int]
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """The vertices (k,) that a viewpoint sees: (rows (j,), columns (j,), indices (j,) i8 into `vertices`).

    rows and columns are fractional pixels of an image of `size` (h, w) by the thesis's camera
    (haptic_glance.look.camera). Visibility is exact: the ray through the vertex meets nothing in front of it. A vertex
    in no face is treated as a point. Raises ValueError for vertices that the mesh does not have.
    """
    vertices = np.asarray(vertices, dtype=np.int64)
    if vertices.ndim != 1 or ((vertices < 0) | (vertices >= len(mesh.vertices))).any():
        raise ValueError(f"vertices must be (k,) ids in 0..{len(mesh.vertices) - 1}, got {vertices}")
    rows, columns, depth = project(mesh.vertices[vertices], viewpoint, size)
    hits = _scene(mesh).cast(*pixel_rays(rows, columns, viewpoint, size))
    indices = np.flatnonzero(hits.distance >= depth - SAME_DEPTH)
    return rows[indices], columns[indices], indices


@lru_cache(maxsize=1)
def _scene(mesh):
    """The RayScene of the last mesh: building it takes most of a call, and a mesh is seen from many viewpoints."""
    return RayScene(mesh)


STEPS = 32  # errors on a plane: 4 % at the peak and 2.4 % in L1; with 8 steps 15 % and 8 %
MIN_AREA = 1e-12  # of the squared diagonal; for vertices between faces without area


def spread_on_surface(mesh: Mesh, amounts: np.ndarray, sigma: float) -> np.ndarray:
    """(n,) f8 density per square unit: amounts (n,) at the vertices spread over the surface with deviation sigma.

    Heat flow for the time sigma^2 / 2, which in the plane is the Gaussian of deviation sigma, by implicit steps
    (A + dt L) u' = A u with the vertex areas A and the intrinsic Delaunay Laplacian L (Sharp and Crane 2020, A
    Laplacian for Nonmanifold Triangle Meshes). L has no negative weights, so the density is not negative, and it is
    accurate on any triangulation: clipped cotangents spread 4 to 19 % too wide on a plane with jittered vertices. Area
    times density sums to the amounts. Nothing spreads between connected components. Vertices at the same position are
    merged, so that seams do not stop the flow. sigma: in units of the mesh; if it is far below the length of an edge,
    the amounts stay at their vertices.

    Raises ValueError for amounts of another shape, negative or NaN, for amounts at vertices in no face, and for a sigma
    that is not positive.
    """
    amounts = np.asarray(amounts, dtype=np.float64)
    if amounts.shape != (len(mesh.vertices),):
        raise ValueError(f"amounts must have shape ({len(mesh.vertices)},), one per vertex, got {amounts.shape}")
    if not np.isfinite(amounts).all() or (amounts < 0).any():
        raise ValueError("amounts must be finite and not negative: set missing values to 0")
    if not (np.isfinite(sigma) and sigma > 0):
        raise ValueError(f"sigma must be a positive length, got {sigma}")
    density = np.zeros(len(amounts))
    if not amounts.any():
        return density
    size = mesh.diagonal or 1.0  # lengths relative to the diagonal, so that the result does not depend on the unit
    positions, position, faces = _surface(mesh, size)
    ids = np.unique(faces)
    heat = np.bincount(position, amounts, minlength=len(positions))
    bare = np.setdiff1d(np.flatnonzero(heat), ids)
    if len(bare):
        raise ValueError(f"amounts at {len(bare)} positions in no face, the first at {positions[bare[0]] * size}")
    density = np.zeros(len(positions))
    density[ids] = _flow(positions[ids], np.searchsorted(ids, faces), heat[ids], (sigma / size) ** 2 / 2)
    return density[position] / size**2


def _surface(mesh, size):
    """(positions (p, 3), position id per vertex (n,), faces (m', 3)): equal vertices merged, no degenerate faces."""
    positions, position = np.unique(mesh.vertices / size + 0.0, axis=0, return_inverse=True)  # + 0.0: no -0.0
    position = position.reshape(-1)
    a, b, c = position[mesh.faces].T
    return positions, position, position[mesh.faces][(a != b) & (b != c) & (c != a)]


def _flow(vertices, faces, heat, time):
    """Heat (n,) per area after a time."""
    laplacian, _ = robust_laplacian.mesh_laplacian(vertices, faces)
    corners = vertices[faces]
    areas = np.linalg.norm(np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]), axis=1) / 2
    area = np.bincount(faces.ravel(), np.repeat(areas / 3, 3), minlength=len(vertices))
    area = np.maximum(area, MIN_AREA)
    system = sparse.diags(area) + time / STEPS * laplacian
    solver = splu(system.tocsc(), permc_spec="MMD_AT_PLUS_A", diag_pivot_thresh=0, options={"SymmetricMode": True})
    for _ in range(STEPS):
        heat = area * solver.solve(heat)
    return np.maximum(heat / area, 0)


SIGMAS = np.arange(1, 11) / 100  # radii of a cluster, as shares of the model's diameter (Dutagaci 2012, section 4)
MARK_SIGMA, USERS = 0.03, 8  # half of the 16 users must agree, within the radius most used in the paper


def read_interest_points(
    path_or_bytes: str | Path | bytes, sigma: float = MARK_SIGMA, users: int = USERS
) -> tuple[np.ndarray, np.ndarray]:
    """(vertices (k,) i8 from 0, marks (k,) i8): the points on which at least `users` agree within `sigma`.

    sigma: 0.01, 0.02 ... 0.1 of the largest distance of two vertices; marks: the number of marks in the cluster of each
    point, its weight in the weighted miss error. Raises ValueError for a file of another layout, a sigma that it does
    not have, or more users than took part.
    """
    content = path_or_bytes if isinstance(path_or_bytes, bytes) else Path(path_or_bytes).read_bytes()
    (cells,) = read_mat(content, ["GT_MODEL"])
    if cells.dtype != object or cells.ndim != 3 or cells.shape[0] != len(SIGMAS) or cells.shape[2] != 2:
        raise ValueError(f"GT_MODEL must be {len(SIGMAS)} radii by users by two cells, got {cells.dtype} {cells.shape}")
    radius = np.flatnonzero(np.isclose(SIGMAS, sigma))
    if len(radius) == 0:
        raise ValueError(f"sigma {sigma} is not one of {', '.join(f'{value:g}' for value in SIGMAS)}")
    available = cells.shape[1] + 1
    if not 2 <= users <= available:
        raise ValueError(f"users must be in 2..{available}, the number of users of this model, got {users}")
    points, clusters = cells[radius[0], users - 2]
    vertices = np.ravel(points).astype(np.int64) - 1
    marks = [len(_text(cluster).split()) for cluster in np.ravel(clusters)]
    if len(marks) != len(vertices) or (vertices < 0).any():
        raise ValueError(f"{len(vertices)} points, the lowest {vertices.min(initial=0) + 1}, and {len(marks)} clusters")
    return vertices, np.array(marks, dtype=np.int64)


def _text(cell):
    """The marks of one cluster, which are stored as numbers in a text."""
    return " ".join(str(part) for part in np.ravel(cell))

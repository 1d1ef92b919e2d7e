"""Conspicuity of values on the visible surface, smoothed over the surface and projected to the mesh (T3.2.6).

Smoothing fills the surface that no view sees.
"""

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np
from scipy import sparse
from scipy.sparse.linalg import splu

from haptic_glance.base.jit import cached_njit
from haptic_glance.base.weak_cache import weak_cache
from haptic_glance.mesh.mesh import Mesh

from ..camera import DISTANCE, screen_position
from ..views import View
from .cropped_view import cropped_view, fill
from .operators import OUTPUT_SCALE, centre_surround, normalise, pyramid

kernel = cached_njit()
FLOOR = 0.02  # of the range of the values; a flatter map is noise of the mesh
SCALE = 1  # one scale finer than centre-surround starts at, so that small faces are not aliased


@dataclass(frozen=True)
class VisibleSurface:
    """The k surface points that a view shows: at the true pixels of known (h, w), of the crop at SCALE, in order.

    faces (k,), weights (k, 3) barycentric, points (k, 3), back (3,) the direction from the surface to the camera.
    """

    known: np.ndarray
    faces: np.ndarray
    weights: np.ndarray
    points: np.ndarray
    back: np.ndarray


@weak_cache
def visible_surface(view: View, mesh: Mesh) -> VisibleSurface:
    """The VisibleSurface of a view of a mesh. Raises ValueError when the view has faces that the mesh does not have."""
    if view.face.max(initial=-1) >= len(mesh.faces):
        raise ValueError(
            f"the view shows face {view.face.max()}, the mesh has {len(mesh.faces)} faces: render this mesh again"
        )
    box, step = cropped_view(view).box, 2**SCALE
    face = view.face[box][::step, ::step]
    mask = face >= 0
    rows, columns = np.nonzero(mask)
    rows, columns = rows * step + box[0].start, columns * step + box[1].start
    right, up = screen_position(rows, columns, view.face.shape)
    heights, axes = DISTANCE - view.depth[rows, columns].astype(np.float64), view.viewpoint.axes
    geometry = mesh.vertices, mesh.faces, mesh.face_crosses
    points, weights = locate_pixels(right, up, heights, axes, face[mask], *geometry)
    return VisibleSurface(mask, face[mask], weights, points, axes[2])


def surface_conspicuity(
    values: np.ndarray, mesh: Mesh, view: View, filled: bool = True, on_centre: bool = False
) -> np.ndarray:
    """Centre-surround and N of values (k,) at the points of visible_surface: a map (h / 16, w / 16) f4 (T3.1.1).

    on_centre: see haptic_glance.look.channels.operators.centre_surround. The values extend into the background; with
    filled=False it is zero.
    """
    image, mask = cropped_view(view), visible_surface(view, mesh).known
    image_values = np.zeros(mask.shape, dtype=np.float32)
    image_values[mask] = values
    image_values = fill(image_values, mask) if filled else image_values
    summed = centre_surround(pyramid(image_values, SCALE), image.cover, FLOOR, on_centre)
    return image.place_in_view(normalise(summed, image.cover[OUTPUT_SCALE]), OUTPUT_SCALE)


SMOOTHING = 0.02  # units; a few faces wide, so that single faces do not show in the map
FILL_DISTANCE = 0.2  # units over which values extend into hidden surface; the inside of a teapot must stay dark
MIN_FILL = 1e-6  # keeps the equations solvable without smoothing
MIN_CONFIDENCE = 1e-6  # less is a glance along the surface: where no vertex of a part has more, no view sees it
MIN_AREA = 1e-9  # square units; for vertices in no face and faces without area
MAX_COTANGENT = 1e3  # larger ones come from slivers and would make the equations ill-conditioned


def smoother(mesh: Mesh, confidence: np.ndarray, length: float = SMOOTHING) -> Callable[[np.ndarray], np.ndarray]:
    """A function that smooths values (n,) or (n, d) on the vertices, staying close to them where confidence is high.

    confidence (n,) in 0..1, length in units. Solves (C A + H A + length^2 L) s = C A v: Tikhonov regularisation with
    the cotangent Laplacian L (Pinkall and Polthier 1993) and the vertex areas A, so that the result does not depend on
    the resolution of the mesh. Where confidence C is zero, H = (length / FILL_DISTANCE)^2 fills values in from the
    neighbours, decreasing with distance. A component that no view sees gets zero. Negative cotangents count as zero,
    which keeps the result between zero and the largest value.
    """
    area = np.maximum(mesh.vertex_areas, MIN_AREA)
    fill_weight = np.where(confidence > MIN_CONFIDENCE, 0, max(length / FILL_DISTANCE, MIN_FILL) ** 2)
    system = sparse.diags((confidence + fill_weight) * area) + length**2 * laplacian(mesh)
    solve = solver_of(system)
    return lambda values: solve(((confidence * area) * np.asarray(values).T).T)


def solver_of(system: Any) -> Callable[[np.ndarray], np.ndarray]:
    """The function that solves a sparse, symmetric and positive definite system (n, n) for right sides (n,) or (n, d).

    The factors need no pivots.
    """
    return splu(system.tocsc(), permc_spec="MMD_AT_PLUS_A", diag_pivot_thresh=0, options={"SymmetricMode": True}).solve


def laplacian(mesh: Mesh) -> sparse.csr_matrix:
    """(n, n) sparse cotangent Laplacian, positive semi-definite, cotangents clipped to 0..MAX_COTANGENT."""
    n = len(mesh.vertices)
    corners = mesh.vertices[mesh.faces]
    a, b = np.roll(corners, -1, axis=1) - corners, np.roll(corners, -2, axis=1) - corners
    double_area = np.maximum(2 * mesh.face_areas, MIN_AREA)[:, None]
    half_cotangents = np.clip(np.einsum("mki,mki->mk", a, b) / double_area, 0, MAX_COTANGENT).ravel() / 2
    tails, heads = np.roll(mesh.faces, -1, axis=1).ravel(), np.roll(mesh.faces, -2, axis=1).ravel()
    one_way = sparse.coo_matrix((half_cotangents, (tails, heads)), shape=(n, n))
    weights = one_way + one_way.T
    return sparse.diags(np.asarray(weights.sum(axis=1)).ravel()) - weights


def nearest_corners(mesh: Mesh, faces: np.ndarray, positions: np.ndarray) -> np.ndarray:
    """(k,) i8: the corner of each face (k,) nearest to a position (k, 3).

    T3.2.6 takes the vertex nearest to the centroid of the face, whichever point of the face was seen. The corner
    nearest to the point itself is never farther away, and on slivers, common in CAD meshes, it is much nearer.
    """
    corners = mesh.faces[faces]
    distance = ((mesh.vertices[corners] - positions[:, None]) ** 2).sum(axis=2)
    return corners[np.arange(len(corners)), distance.argmin(axis=1)]


@kernel
def locate_pixels(
    right: np.ndarray, up: np.ndarray, heights: np.ndarray, axes: np.ndarray, face_ids: np.ndarray,
    vertices: np.ndarray, faces: np.ndarray, crosses: np.ndarray,
) -> tuple[np.ndarray, np.ndarray]:  # fmt: skip
    """(points (k, 3), barycentric weights (k, 3) in 0..1) of k pixels that show the faces `face_ids` (k,).

    right, up, heights (k,): the coordinates of a point along the camera's axes (3, 3), see Viewpoint.axes.
    vertices (n, 3) and faces (m, 3) of the mesh; crosses (m, 3): the faces' normals, of twice their area.
    """
    count = len(face_ids)
    points, weights = np.empty((count, 3)), np.empty((count, 3))
    for k in range(count):
        px = right[k] * axes[0, 0] + up[k] * axes[1, 0] + heights[k] * axes[2, 0]
        py = right[k] * axes[0, 1] + up[k] * axes[1, 1] + heights[k] * axes[2, 1]
        pz = right[k] * axes[0, 2] + up[k] * axes[1, 2] + heights[k] * axes[2, 2]
        points[k, 0], points[k, 1], points[k, 2] = px, py, pz
        a, b, c = faces[face_ids[k]]
        nx, ny, nz = crosses[face_ids[k]]
        ax, ay, az = vertices[a]
        bx, by, bz = vertices[b, 0] - ax, vertices[b, 1] - ay, vertices[b, 2] - az
        cx, cy, cz = vertices[c, 0] - ax, vertices[c, 1] - ay, vertices[c, 2] - az
        px, py, pz = px - ax, py - ay, pz - az
        square = max(nx * nx + ny * ny + nz * nz, 1e-300)
        second = ((py * cz - pz * cy) * nx + (pz * cx - px * cz) * ny + (px * cy - py * cx) * nz) / square
        third = ((by * pz - bz * py) * nx + (bz * px - bx * pz) * ny + (bx * py - by * px) * nz) / square
        first = min(max(1 - second - third, 0.0), 1.0)
        second, third = min(max(second, 0.0), 1.0), min(max(third, 0.0), 1.0)
        total = first + second + third
        weights[k, 0], weights[k, 1], weights[k, 2] = first / total, second / total, third / total
    return points, weights

"""Samples of a mesh or a cloud: exact moments of what lies in each cell of a grid that belongs to the object.

Samples of a rough surface are moved onto the smooth one that they scatter about.
"""

from dataclasses import replace

import numpy as np
from scipy.spatial import KDTree

from haptic_glance.mesh.mesh import Mesh, unit

from .cells import ROUNDING, cut
from .samples import Samples, nearest, object_axes

COUNT = 15_000  # about as many samples: fewer lose detail such as eyes, more cost time
CELL = 1.08  # side of a cell, in units of the square root of the area per sample; leaves about COUNT cells
SMALLEST = 2.0**-10  # side of a cell: a smaller one, of a mesh with next to no area, would tell nothing more
# length of a cell's mean normal: below the first an edge may be in it, below the second two sides of a sheet are; two
# sides of an edge whose own mean normals are longer than PLAIN get a sample each
BENT, TWO_SIDES, PLAIN = 0.95, 0.3, 0.95
# share of the surface in bent cells without two plain sides above which it has noise rather than edges and sheets: at
# most 0.23 of 160 clean objects, 0.43 or more at noise of 0.5 % of the diagonal
ROUGH_SHARE = 0.25
NUDGE = 1e-6  # added to the spread of the normals in a cell, so that of two directions alike the same one is taken
BETWEEN = 1e-5  # component of a normal along that direction below which its piece belongs to both sides alike
LEAST_FLAT = 0.05  # of the area in a cell: noise may turn all that lies in it
LEAST = 1e-9  # of the area per sample: a piece below it is rounding


def samples_of_mesh(mesh: Mesh, count: int = COUNT) -> Samples:
    """The Samples of a normalised mesh whose faces are oriented.

    They depend on the surface alone, not on its faces, their order or the turn about the vertical. Raises ValueError
    for a mesh without area.
    """
    area = float(mesh.face_areas.sum())
    if not area > 0:
        raise ValueError("cannot sample a mesh without area")
    # the second moments of a triangle are those of its corners, a twelfth of the area each, and its middle
    middles = mesh.vertices.take(mesh.faces, axis=0).sum(axis=1) / 3
    corners = mesh.vertices[mesh.used]
    masses = np.concatenate([mesh.vertex_areas[mesh.used] / 4, mesh.face_areas * 3 / 4])
    axes, middle = object_axes(np.concatenate([corners, middles]), masses, corners)
    side = max(CELL * np.sqrt(area / count), SMALLEST)
    pieces = cut(((mesh.vertices - middle) @ (axes.T / side)).take(mesh.faces, axis=0))
    if (is_rounding := pieces[:, 4] * side**2 <= LEAST * area / count).any():
        pieces = pieces[~is_rounding]
    places = pieces[:, 5:] @ (axes * side) + middle
    normals = mesh.face_normals[pieces[:, 0].astype(np.int64)]
    return denoised(_gathered(pieces[:, 1:4].astype(np.int64), places, normals, pieces[:, 4] * side**2, axes))


def samples_of_points(points: np.ndarray, normals: np.ndarray, count: int = COUNT) -> Samples:
    """The Samples of a normalised point cloud (n, 3) with unit normals (n, 3), outwards; all have the same area.

    Raises ValueError for fewer than two points at different places.
    """
    square_gaps = KDTree(points).query(points, 2)[0][:, 1] ** 2
    area, count = float(square_gaps.sum()) * np.pi / 2, min(count, max(len(points) // 2, 1))  # of evenly spread points
    if not 0 < area < np.inf:  # a point alone has its neighbour at infinity
        raise ValueError("the points of a cloud must lie at different places")
    axes, middle = object_axes(points, np.ones(len(points)), points)
    cells = np.floor((points - middle) @ (axes.T / max(CELL * np.sqrt(area / count), SMALLEST)) + ROUNDING)
    samples = _gathered(cells.astype(np.int64), points, normals, np.ones(len(points)), axes)
    return denoised(replace(samples, areas=np.full(len(samples.points), area / len(samples.points))))


def _gathered(cells, places, normals, areas, axes):
    """The Samples of pieces (p,): the mean of what lies in a cell, for each side of an edge or a sheet on its own."""
    x, y, z = (cells - cells.min(axis=0)).T
    _, cell = np.unique((x << 40) + (y << 20) + z, return_inverse=True)
    total, normal = _means(cell, normals, areas)
    length = np.linalg.norm(normal, axis=1)
    bent = np.flatnonzero((length < BENT)[cell])
    rough = False
    if len(bent):
        bent_ids, owner = np.unique(cell[bent], return_inverse=True)
        tilt = normals[bent] - normal[cell[bent]]
        spread = _means(owner, np.einsum("ni,nj->nij", tilt, tilt).reshape(-1, 9), areas[bent])[1].reshape(-1, 3, 3)
        spread += axes.T @ np.diag(NUDGE * np.arange(3)) @ axes
        along = np.einsum("ij,ij->i", tilt, np.linalg.eigh(spread)[1][owner, :, 2])
        # the rim of a sheet lies between its two sides: half of each such piece goes to either side
        between = np.flatnonzero(np.abs(along) <= BETWEEN)
        halved = bent[between]
        areas = areas.copy()
        areas[halved] /= 2
        bent = np.concatenate([bent, len(cell) + np.arange(len(halved))])
        cell, places, normals, areas = (
            np.concatenate([values, values[halved]]) for values in (cell, places, normals, areas)
        )
        owner = np.concatenate([owner, owner[between]])
        is_second = np.concatenate([along > BETWEEN, np.ones(len(halved), dtype=bool)])
        slots = 2 * owner + is_second
        halves = np.linalg.norm(_means(slots, normals[bent], areas[bent], 2 * len(bent_ids))[1], axis=1).reshape(-1, 2)
        plain = halves.min(axis=1) > PLAIN
        rough = bool(total[bent_ids] @ ~plain > ROUGH_SHARE * total.sum())
        if not rough:
            side = np.zeros(len(cell), dtype=np.int64)
            side[bent] = is_second & (plain | (length[bent_ids] < TWO_SIDES))[owner]
            cell = 2 * cell + side
            cell = (np.cumsum(np.bincount(cell) > 0) - 1)[cell]
            total, normal = _means(cell, normals, areas)
    # the length of the summed area vectors is the area of the surface without its noise, whose own area may be four
    # times as large: the sum over a patch depends on the patch's border alone
    flat = total * np.maximum(length, LEAST_FLAT) if rough else total
    return Samples(_means(cell, places, areas)[1], unit(normal), flat, axes, rough)


def _means(owner, values, areas, count=0):
    """(sum of the areas, mean of the values (p, d) by area) of the pieces of each owner."""
    total = np.bincount(owner, areas, count)
    sums = np.stack([np.bincount(owner, column * areas, count) for column in values.T], axis=1)
    return total, sums / np.maximum(total, 1e-300)[:, None]


ROUGH = 0.1  # one minus the cosine of a normal and its neighbours' mean: the median of the roughest of 33 clean objects
AVERAGED = 2  # steps over the graph for the normals that the patches start from
PATCH = 32  # nearest points that a patch is fitted to
WIDTH = 2.5  # deviation of their weights, in units of the spacing
SAME_SIDE = 0.2  # cosine between two normals above which points lie on one sheet
FARTHEST = 2.0  # in units of the spacing: no point moves more
STEEPEST = 1.0  # slope of a patch against the normal that it starts from
RIDGE = 1e-6  # keeps a patch with too few points from being undetermined


def denoised(samples: Samples) -> Samples:
    """The Samples, each moved along its normal onto a paraboloid that is fitted to the points around it.

    Unlike an average this does not shrink what is curved (Cazals and Pouget, Estimating differential quantities using
    polynomial fitting of osculating jets, CAGD 22(2), 2005). Samples that are no rougher than those of a clean surface
    come back as they are.
    """
    normals = samples.average @ samples.normals
    if not samples.rough and np.median(1 - np.einsum("ij,ij->i", normals, samples.normals)) <= ROUGH:
        return samples
    for _ in range(AVERAGED - 1):
        normals = samples.average @ unit(normals)
    return _on_patches(samples, unit(normals))


def _on_patches(samples, normals):
    distance, neighbours = nearest(samples.tree, samples.points, PATCH)
    reference_axis = np.where(np.abs(normals[:, :1]) < 0.9, [1.0, 0.0, 0.0], [0.0, 1.0, 0.0])
    right = unit(np.cross(normals, reference_axis))
    frame = np.stack([right, np.cross(normals, right), normals], axis=1)
    x, y, z = np.einsum("nij,nkj->ink", frame, samples.points[neighbours] - samples.points[:, None]) / samples.spacing
    weight = np.exp(-((distance / (WIDTH * samples.spacing)) ** 2) / 2)
    weight *= np.einsum("nkj,nj->nk", normals[neighbours], normals) > SAME_SIDE
    weight *= np.sqrt(samples.areas[neighbours]) / samples.spacing
    terms = np.stack([np.ones_like(x), x, y, x * x, x * y, y * y], axis=2) * weight[:, :, None]
    inner = np.einsum("nki,nkj->nij", terms, terms) + RIDGE * np.eye(terms.shape[2])
    fit = np.linalg.solve(inner, np.einsum("nki,nk->ni", terms, z * weight)[:, :, None])[:, :, 0]
    steps = fit[:, :1].clip(-FARTHEST, FARTHEST) * samples.spacing
    slopes = np.einsum("ni,nij->nj", fit[:, 1:3].clip(-STEEPEST, STEEPEST), frame[:, :2])
    return replace(samples, points=samples.points + steps * normals, normals=unit(normals - slopes))

"""Charts of a texture, and the seams where a chart meets itself: at which side of them a corner of a face lies.

A chart is a patch of faces whose texture coordinates are continuous across the edges between them. A cylinder cut open
is one chart, whose two ends meet at a seam: a point near it has two pairs of coordinates, and its surroundings decide
which of them a face takes.
"""

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from scipy import sparse
from scipy.sparse.csgraph import connected_components
from scipy.spatial import KDTree

from haptic_glance.mesh.mesh import Mesh, edge_pairs

SAME = 1e-6  # texture coordinates this close are continuous across an edge; an image has some 1e3 pixels per side
STRETCH = 4.0  # how much longer than on the chart's average a way on the surface may be in its picture
CLOSER = 0.5  # a corner changes sides where that halves its distance to where the map of its face puts it
PLACES = np.array([0.0, 0.5, 1.0])  # along an edge, at which the sides of a seam are searched for


@dataclass(frozen=True)
class Seams:
    """The edges at which charts meet themselves, once for each of their two sides.

    chart (s,). ends (s, 2, 3) of the edges, and uv (s, 2, 2) there on this side. shift (s, 2): whole pictures from the
    other side to this one, 0 where the two differ by no whole number. at_end (m, 3) boolean: which corners of the
    mesh's faces lie where a chart ends, at a seam or the boundary. scale (charts,): length in texture coordinates of a
    unit of the surface, on average.
    """

    chart: np.ndarray
    ends: np.ndarray
    uv: np.ndarray
    shift: np.ndarray
    at_end: np.ndarray
    scale: np.ndarray


class Corners(NamedTuple):
    """Corners (k,) of faces: a number for each vertex within a chart, chart, points (k, 3) of the surface, and uv.

    uv (k, 2): the coordinates at the points. ahead (k, 2): where the map under the centre of their faces puts them.
    """

    number: np.ndarray
    chart: np.ndarray
    points: np.ndarray
    uv: np.ndarray
    ahead: np.ndarray


def charts(mesh: Mesh) -> tuple[np.ndarray, Seams]:
    """(chart (m,) of each face, the Seams of the charts)."""
    assert mesh.texture is not None
    first, second = edge_pairs(mesh.faces, len(mesh.vertices))
    vertex_ids, uv = _sorted_ends(mesh)
    image, count = mesh.texture.image, len(mesh.faces)
    apart = np.linalg.norm(uv[first] - uv[second], axis=2).max(axis=1) > SAME
    apart |= image[first // 3] != image[second // 3]
    joint = ~apart
    graph = sparse.coo_matrix((np.ones(joint.sum()), (first[joint] // 3, second[joint] // 3)), shape=(count, count))
    chart = connected_components(graph, directed=False)[1]
    own_seam = apart & (chart[first // 3] == chart[second // 3])
    sides, others = np.concatenate([[first, second], [second, first]], axis=1)[:, np.tile(own_seam, 2)]
    ending = np.ones(3 * count, dtype=bool)
    ending[first[joint]] = ending[second[joint]] = False
    at_end = np.zeros(len(mesh.vertices), dtype=bool)
    at_end[vertex_ids[ending]] = True
    steps = uv[sides] - uv[others]
    whole = np.rint(steps[:, 0])
    whole[np.abs(steps - whole[:, None]).max(axis=(1, 2)) > SAME] = 0
    ends = mesh.vertices[vertex_ids[sides]]
    return chart, Seams(chart[sides // 3], ends, uv[sides], whole, at_end[mesh.faces], _scales(mesh, chart))


def _sorted_ends(mesh):
    """(vertex ids (3 m, 2), uv (3 m, 2, 2)) of the two ends of each half-edge, the lower id first."""
    ends = np.stack([mesh.faces, np.roll(mesh.faces, -1, axis=1)], axis=2).reshape(-1, 2)
    uv = np.stack([mesh.texture.uv, np.roll(mesh.texture.uv, -1, axis=1)], axis=2).reshape(-1, 2, 2)
    is_reversed = ends[:, 0] > ends[:, 1]
    ends[is_reversed], uv[is_reversed] = ends[is_reversed, ::-1], uv[is_reversed, ::-1]
    return ends, uv


def _scales(mesh, chart):
    """(charts,) the root of the area of each chart's picture over that of its surface; 0 without area."""
    first, second = mesh.texture.uv[:, 1] - mesh.texture.uv[:, 0], mesh.texture.uv[:, 2] - mesh.texture.uv[:, 0]
    pictures = np.bincount(chart, np.abs(first[:, 0] * second[:, 1] - first[:, 1] * second[:, 0]) / 2)
    areas = np.bincount(chart, mesh.face_areas)
    return np.sqrt(np.divide(pictures, areas, out=np.zeros_like(areas), where=areas > 0))


def own_sides(seams: Seams, corners: Corners) -> tuple[np.ndarray, np.ndarray]:
    """(uv (k, 2), points (k, 3)) of corners on the side of the seams on which the centres of their faces lie.

    A corner beyond a seam takes the coordinates of the nearest edge of the seam on its own side, or goes on beyond
    where the picture repeats there. Those of one side and vertex stay within what the surface between them explains.
    """
    uv, points = corners.uv.copy(), corners.points.copy()
    off = np.linalg.norm(uv - corners.ahead, axis=1)
    search = _Search(seams)
    near = np.flatnonzero(search.within(corners, CLOSER * off))
    if not len(near):
        return uv, points
    corners = Corners(*(values[near] for values in corners))
    distance, edge, place = search.edges(corners)
    seam_uv = _between(seams.uv[edge], place)
    gap, away = seam_uv - corners.uv, _between(seams.ends[edge], place) - corners.points
    beyond = (distance < CLOSER * off[near]) & ~explained(seams, corners.chart, gap, away)
    shifted = corners.uv + seams.shift[edge]
    nearer = np.linalg.norm(shifted - seam_uv, axis=1) < np.linalg.norm(gap, axis=1)
    repeats = seams.shift[edge].any(axis=1) & nearer
    uv[near[beyond & repeats]] = shifted[beyond & repeats]
    clipped, edge = near[beyond & ~repeats], edge[beyond & ~repeats]
    place = _closest_places(seams.ends[edge], points[clipped])
    uv[clipped], points[clipped] = _between(seams.uv[edge], place), _between(seams.ends[edge], place)
    return uv, points


def explained(seams: Seams, chart: np.ndarray, gap: np.ndarray, away: np.ndarray) -> np.ndarray:
    """(k,) boolean: gaps (k, 2) in the picture no longer than ways (k, 3) on the surface of charts (k,) account for."""
    most = STRETCH * seams.scale[chart] * np.linalg.norm(away, axis=1) + SAME
    return np.linalg.norm(gap, axis=1) <= most


def _between(ends, places):
    """Rows between ends (k, 2, d), at shares (k,) of the way; the ends themselves unrounded."""
    return ends[:, 0] * (1 - places)[:, None] + ends[:, 1] * places[:, None]


def _closest_places(ends, points):
    """(k,) shares of the way between ends (k, 2, 3) that are closest to points (k, 3)."""
    along = ends[:, 1] - ends[:, 0]
    square = np.maximum((along**2).sum(axis=1), np.finfo(float).tiny)
    return (np.einsum("ij,ij->i", points - ends[:, 0], along) / square).clip(0, 1)


class _Search:
    """The places of seams nearest to corners, chart by chart; distances are lengths in the picture."""

    def __init__(self, seams):
        self.seams = seams
        count = len(seams.chart)
        ends, uv = (np.tile(values, (len(PLACES), 1, 1)) for values in (seams.ends, seams.uv))
        self.places = np.repeat(PLACES, count)
        self.charts = np.tile(seams.chart, len(PLACES))
        self.points, self.uv = _between(ends, self.places), _between(uv, self.places)

    def within(self, corners, radii):
        """(k,) boolean: corners with a place of their chart's seams within radii (k,) on the surface."""
        rows, queries = self._rows(corners.chart, corners.points)
        return KDTree(rows).query_ball_point(queries, radii, return_length=True) > 0

    def edges(self, corners):
        """(distance (k,), edge (k,), place (k,) on it): the nearest sides of seams, on the surface and in the picture.

        In the picture distances are from what lies ahead. Of two sides at one place, that of the face is nearer.
        """
        rows, queries = self._rows(corners.chart, corners.points, (self.uv, corners.ahead))
        distance, nearest = KDTree(rows).query(queries)
        return distance, np.asarray(nearest) % len(self.seams.chart), self.places[nearest]

    def _rows(self, chart, points, *uv):
        scale = self.seams.scale
        rows = np.column_stack([scale[self.charts][:, None] * self.points, *(pair[0] for pair in uv)])
        queries = np.column_stack([scale[chart][:, None] * points, *(pair[1] for pair in uv)])
        apart = 1 + np.ptp(np.concatenate([rows, queries]), axis=0).sum()  # more than any distance within a chart
        return np.column_stack([apart * self.charts, rows]), np.column_stack([apart * chart, queries])


def joined(seams: Seams, corners: Corners) -> np.ndarray:
    """(k, 2): uv of corners; corners of one number share it where the distance of their points explains the gap."""
    uv, pending = corners.uv.copy(), np.arange(len(corners.uv))
    while len(pending):
        _, first, inverse = np.unique(corners.number[pending], return_index=True, return_inverse=True)
        leader = pending[first][inverse.ravel()]
        gap, away = (values[pending] - values[leader] for values in (corners.uv, corners.points))
        near = explained(seams, corners.chart[pending], gap, away)
        uv[pending[near]] = corners.uv[leader[near]]
        pending = pending[~near]
    return uv

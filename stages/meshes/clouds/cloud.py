"""A point cloud as arrays, and what of it can be used."""

from dataclasses import dataclass

import numpy as np
from scipy.spatial import KDTree

from ..headers import MeshError

LEAST = 50  # points; fewer hold no shape
MOST = 300_000  # points that a surface is made of; of more, as many are drawn
NEIGHBOURS = 8
STRAY = 8.0  # times the median distance to the neighbours: farther points are outliers
FLAT = 1e-3  # of the largest extent: less than this across, all points lie on a plane or a line


@dataclass(frozen=True, eq=False)
class Cloud:
    """points (n, 3) f8; normals (n, 3) f8 of unit length, outwards, or None; colors (n, 3) u1 or None.

    sensor: (3,) f8 where all points were seen from, or None where that is not known.
    """

    points: np.ndarray
    normals: np.ndarray | None = None
    colors: np.ndarray | None = None
    sensor: np.ndarray | None = None

    def part(self, chosen: np.ndarray) -> "Cloud":
        """The Cloud of some points: their ids, or (n,) boolean."""
        normals, colors = (None if one is None else one[chosen] for one in (self.normals, self.colors))
        return Cloud(self.points[chosen], normals, colors, self.sensor)


def usable(cloud: Cloud) -> Cloud:
    """The points that a surface can be made of: finite, no two at one place, none far from all others.

    Cameras mark pixels without a reading by NaN or by zeros, and many points at one place are that. Of more than MOST
    points as many are drawn evenly from the file's order. Raises MeshError with the reason where no shape is left.
    """
    given = len(cloud.points)
    finite = [np.isfinite(one).all(axis=1) for one in (cloud.points, cloud.normals) if one is not None]
    cloud = cloud.part(np.logical_and.reduce(finite))
    _, first = np.unique(cloud.points, axis=0, return_index=True)
    cloud = cloud.part(np.sort(first))
    if len(cloud.points) > MOST:
        cloud = cloud.part(np.linspace(0, len(cloud.points) - 1, MOST).astype(int))
    if len(cloud.points) >= LEAST:
        away = KDTree(cloud.points).query(cloud.points, NEIGHBOURS + 1)[0][:, -1]
        cloud = cloud.part(away <= STRAY * np.median(away))
    if len(cloud.points) < LEAST:
        raise MeshError(f"a point cloud of {given} points, {len(cloud.points)} of them usable: a surface needs {LEAST}")
    extents = np.linalg.svd(cloud.points - cloud.points.mean(axis=0), compute_uv=False)
    if extents[2] < FLAT * extents[0]:
        shape = "line" if extents[1] < FLAT * extents[0] else "plane"
        raise MeshError(f"all points of the cloud lie on one {shape}: there is no shape to look at or to touch")
    return cloud

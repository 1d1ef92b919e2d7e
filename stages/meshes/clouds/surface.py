# pymeshlab comes without types:
# pyright: reportAttributeAccessIssue=false
"""The surface of a point cloud, with the holes that it leaves where nothing was seen."""

import numpy as np
from scipy.spatial import KDTree

from stages.kit import Mesh
from stages.kit.extras import from_extra

from .cloud import NEIGHBOURS, Cloud, usable
from .normals import normals_of

DEPTHS = 5, 9  # of the octree: 32 to 512 cells a side
SIDE = 1.1  # of the octree, in the largest extent of the points
GAP = 1.5  # times the distance to the neighbours that points have there: surface farther from them was never seen


def surface_of(cloud: Cloud) -> Mesh:
    """The Mesh of a Cloud, in its units; it is closed where points are all round, and open where none were seen.

    Screened Poisson reconstruction (Kazhdan and Hoppe, ACM Transactions on Graphics 32(3), 2013; pymeshlab's) of the
    usable points and their normals, in cells as wide as the points are apart. It closes every hole; what lies farther
    from the points than they lie from each other is cut away again. Colours are those of the nearest points. Raises
    MeshError for a cloud without a shape.
    """
    with from_extra("a point cloud is made a surface by pymeshlab, which "):
        import pymeshlab

    cloud = usable(cloud)
    centre, extent = cloud.points.mean(axis=0), np.ptp(cloud.points, axis=0).max()
    points = (cloud.points - centre) / extent  # far from the origin, digits would be lost
    sensor = None if cloud.sensor is None else (cloud.sensor - centre) / extent
    tree = KDTree(points)
    away = tree.query(points, NEIGHBOURS + 1)[0][:, -1]
    normals = normals_of(points, sensor) if cloud.normals is None else cloud.normals
    work = pymeshlab.MeshSet()
    work.add_mesh(pymeshlab.Mesh(vertex_matrix=points, v_normals_matrix=normals))
    work.generate_surface_reconstruction_screened_poisson(depth=_depth(away), preclean=True, threads=1)
    made = work.current_mesh()
    vertices, faces = made.vertex_matrix(), made.face_matrix().astype(np.int64)
    distance, nearest = tree.query(vertices)
    seen = np.asarray(distance <= GAP * away[nearest])
    faces = faces[seen[faces].all(axis=1)]
    used, ids = np.unique(faces, return_inverse=True)
    colors = None if cloud.colors is None else cloud.colors[np.asarray(nearest)[used]]
    return Mesh(vertices[used] * extent + centre, ids.reshape(-1, 3), colors)


def _depth(away):
    """The depth of the octree whose cells are as wide as points are apart; away: distance to the eighth neighbour."""
    apart = np.median(away) * np.sqrt(np.pi / NEIGHBOURS)  # on a surface, eight points share a disc of that radius
    return int(np.clip(np.ceil(np.log2(SIDE / apart)), *DEPTHS))

"""Projects pixels of a view to vertices by exact rays (T3.2.6)."""

import numpy as np

from stages.kit import Mesh, RayScene, Viewpoint, camera


def project_pixels(
    scene: RayScene, rows: np.ndarray, columns: np.ndarray, viewpoint: Viewpoint, size: tuple[int, int]
) -> tuple[np.ndarray, np.ndarray]:
    """Pixels of a view to vertices of the mesh: (vertices (k,) i8, positions (k, 3) f8 where the rays hit).

    rows, columns (k,), may be fractional; size: (h, w) of the image that they index. A map of a reduced size needs no
    correction, since camera.pixel_rays measures pixels of any image from its middle. Raises ValueError when a pixel
    lies off the object.
    """
    origins, directions = camera.pixel_rays(rows, columns, viewpoint, size)
    hits = scene.cast(origins, directions)
    if not hits.hit.all():
        miss = int(np.flatnonzero(~hits.hit)[0])
        raise ValueError(
            f"pixel (row {rows[miss]}, column {columns[miss]}) of view {viewpoint.name} is off the object: "
            "set a map to zero where no ray meets the mesh before you select points from it"
        )
    positions = origins + hits.distance[:, None] * directions
    return nearest_corners(scene.mesh, hits.face, positions), positions


def nearest_corners(mesh: Mesh, faces: np.ndarray, positions: np.ndarray) -> np.ndarray:
    """(k,) i8: the corner of each face (k,) nearest to a position (k, 3).

    T3.2.6 takes the vertex nearest to the centroid of the face, whichever point of the face was seen. The corner
    nearest to the point itself is never farther away, and on slivers, common in CAD meshes, it is much nearer.
    """
    corners = mesh.faces[faces]
    distance = ((mesh.vertices[corners] - positions[:, None]) ** 2).sum(axis=2)
    return corners[np.arange(len(corners)), distance.argmin(axis=1)]

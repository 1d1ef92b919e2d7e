"""From pixels to vertices by exact rays (T3.2.6)."""

import numpy as np

from stages.kit import camera


def project_pixels(scene, rows, columns, viewpoint, size):
    """Pixels of a view to vertices of the mesh: (vertices (k,) i8, positions (k, 3) f8 where the rays hit).

    scene: kit RayScene; rows, columns (k,) may be fractional; size: (h, w) of the image that they index. A map of a
    reduced size needs no correction: its pixel centres and the full image's agree in camera.pixel_rays, as both
    count from the middle of the image. Raises ValueError when a pixel lies off the object.
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


def nearest_corners(mesh, faces, positions):
    """(k,) i8: of each face's three corners the one nearest to the position (k, 3).

    T3.2.6 takes the vertex nearest to the face's centroid, whichever point of the face was seen. The corner nearest
    to the point itself is never farther from it, and on long thin triangles, common in CAD meshes, much nearer.
    """
    corners = mesh.faces[faces]
    distance = ((mesh.vertices[corners] - positions[:, None]) ** 2).sum(axis=2)
    return corners[np.arange(len(corners)), distance.argmin(axis=1)]

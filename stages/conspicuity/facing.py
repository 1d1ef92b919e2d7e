"""Which vertices a view sees, and how squarely."""

import numpy as np

from stages.kit import RayScene, camera

SAME_DEPTH = 1e-4  # units, a tenth of a pixel at 900 rows: nearer than this two depths are one surface


def facing(mesh, viewpoints, scene=None):
    """(v, n) f8 in 0..1: the cosine between each view's line of sight and each vertex's normal, 0 where it is hidden.

    mesh: normalised; viewpoints: v of kit.camera; scene: the RayScene of the mesh where there is one already. Either
    side of the surface counts, since open meshes show their inside. Whether something is in front is tested by one
    exact ray a vertex.
    """
    scene = RayScene(mesh) if scene is None else scene
    found = np.zeros((len(viewpoints), len(mesh.vertices)))
    for row, viewpoint in zip(found, viewpoints, strict=True):
        back = viewpoint.axes[2]
        depth = camera.DISTANCE - mesh.vertices @ back
        origins = mesh.vertices + depth[:, None] * back
        hits = scene.cast(origins, np.broadcast_to(-back, origins.shape))
        seen = hits.distance >= depth - SAME_DEPTH
        row[seen] = np.abs(mesh.vertex_normals[seen] @ back)
    return found

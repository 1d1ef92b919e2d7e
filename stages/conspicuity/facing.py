"""The vertices that a view sees, and the angle at which it sees them."""

from collections.abc import Sequence

import numpy as np

from stages.kit import Mesh, RayScene, Viewpoint, camera

SAME_DEPTH = 1e-4  # units, a tenth of a pixel at 900 rows: depths closer than this are one surface


def facing(mesh: Mesh, viewpoints: Sequence[Viewpoint], scene: RayScene | None = None) -> np.ndarray:
    """(v, n) f8 in 0..1: the cosine between the line of sight of each view and the normal of each vertex; 0 if hidden.

    mesh: normalised. scene: the RayScene of the mesh if there is one already. Both sides of the surface count, since
    open meshes show their inside. Occlusion is tested by one exact ray per vertex.
    """
    scene = RayScene(mesh) if scene is None else scene
    cosines = np.zeros((len(viewpoints), len(mesh.vertices)))
    for row, viewpoint in zip(cosines, viewpoints, strict=True):
        back = viewpoint.axes[2]
        depth = camera.DISTANCE - mesh.vertices @ back
        origins = mesh.vertices + depth[:, None] * back
        hits = scene.cast(origins, np.broadcast_to(-back, origins.shape))
        seen = hits.distance >= depth - SAME_DEPTH
        row[seen] = np.abs(mesh.vertex_normals[seen] @ back)
    return cosines

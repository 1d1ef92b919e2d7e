"""What of a mesh a page shows that is to stay small."""

import numpy as np
from scipy.spatial import KDTree

from stages.kit import Mesh
from stages.kit.packing import ordered

from .simplify import simplify

INDEX_LIMIT = 65535  # 16-bit vertex ids


def shown_mesh(mesh: Mesh, faces: int) -> tuple[Mesh, np.ndarray]:
    """(mesh, ids): the mesh, simplified where it has more faces; ids: the original vertex nearest to each of its."""
    large = len(mesh.faces) > faces or len(np.unique(mesh.faces)) > INDEX_LIMIT
    small = ordered(simplify(mesh, faces) if large else mesh)[0]
    return small, np.asarray(KDTree(mesh.vertices).query(small.vertices)[1])

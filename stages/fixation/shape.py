"""Measures of an object's shape: Gaussian curvature and eccentricity (T eq. 3.21 to 3.23).

The third measure, convexity (T eq. 3.20), is in haptic_glance.look.weights.convexity, which closes the holes of open
meshes.
"""

import numpy as np

from haptic_glance.look.channels.surface import MIN_AREA, smoother
from haptic_glance.mesh.mesh import Mesh

SMOOTHING_RADIUS = 0.01  # of the diagonal: smaller bumps are noise or tessellation, as for the mean curvature
FLAT = 1.0  # times 1 / diagonal^2: smaller curvatures count as zero; a ball in the object's bounding box has 12
TAIL = 0.1  # share of the largest and of the smallest distances; T3.3.2.1


def gaussian_curvature(mesh: Mesh) -> np.ndarray:
    """(n,) f8 Gaussian curvature at the vertices, in 1 / unit^2: 1 / r^2 on a sphere, 0 on a cylinder.

    The determinant of the shape operator (T eq. 3.21, 3.22), computed as the angle defect of each vertex over its area
    (Gauss-Bonnet; Meyer, Desbrun, Schroeder and Barr 2003, Discrete differential-geometry operators for triangulated
    2-manifolds, section 4). It is smoothed over SMOOTHING_RADIUS of the diagonal, since the angles of scanned surfaces
    are noisy. Vertices at one position are merged. At boundary edges, where it is not defined, it is 0 before
    smoothing. Zero everywhere on a mesh without area.
    """
    places, welded = np.unique(mesh.vertices, axis=0, return_inverse=True)
    welded = welded.ravel()
    surface = Mesh(places, welded[mesh.faces][mesh.face_areas > 0])
    if not len(surface.faces):
        return np.zeros(len(mesh.vertices))
    missing = 2 * np.pi - np.bincount(surface.faces.ravel(), _angles(surface).ravel(), len(places))
    edges, counts = surface.edge_counts
    missing[edges[counts != 2].ravel()] = 0
    missing[surface.vertex_areas <= 0] = 0
    smooth = smoother(surface, np.ones(len(places)), SMOOTHING_RADIUS * surface.diagonal)
    return smooth(missing / np.maximum(surface.vertex_areas, MIN_AREA))[welded]


def curvature_shares(mesh: Mesh) -> tuple[float, float, float]:
    """(positive, negative, zero): shares of the vertices on the surface by sign of their Gaussian curvature (T3.3.2.1).

    Curvatures within FLAT / diagonal^2 count as zero. These are shares of vertices, as in the thesis, and not of area:
    an object that is meshed finer where it is curved counts as more curved. Raises ValueError for a mesh without area.
    """
    on = np.unique(mesh.faces[mesh.face_areas > 0])
    if not len(on):
        raise ValueError("the mesh has no face with an area, so its curvature is not defined: give it faces")
    relative = gaussian_curvature(mesh)[on] * mesh.diagonal**2
    positive, negative = float((relative > FLAT).mean()), float((relative < -FLAT).mean())
    return positive, negative, max(1 - positive - negative, 0.0)


def eccentricity(mesh: Mesh) -> float:
    """The eccentricity of a shape, 0 for a ball, at most 1 (T eq. 3.23).

    a and b are the means of the largest and of the smallest tenth of the distances between the vertices and the centre
    of gravity. It is that of the surface, which open meshes have too. Raises ValueError for a mesh without area.
    """
    areas = mesh.face_areas
    if not areas.sum() > 0:
        raise ValueError("the mesh has no face with an area, so it has no centre of gravity: give it faces")
    centre = np.average(mesh.vertices[mesh.faces].mean(axis=1), axis=0, weights=areas)
    on = np.unique(mesh.faces[areas > 0])
    distances = np.sort(np.linalg.norm(mesh.vertices[on] - centre, axis=1))
    tail = max(round(TAIL * len(distances)), 1)
    a, b = distances[-tail:].mean(), distances[:tail].mean()
    return float(np.sqrt(max(1 - (b / a) ** 2, 0.0)))


def _angles(mesh):
    """(m, 3) the angle at each corner of each face, in radians."""
    corners = mesh.vertices[mesh.faces]
    a, b = np.roll(corners, -1, axis=1) - corners, np.roll(corners, -2, axis=1) - corners
    return np.arctan2(2 * mesh.face_areas[:, None], np.einsum("mki,mki->mk", a, b))

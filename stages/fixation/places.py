"""Places of attention on the surface: projection of maps to vertices, and distances between the most salient places.

T3.3.5 prints the projection. T figure 3.29 asks whether the most salient place is the same from all sides. Also here
are Gaussian curvature and eccentricity, measures of an object's shape (T eq. 3.21 to 3.23). The third measure,
convexity (T eq. 3.20), is in haptic_glance.look.weights.convexity, which closes the holes of open meshes.
"""

from collections.abc import Sequence
from itertools import combinations

import numpy as np
from scipy.ndimage import map_coordinates

from haptic_glance.base.rng import rng
from haptic_glance.look.camera import Viewpoint, project
from haptic_glance.look.channels.surface import MIN_AREA, smoother
from haptic_glance.mesh.mesh import Mesh

from .fusion import subtractive_clusters

ITSELF = "level_3"  # the task to name the object itself
PLACES = 2000  # random places of a view; their mean distance is then known to one per cent


def nearer(mesh: Mesh, viewpoints: Sequence[Viewpoint], seen: np.ndarray, values: np.ndarray) -> dict[str, float]:
    """How much nearer the maxima of a map in two views lie than other places, in units: the mean over pairs of views.

    seen (v, n) boolean and values (v, n): what each view sees, and the map at the vertices there. dict metric ->
    value: `nearer_than_chance` beside random places on the surface that the views see, `nearer_than_middle` beside
    what they show in the middle of the picture. Views that see nothing are left out; empty where one or none is left.
    """
    views = [view for view, mask in enumerate(seen) if mesh.vertex_areas[mask].any()]
    if len(views) < 2:
        return {}
    tops = _apart([_top(mesh, seen[view], values[view]) for view in views])
    return {
        f"nearer_than_{name}": _apart([control(mesh, seen[view], viewpoints[view]) for view in views]) - tops
        for name, control in (("chance", _anywhere), ("middle", _middle))
    }


def _top(mesh: Mesh, seen: np.ndarray, values: np.ndarray) -> np.ndarray:
    """(1, 3): the most salient place of a view, of those that it sees."""
    masked = np.where(seen, values.astype(float), -1)
    return mesh.vertices[masked == masked.max()].mean(axis=0)[None]  # half precision has ties


def _anywhere(mesh: Mesh, seen: np.ndarray, viewpoint: Viewpoint) -> np.ndarray:
    """(PLACES, 3): random places on the surface that a view sees."""
    shares = np.where(seen, mesh.vertex_areas, 0)
    return mesh.vertices[rng(0, viewpoint.name).choice(len(seen), PLACES, p=shares / shares.sum())]


def _middle(mesh: Mesh, seen: np.ndarray, viewpoint: Viewpoint) -> np.ndarray:
    """(1, 3): what a view shows in the middle of the picture."""
    distances = np.linalg.norm(mesh.vertices @ viewpoint.axes[:2].T, axis=1)
    return mesh.vertices[[np.where(seen, distances, np.inf).argmin()]]


def _apart(places: Sequence[np.ndarray]) -> float:
    """The mean distance between the places (k, 3) of two views, over the pairs of views."""
    return float(np.mean([np.linalg.norm(a - b, axis=1).mean() for a, b in combinations(places, 2)]))


PROJECTIONS = ("camera", "boxes")  # ours, and T3.3.5 as printed


def project_to_vertices(pictures: np.ndarray, mesh: Mesh, viewpoint: Viewpoint, seen: np.ndarray) -> np.ndarray:
    """(t, n) f8: maps (t, h, w) of one view at its visible vertices, seen (n,) boolean; zero at the others.

    The camera gives the position of each vertex in the image to a fraction of a pixel, and rays
    (haptic_glance.look.channels.cropped_view) decide which vertices are visible. Interpolates bilinearly between
    pixels.
    """
    pictures, seen = _checked(pictures, mesh, seen)
    projected = np.zeros((len(pictures), len(seen)))
    rows, columns, _ = project(mesh.vertices[seen], viewpoint, pictures.shape[1:])
    for values, picture in zip(projected, pictures, strict=True):
        values[seen] = map_coordinates(picture, [rows, columns], order=1, mode="nearest")
    return projected


def project_by_boxes(
    pictures: np.ndarray, mesh: Mesh, viewpoint: Viewpoint, seen: np.ndarray, render: np.ndarray
) -> np.ndarray:
    """(t, n) f8: as project_to_vertices, by bounding boxes as T3.3.5 prints it; render (h, w): the object on black.

    The box of the projected vertices, hidden ones too, is stretched to that of the object in the picture, and each
    vertex takes the pixel that it falls on. Raises ValueError for a picture without an object.
    """
    pictures, seen = _checked(pictures, mesh, seen)
    if render.shape != pictures.shape[1:] or not render.any():
        raise ValueError(f"render must show an object on {pictures.shape[1:]} pixels, got {render.shape}")
    places = (mesh.vertices @ viewpoint.axes[:2].T * [1, -1])[:, ::-1]  # down and to the right
    low, extent = places.min(axis=0), np.ptp(places, axis=0)
    lines = np.nonzero(render.any(axis=1))[0], np.nonzero(render.any(axis=0))[0]
    first, last = ([line[end] for line in lines] for end in (0, -1))
    shares = (places - low) / np.where(extent > 0, extent, 1)
    rows, columns = np.rint(first + shares * np.subtract(last, first)).astype(np.int64).T
    return pictures[:, rows, columns] * seen


def _checked(pictures: np.ndarray, mesh: Mesh, seen: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    pictures, seen = np.asarray(pictures, dtype=np.float64), np.asarray(seen, dtype=bool)
    if pictures.ndim != 3 or seen.shape != (len(mesh.vertices),):
        raise ValueError(f"pictures (t, h, w) and seen ({len(mesh.vertices)},), got {pictures.shape} and {seen.shape}")
    return pictures, seen


def mean_over_views(values: np.ndarray, seen: np.ndarray) -> np.ndarray:
    """(t, n): the mean of values (v, t, n) over the views that see each vertex, seen (v, n) boolean; 0 without any."""
    seen = np.asarray(seen, dtype=np.float64)
    views = seen.sum(axis=0)
    summed = np.einsum("vtn,vn->tn", values, seen)
    return np.divide(summed, views, out=np.zeros_like(summed), where=views > 0)


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
    vertex_ids = np.unique(mesh.faces[mesh.face_areas > 0])
    if not len(vertex_ids):
        raise ValueError("the mesh has no face with an area, so its curvature is not defined: give it faces")
    relative = gaussian_curvature(mesh)[vertex_ids] * mesh.diagonal**2
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
    vertex_ids = np.unique(mesh.faces[areas > 0])
    distances = np.sort(np.linalg.norm(mesh.vertices[vertex_ids] - centre, axis=1))
    tail = max(round(TAIL * len(distances)), 1)
    a, b = distances[-tail:].mean(), distances[:tail].mean()
    return float(np.sqrt(max(1 - (b / a) ** 2, 0.0)))


def _angles(mesh):
    """(m, 3) the angle at each corner of each face, in radians."""
    corners = mesh.vertices[mesh.faces]
    a, b = np.roll(corners, -1, axis=1) - corners, np.roll(corners, -2, axis=1) - corners
    return np.arctan2(2 * mesh.face_areas[:, None], np.einsum("mki,mki->mk", a, b))


TOP = 0.95  # of the maximum: the maximum itself is one vertex, while the thesis clusters regions of maximal saliency


def centres(vertices: np.ndarray, values: np.ndarray, seen: np.ndarray, top: float = TOP) -> np.ndarray:
    """(c, 3): the centres of the regions of maximal saliency among the seen vertices; (0, 3) for a constant map.

    top: the share of the maximum from which a vertex counts as maximal.
    """
    values, ids = np.asarray(values, dtype=np.float64)[seen], np.flatnonzero(seen)
    if not len(values) or values.max() <= max(values.min(), 0):
        return np.zeros((0, 3))
    highest = np.asarray(vertices)[ids[values >= top * values.max()]]
    return highest[subtractive_clusters(highest)]


def centre_distance(
    vertices: np.ndarray, truth: np.ndarray, values: np.ndarray, seen: np.ndarray, top: float = TOP
) -> tuple[float, float]:
    """(least, mean) distance in units between the fixation centres of the ground truth (n,) and those of values (n,).

    As in the pseudocode of T3.3.6, each centre of the ground truth, the densest first, is paired with the nearest
    centre of the saliency that is not yet paired. The thesis reports the least distance per view. The mean over the
    pairs is given too, since the least shrinks as the number of centres grows. NaN where either map is constant.
    top: as in centres; 1 is the maximum to the letter.
    """
    people, ours = centres(vertices, truth, seen, top), centres(vertices, values, seen, top)
    gaps = []
    for centre in people:
        if not len(ours):
            break
        distances = np.linalg.norm(ours - centre, axis=1)
        gaps.append(distances.min())
        ours = np.delete(ours, distances.argmin(), axis=0)
    return (float(min(gaps)), float(np.mean(gaps))) if gaps else (np.nan, np.nan)

"""T3.2.6 and T3.2.7, T3.1.1: from a pixel to the surface, the size of a neighbourhood, the light."""

import numpy as np

from haptic_glance.lod.neighbourhood import adaptive_rings
from haptic_glance.look.camera import DISTANCE, Viewpoint, pixel_rays, pixels_per_unit, project
from haptic_glance.look.channels.surface import nearest_corners
from haptic_glance.look.views import TWELVE, render
from haptic_glance.mesh.mesh import Mesh
from haptic_glance.mesh.rays import RayScene

SIZE = (900, 1200)


def printed_places(rows, columns, viewpoint):
    """eq. 3.12 to 3.16: pixels as angles beside the camera's own, and as Cartesian coordinates (k, 3)."""
    x = (columns - (SIZE[1] - 1) / 2) / pixels_per_unit(SIZE[0])
    y = ((SIZE[0] - 1) / 2 - rows) / pixels_per_unit(SIZE[0])
    theta, phi = np.arctan(x / DISTANCE), np.arctan(y / DISTANCE)
    away = np.sqrt(x**2 + y**2 + DISTANCE**2)
    elevation, azimuth = np.radians(viewpoint.elevation) + phi, np.radians(viewpoint.azimuth) + theta
    return away[:, None] * np.column_stack(
        [np.cos(elevation) * np.cos(azimuth), np.cos(elevation) * np.sin(azimuth), np.sin(elevation)]
    )


def missed(elevation):
    """Pixels by which the printed formulas miss at most, within the circle that holds every object."""
    rows, columns = np.meshgrid(*(np.linspace(-429, 429, 201),) * 2, indexing="ij")
    inside = np.hypot(rows, columns) <= 429
    rows, columns = rows[inside] + (SIZE[0] - 1) / 2, columns[inside] + (SIZE[1] - 1) / 2
    viewpoint = Viewpoint(0, elevation)
    shown = project(printed_places(rows, columns, viewpoint), viewpoint, SIZE)[:2]
    return float(np.hypot(shown[0] - rows, shown[1] - columns).max())


def test_angles(agreement):
    """eq. 3.13 to 3.16 at a pole; at 45 degrees they miss by less, at none by less than a pixel."""
    assert missed(0) < 2 < missed(45) < missed(90)
    agreement("pixels", missed(90))


def crossings(mesh, origin, direction):
    """(distance, face) of the first face that a ray meets: Moeller and Trumbore 1997, T [221], face by face."""
    corners = mesh.vertices[mesh.faces]
    first, second = corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]
    p = np.cross(direction, second)
    determinant = np.einsum("ij,ij->i", first, p)
    inverse = np.divide(1, determinant, out=np.zeros_like(determinant), where=np.abs(determinant) > 1e-14)
    t = origin - corners[:, 0]
    u = np.einsum("ij,ij->i", t, p) * inverse
    q = np.cross(t, first)
    v, distance = (q @ direction) * inverse, np.einsum("ij,ij->i", second, q) * inverse
    hit = (inverse != 0) & (u >= 0) & (v >= 0) & (u + v <= 1) & (distance > 0)
    nearest = np.where(hit, distance, np.inf).argmin()
    return (distance[nearest], nearest) if hit.any() else (np.inf, -1)


def test_rays(dromedary, agreement):
    """T3.2.6: a ray through the pixel, parallel to the view axis, to the first face: the distance in units."""
    scene, apart = RayScene(dromedary), []
    for viewpoint in TWELVE[::3]:
        rows, columns, _ = project(dromedary.vertices[::97], viewpoint, SIZE)
        origins, directions = pixel_rays(rows + 0.3, columns - 0.2, viewpoint, SIZE)
        hits = scene.cast(origins, directions)
        literal = np.array([crossings(dromedary, o, d)[0] for o, d in zip(origins, directions, strict=True)])
        assert (np.isfinite(literal) == hits.hit).all() and hits.hit.any()
        apart.append(np.abs(literal[hits.hit] - hits.distance[hits.hit]).max())
    agreement("difference", float(max(apart)))


def test_vertex_of_a_face(dromedary, agreement):
    """T3.2.6 takes the vertex nearest to the centroid of the face; the share of pixels that get another one."""
    viewpoint, scene = TWELVE[4], RayScene(dromedary)
    rows, columns = (part.ravel() for part in np.mgrid[:900:6, :1200:6])
    origins, directions = pixel_rays(rows, columns, viewpoint, SIZE)
    hits = scene.cast(origins, directions)
    positions = origins[hits.hit] + hits.distance[hits.hit, None] * directions[hits.hit]
    vertices = nearest_corners(dromedary, hits.face[hits.hit], positions)
    corners = dromedary.faces[hits.face[hits.hit]]
    centroids = dromedary.vertices[corners].mean(axis=1, keepdims=True)
    nearest = np.linalg.norm(dromedary.vertices[corners] - centroids, axis=2).argmin(axis=1)
    literal = corners[np.arange(len(corners)), nearest]
    agreement("share", float(100 * (literal != vertices).mean()))


def test_density(dromedary, agreement):
    """eq. 3.17: NPN of each salient vertex by its average distance to its immediate neighbours."""
    points = np.random.default_rng(1).choice(len(dromedary.vertices), 40, replace=False)
    averages = []
    for point in points:
        faces = dromedary.faces[(dromedary.faces == point).any(axis=1)]
        near = np.setdiff1d(faces, [point])
        averages.append(np.linalg.norm(dromedary.vertices[near] - dromedary.vertices[point], axis=1).mean())
    longest = max(averages)
    literal = [1 if d <= longest / 3 else 2 if d <= 2 * longest / 3 else 3 for d in averages]
    assert len(set(literal)) > 1
    agreement("settings", (int((literal == adaptive_rings(dromedary, points)).sum()), len(points)))


def test_headlight(ball, agreement):
    """T3.1.1: grey and smooth, lit from the camera at infinity, on black: the cosine, in grey levels of 204."""
    mesh = Mesh(ball.vertices, ball.faces)
    view = render(mesh, Viewpoint(30, 20), (225, 300), renderer="raster")
    y, x = np.mgrid[:225, :300]
    square = ((y - 112) ** 2 + (x - 149.5) ** 2) / (0.5 * pixels_per_unit(225)) ** 2
    literal = np.where(square < 1, np.sqrt(np.maximum(1 - square, 0)), 0)
    assert (view.rgb[~view.mask] == 0).all() and (view.rgb == view.rgb[..., :1]).all()
    agreement("r", float(np.corrcoef(view.rgb[view.mask][:, 0], literal[view.mask])[0, 1]))


def test_viewpoints(agreement):
    """Figure 3.2: rotations (a) to (l) of the object about z and x; how many viewpoints stand where it prints them."""
    printed = [(0, 0), (90, 0), (180, 0), (270, 0), (0, 45), (120, 45), (240, 45), (0, -45), (120, -45), (240, -45)]
    printed = [(*place, 0) for place in printed] + [(90, 0, 0), (180, 0, 180)]  # (k) is (b); (l) is (c) upside down
    held = [place == (view.azimuth, view.elevation, view.roll) for place, view in zip(printed, TWELVE, strict=True)]
    agreement("settings", (sum(held), len(held)))

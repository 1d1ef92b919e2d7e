"""Named sets of viewpoints, and parallel rays along a viewpoint's axis for tests of visibility without an image."""

import numpy as np

from haptic_glance.mesh.mesh import Mesh, bounding_box

from ..camera import Viewpoint

# T figure 3.2. Its caption says of (k) `90 degrees around z`, which is (b) again, and of (l) `180 degrees around x`,
# which is (c) upside down. The text (T3.1.2) has cameras at +-y and +-z in (a), (b), (k) and (l), but turns about z
# reach no place at z. No reading fits both. Turns of (k) and (l) about x by 90 and -90 degrees give the two places at z
# that the text asks for: top and bottom. The other ten are as printed.
TWELVE = tuple(
    Viewpoint(azimuth, elevation)
    for elevation, azimuths in (
        (0, (0, 90, 180, 270)),
        (45, (0, 120, 240)),
        (-45, (0, 120, 240)),
        (90, (0,)),
        (-90, (0,)),
    )
    for azimuth in azimuths
)
FOUR = TWELVE[:4]  # around the upright object
PRINCIPAL = (*TWELVE[1:4:2], *TWELVE[10:])  # the four principal views of T3.1.2, at +-y and +-z

VIEWPOINTS = {"twelve": TWELVE, "four": FOUR, "principal": PRINCIPAL}


def viewpoint_set(name: str) -> tuple[Viewpoint, ...]:
    """The viewpoints of a named set; ValueError for an unknown name."""
    if name not in VIEWPOINTS:
        raise ValueError(f"viewpoints={name!r} is not a set of viewpoints: choose one of {', '.join(VIEWPOINTS)}")
    return VIEWPOINTS[name]


OUTSIDE = 0.6  # distance of a plane from the centre of a mesh of diagonal one, which never touches the mesh


def scaled_to_unit_diagonal(mesh: Mesh) -> Mesh:
    """The mesh with its bounding box centred at the origin and a diagonal of one, so that lengths are shares of it.

    Vertices in no face do not count. Raises ValueError for a mesh without area.
    """
    if len(mesh.faces) and mesh.diagonal > 0:
        low, high = bounding_box(mesh)
        surface = Mesh((mesh.vertices - (low + high) / 2) / mesh.diagonal, mesh.faces)
        if surface.face_areas.sum() > 0:
            return surface
    raise ValueError("the mesh has no visible surface: it needs at least one face with an area")


def sightlines(points: np.ndarray, viewpoint: Viewpoint) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Rays from outside through points (k, 3) of a unit-diagonal mesh: origins, directions (k, 3), distances (k,)."""
    back = viewpoint.axes[2]
    distances = OUTSIDE - points @ back
    return points + distances[:, None] * back, np.broadcast_to(-back, points.shape), distances

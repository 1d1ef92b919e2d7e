"""The fast backend: compiled quadric edge collapse, then a fit of what is left to the surface it stands for."""

import numpy as np

from stages.kit import Mesh

from .feasibility import InfeasibleTarget, SimplifyError
from .kernels import Surface, compact, decimate, fans, partners, refit, unit_box, vertex_quadrics
from .topology import NONE, faults

# (least cosine by which a collapse may turn a face, least quality of a face after it), tried in this order until the
# faces are few enough and have no fault that the mesh had not.
ATTEMPTS = ((0.7, 0.1), (0.8, 0.02), (0.5, 0.02), (0.5, 0.3))
LAST = (0.2, 0.01)  # the two limits for what is left to collapse after those
FOLD = -0.9  # least cosine between the normals of two neighbours after a collapse
# Where sheets lie on each other (the lid in a teapot's rim) that limit stops most collapses, and what is left to
# collapse is ruined: such meshes are first tried without it.
NO_FOLD = -2.0
FIT_BELOW = 0.35  # share of the faces left: above it the fit gains little, 4 % of the error at a half for half the time
SAMPLES = 6  # points to fit to, for each vertex that is left


def collapse(mesh, faces, frozen, weights=None):
    """A sound Mesh of at most `faces` faces, without colours.

    frozen (m,) boolean: faces that come through bit for bit, as does the open boundary. weights (n,) f8: what each
    vertex's quadric is multiplied by, and its weight in the fit; None for 1.
    Raises InfeasibleTarget when no collapse is left above the target, SimplifyError when every attempt is faulty.
    """
    before, said, least = None, "", len(mesh.faces)
    waiting = [(*limits, FOLD) for limits in ATTEMPTS]
    while waiting:
        found, left = _attempt(mesh, faces, frozen, weights, *waiting.pop(0))
        after = faults(found)
        if left <= faces and after == NONE:
            return found
        if before is None:  # now it pays to know
            before = faults(mesh)
            if before.folded:
                waiting = [(*limits, NO_FOLD) for limits in ATTEMPTS] + [(*ATTEMPTS[0], FOLD), *waiting]
                continue
        added = after.added(before)
        if left <= faces and not added:
            return found
        said = said or added
        least = least if added else min(least, left)  # a count is promised only where it was had soundly
    if least < len(mesh.faces) or not said:
        raise InfeasibleTarget(faces, least, int(frozen.sum()))
    raise SimplifyError(f"{faces} faces leave {said}: ask for more faces")


def _attempt(mesh, faces, frozen, weights, turn, shape, fold):
    surface, source, (middle, size) = _surface(mesh, frozen, weights)
    points, corner = surface.position.copy(), surface.corner.copy()
    weight = surface.quadric[:, 0] + surface.quadric[:, 3] + surface.quadric[:, 5]  # the area around, times the weight
    left = decimate(surface, faces, turn, shape, fold)
    if left > faces:
        left = decimate(surface, faces, *LAST, fold)
    if left < FIT_BELOW * len(mesh.faces):
        refit(surface, points, corner, weight, SAMPLES * left // 2, fold)
    kept, used = compact(surface, source, len(mesh.vertices))
    vertices = surface.position[used] * size + middle
    locked = surface.locked[used]
    vertices[locked] = mesh.vertices[source[used[locked]]]
    return Mesh(vertices, kept), left


def _surface(mesh, frozen, weights):
    """(Surface in a unit box, (n',) the vertex of the mesh that each of its vertices was, (middle, size) of the box).

    A vertex where fans of faces touch becomes one a fan. Rims and corners of frozen faces are locked.
    """
    ids = mesh.faces.ravel().astype(np.int32)
    twin = partners(ids, len(mesh.vertices), True)[0]
    corner, start, source, rim = fans(ids, twin)
    locked = rim.copy()
    locked[corner.reshape(-1, 3)[frozen]] = True
    position, middle, size = unit_box(mesh.vertices, source)
    quadric = vertex_quadrics(position, corner, np.ones(len(source)) if weights is None else weights[source])
    surface = Surface(corner, twin, start, rim, locked, position, quadric, np.arange(len(source), dtype=np.int32))
    return surface, source, (middle, size)

"""The fast backend: compiled quadric edge collapse, then a fit of the remaining vertices to the original surface."""

from functools import lru_cache

import numpy as np

from haptic_glance.mesh.mesh import Mesh

from .attribute_quadrics import Attributes, at_jumps, attribute_quadrics, merged_colors
from .borders import closed, held, hidden, without_hidden
from .feasibility import InfeasibleTarget, SimplifyError
from .kernels.collapse import decimate
from .kernels.mesh import HalfEdgeMesh, compact, fans, opposites
from .kernels.quadrics import vertex_quadrics
from .kernels.refit import refit
from .topology import NONE, faults

# (least cosine by which a collapse may turn a face, least quality of a face after it), tried in this order until the
# faces are few enough and have no new fault.
ATTEMPTS = ((0.7, 0.1), (0.8, 0.02), (0.5, 0.02), (0.5, 0.3))
LAST = (0.2, 0.01)  # the two limits for the collapses that remain after those
FOLD = -0.9  # least cosine between the normals of two neighbours after a collapse
# Where sheets lie on each other (the lid in a teapot's rim) that limit stops most collapses, and the few that remain
# ruin the surface: such meshes are first tried without it.
NO_FOLD = -2.0
FIT_BELOW = 0.35  # share of the faces left: above it the fit gains little (4 % of the error at 0.5, for half the time)
SAMPLES = 6  # target points of the fit per remaining vertex


def collapse(
    mesh: Mesh, faces: int, frozen: np.ndarray, weights: np.ndarray | None = None, attributes: Attributes = (),
    free: np.ndarray | None = None, fit_below: float = FIT_BELOW,
) -> Mesh:  # fmt: skip
    """A sound Mesh of at most `faces` faces, without colours but where the error counts them.

    frozen (m,) boolean: faces that are preserved bit for bit, as is the boundary. weights (n,) f8: factor of each
    vertex's quadric, and its weight in the fit; None for 1. attributes: (name, weight) of those that the error counts.
    free (n,) boolean: vertices of the boundary that may move; None for none. fit_below: the share of the faces left
    below which the vertices are fitted; 0 is Garland and Heckbert's QSlim.

    Raises InfeasibleTarget when no collapse is left above the target, SimplifyError when every attempt is faulty.
    """
    before, reason, least = None, "", len(mesh.faces)
    waiting = [(*limits, FOLD) for limits in ATTEMPTS]
    while waiting:
        candidate, count = _attempt(mesh, faces, frozen, weights, attributes, free, fit_below, *waiting.pop(0))
        after = faults(candidate)
        if count <= faces and after == NONE:
            return candidate
        if before is None:  # computed only where it is needed
            before = faults(mesh)
            if before.folded:
                waiting = [(*limits, NO_FOLD) for limits in ATTEMPTS] + [(*ATTEMPTS[0], FOLD), *waiting]
                continue
        added = after.added(before)
        if count <= faces and not added:
            return candidate
        reason = reason or added
        least = least if added else min(least, count)  # only counts of sound meshes are offered
    if least < len(mesh.faces) or not reason:
        raise InfeasibleTarget(faces, least, int(frozen.sum()))
    raise SimplifyError(f"{faces} faces leave {reason}: ask for more faces")


def _attempt(mesh, faces, frozen, weights, attributes, free, fit_below, turn, shape, fold):
    surface, source, (middle, size) = half_edge_mesh(mesh, frozen, weights)
    points, corner = surface.position.copy(), surface.corner.copy()
    # area around each vertex, times its weight
    weight = surface.quadric[:, 0] + surface.quadric[:, 3] + surface.quadric[:, 5]
    wedges = _count_attributes(mesh, attributes, weights, surface, source) if attributes else None
    if free is not None:
        free = free.copy()
        free[mesh.faces[frozen]] = False
        surface = closed(surface, free[source], np.ones(len(source)) if weights is None else weights[source])
    count = _collapsed(surface, wedges, faces, turn, shape, fold)
    if count > faces:
        count = _collapsed(surface, wedges, faces, *LAST, fold)
    if count < fit_below * len(mesh.faces):
        fitted = (
            held(surface) if wedges is None else surface._replace(locked=surface.locked | at_jumps(surface, wedges))
        )
        refit(fitted, points, corner, weight, SAMPLES * count // 2, fold)
    triangles, vertex_ids = compact(without_hidden(surface), surface.locked, source, len(mesh.vertices))
    vertices = surface.position[vertex_ids] * size + middle
    locked = surface.locked[vertex_ids]
    vertices[locked] = mesh.vertices[source[vertex_ids[locked]]]
    colors = None
    if wedges is not None and "colors" in dict(attributes):
        colors = merged_colors(surface, wedges, dict(attributes)["colors"])[vertex_ids]
        colors[locked] = mesh.colors[source[vertex_ids[locked]]]
    return Mesh(vertices, triangles.reshape(-1, 3), colors), count


def _collapsed(surface, wedges, faces, *limits):
    """`decimate` until `faces` are left beside the hidden ones, which grow fewer, too; returns how many that are."""
    count = decimate(surface, wedges, faces + hidden(surface).sum(), *limits)
    while (behind := hidden(surface).sum()) and count > faces + behind:
        before, count = count, decimate(surface, wedges, faces + behind, *limits)
        if count == before:
            break
    return count - behind


def _count_attributes(mesh, attributes, weights, surface, source):
    """The Wedges of a surface, to whose quadrics the attributes are added."""
    factor = np.ones(len(source)) if weights is None else weights[source]
    added, wedges = attribute_quadrics(mesh, attributes, surface.position, surface.corner, surface.opposite, factor)
    np.add(surface.quadric, added, out=surface.quadric)
    return wedges


def half_edge_mesh(
    mesh: Mesh, frozen: np.ndarray, weights: np.ndarray | None
) -> tuple[HalfEdgeMesh, np.ndarray, tuple[np.ndarray, float]]:
    """(HalfEdgeMesh in a unit box, (n',) the vertex of the mesh of each of its vertices, (middle, size) of the box).

    A vertex at which fans of faces touch is split. Boundary vertices and corners of frozen faces are locked.
    """
    opposite, corner, start, source, boundary, position, box, plain = _beginning(mesh)
    locked = boundary.copy()
    locked[corner.reshape(-1, 3)[frozen]] = True
    quadric = plain.copy() if weights is None else vertex_quadrics(position, corner, weights[source])
    parent = np.arange(len(source), dtype=np.int32)
    changing = corner.copy(), opposite.copy(), start.copy(), boundary.copy(), locked, position.copy(), quadric, parent
    return HalfEdgeMesh(*changing), source, box


@lru_cache(maxsize=2)  # every attempt, target and kept set begins with it
def _beginning(mesh):
    """The start of a mesh: opposite, corner, start, source, boundary, position, (middle, size) of its box, quadrics."""
    ids = mesh.faces.ravel().astype(np.int32)
    opposite = opposites(ids, len(mesh.vertices), True)[0]
    corner, start, source, boundary = fans(ids, opposite)
    columns = np.take(mesh.vertices.T, source, axis=1)  # on which numpy takes a fifth of the time of that on rows
    low, high = columns.min(axis=1), columns.max(axis=1)
    middle, size = (low + high) / 2, float((high - low).max()) or 1.0
    position = np.ascontiguousarray(((columns - middle[:, None]) / size).T)
    quadric = vertex_quadrics(position, corner, np.ones(len(source)))
    return opposite, corner, start, source, boundary, position, (middle, size), quadric

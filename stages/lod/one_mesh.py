"""A person's own mesh made ready to be simplified, and brought back to where it was."""

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from stages.kit import Mesh
from stages.meshes import clean, normalise, turn_up
from stages.meshes.normalise import RADIUS, frame
from stages.meshes.painted import merged

from .attributes import carry
from .borders import close_borders, cut_borders
from .export import painted
from .feasibility import InfeasibleTarget, smallest_feasible
from .simplify import simplify
from .topology import half_edges


@dataclass(frozen=True)
class OneMesh:
    """A mesh and what is to be kept of it.

    given: the Mesh in its own units, every vertex in a face counting. up: its axis that points up. saliency (n,) f8 in
    0..1. points (k,) vertex ids to keep, most salient first, rings (k,) around each. weights: (n,) for the soft variant
    or None. shrink: let the neighbourhoods shrink where the target needs it.
    """

    given: Mesh
    up: str
    saliency: np.ndarray
    points: np.ndarray
    rings: np.ndarray
    weights: np.ndarray | None
    backend: str
    shrink: bool

    @cached_property
    def mesh(self):
        """The mesh centred and scaled, its axes as given."""
        return normalise(self.given)

    @cached_property
    def cut(self):
        """(Mesh, ids): the same with the borders between materials open."""
        return cut_borders(self.mesh)

    @cached_property
    def smallest(self):
        """The least number of faces that can be had with the points kept."""
        return smallest_feasible(self.mesh, self.points, self.rings)

    @cached_property
    def smallest_with_borders(self):
        """The same with the borders between materials held too."""
        cut, ids = self.cut
        return smallest_feasible(cut, *self._on_cut(ids))

    @cached_property
    def border(self):
        """(e, 2) vertex ids of the edges that stay: open ones, those of three or more faces, between two materials."""
        cut, ids = self.cut
        return _rims(ids[cut.faces], half_edges(cut.faces)[1])

    @cached_property
    def open_border(self):
        """(e, 2) the same without those between two materials, which are given up where the faces are too few."""
        return _rims(self.mesh.faces, half_edges(self.mesh.faces)[1])

    def held(self, mesh):
        """How many edges of `border` are edges of a simplified mesh, bit for bit."""
        n = len(self.mesh.vertices)
        place = np.unique(np.concatenate([self.mesh.vertices, mesh.vertices]), axis=0, return_inverse=True)[1].ravel()
        ends = np.stack([mesh.faces.ravel(), np.roll(mesh.faces, -1, axis=1).ravel()], axis=1)
        there, wanted = (np.sort(rows, axis=1) @ [len(place), 1] for rows in (place[n + ends], place[self.border]))
        return int(np.isin(wanted, there).sum())

    @property
    def least(self):
        """The least number of faces that may be asked for: fewer than `smallest` where neighbourhoods may shrink."""
        return smallest_feasible(self.mesh) if self.shrink else self.smallest

    def simplified(self, faces):
        """The Mesh of at most `faces` faces, in the frame of `mesh`, with its attributes.

        Borders between materials are held while that is feasible. Raises as `simplify` does.
        """
        try:
            return self._reduced(*self.cut, faces)
        except InfeasibleTarget:
            if len(self.cut[0].vertices) == len(self.mesh.vertices):
                raise
        return self._reduced(self.mesh, np.arange(len(self.mesh.vertices)), faces)

    def plain(self, faces):
        """As `simplified`, by plain quadric edge collapse: the Mesh alone."""
        nothing = np.zeros(0, dtype=np.int64)
        other = OneMesh(self.given, self.up, self.saliency, nothing, nothing, None, self.backend, False)
        return other.simplified(faces)

    def survivors(self, mesh):
        """(k,) boolean: the points that are vertices of a simplified mesh, bit for bit."""
        there = set(map(bytes, mesh.vertices))
        return np.array([bytes(self.mesh.vertices[point]) in there for point in self.points], dtype=bool)

    def seen(self, mesh):
        """A mesh in the frame of `mesh` as it is looked at: upright, its picture on its vertices."""
        return painted(turn_up(mesh, self.up))

    def restored(self, mesh):
        """A mesh in the frame of `mesh` in the units of the given one; vertices that stayed have their very numbers."""
        centre, radius = frame(self.given)
        vertices = mesh.vertices * (radius / RADIUS) + centre
        n = len(self.mesh.vertices)
        _, place = np.unique(np.concatenate([self.mesh.vertices, mesh.vertices]), axis=0, return_inverse=True)
        place = place.ravel()
        owner = np.full(place.max() + 1, -1)
        owner[place[:n]] = np.arange(n)
        own = owner[place[n:]]
        vertices[own >= 0] = self.given.vertices[own[own >= 0]]
        return Mesh(vertices, mesh.faces, mesh.colors, mesh.texture)

    def _reduced(self, mesh, ids, faces):
        keep, rings = self._on_cut(ids)
        weights = None if self.weights is None else self.weights[ids]
        bare = Mesh(mesh.vertices, mesh.faces)  # colours and pictures are handed on at the end, once
        found = simplify(bare, faces, keep, rings, self.backend, self.shrink, weights=weights)
        return self.mesh if found is bare else carry(self.mesh, close_borders(found, mesh, ids))

    def _on_cut(self, ids):
        """(kept ids, rings): the points on a mesh whose vertices are those of numbers `ids`, all copies of each."""
        order = np.argsort(ids, kind="stable")
        first, last = (np.searchsorted(ids[order], self.points, side) for side in ("left", "right"))
        copies = np.repeat(np.arange(len(self.points)), last - first)
        offset = np.arange(len(copies)) - np.repeat(np.cumsum(last - first) - (last - first), last - first)
        return order[first[copies] + offset], self.rings[copies]


def _rims(faces, partner):
    alone = partner < 0
    ends = np.stack([faces.ravel()[alone], np.roll(faces, -1, axis=1).ravel()[alone]], axis=1)
    return np.unique(np.sort(ends, axis=1), axis=0)


def repaired(mesh):
    """(Mesh, notes): what `stages.meshes.clean` makes of a mesh, where that closes open edges with its vertices joined.

    Files that store corners (a soup of triangles, a patch for each texture) have a border around each of them, and
    borders stay as they are: so vertices at the very same place become one. Raises MeshError as `clean` does.
    """
    found, notes = clean(mesh)
    if (half_edges(found.faces)[1] >= 0).all():
        return found, notes
    first, ids = merged(mesh.vertices)
    colors = None if mesh.colors is None else mesh.colors[first]
    joined, others = clean(Mesh(mesh.vertices[first], ids[mesh.faces], colors, mesh.texture))
    if (half_edges(joined.faces)[1] < 0).sum() >= (half_edges(found.faces)[1] < 0).sum():
        return found, notes
    return joined, [f"{len(ids) - len(first):,} vertices at the place of another joined to it", *others]

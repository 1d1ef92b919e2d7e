"""One simplification as a person asks for it: the mesh of a file prepared, and the result in the file's coordinates.

A name in lod.methods says which points are kept and how. Where a face count is too low for the kept vertices, the
message names the remedies.
"""

from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from functools import cached_property

import numpy as np

from haptic_glance.look.points.methods import METHODS, is_method, meant
from haptic_glance.mesh import clean, normalise, rotate_to_z_up
from haptic_glance.mesh.materials import bake_texture, flat_texture, merge_equal_rows
from haptic_glance.mesh.mesh import Mesh
from haptic_glance.mesh.nearest import same_place
from haptic_glance.mesh.repair import RADIUS, centre_and_radius

from .attributes import carry
from .borders import close_borders, cut_borders
from .feasibility import InfeasibleTarget, smallest_feasible
from .neighbourhood import NEIGHBOURHOODS
from .simplify import simplify
from .topology import half_edges, topology


@dataclass(frozen=True)
class SimplificationTask:
    """A mesh and what simplification must preserve of it.

    source: the Mesh in its own units and axes. saliency (n,) f8 in 0..1. points (k,) vertex ids to
    keep, most salient first, rings (k,) around each. weights: (n,) for the soft variant or None. shrink: whether the
    neighbourhoods may shrink where the target needs it. attributes: their weights in the error; free_borders: whether
    the boundary is simplified, too, but where it meets a border between materials: see `simplify`.
    """

    source: Mesh
    saliency: np.ndarray
    points: np.ndarray
    rings: np.ndarray
    weights: np.ndarray | None
    backend: str
    shrink: bool
    attributes: Mapping[str, float] = field(default_factory=dict)
    free_borders: bool = False

    @cached_property
    def mesh(self) -> Mesh:
        """The mesh centred and scaled, its axes unchanged."""
        return normalise(self.source)

    @cached_property
    def cut(self) -> tuple[Mesh, np.ndarray]:
        """(Mesh, ids): `mesh` cut open at the borders between materials, see `cut_borders`."""
        return cut_borders(self.mesh)

    @cached_property
    def smallest(self) -> int:
        """The smallest feasible face count with the points kept."""
        return smallest_feasible(self.mesh, self.points, self.rings, self.free_borders)

    @cached_property
    def smallest_with_borders(self) -> int:
        """The same with the borders between materials preserved too."""
        cut, ids = self.cut
        return smallest_feasible(cut, *self._on_cut(ids), self.free_borders)

    @cached_property
    def border(self) -> np.ndarray:
        """(e, 2) vertex ids of the edges to preserve: boundary, non-manifold, and those between two materials."""
        cut, ids = self.cut
        return _unpaired_edges(ids[cut.faces], half_edges(cut.faces)[1])

    @cached_property
    def boundary(self) -> np.ndarray:
        """(e, 2) the same without those between two materials, which are given up where the faces are too few."""
        return _unpaired_edges(self.mesh.faces, half_edges(self.mesh.faces)[1])

    def border_edges_kept(self, mesh: Mesh) -> int:
        """How many edges of `border` are edges of a simplified mesh, bit for bit."""
        n = len(self.mesh.vertices)
        place = np.unique(np.concatenate([self.mesh.vertices, mesh.vertices]), axis=0, return_inverse=True)[1].ravel()
        ends = np.stack([mesh.faces.ravel(), np.roll(mesh.faces, -1, axis=1).ravel()], axis=1)
        present, required = (np.sort(rows, axis=1) @ [len(place), 1] for rows in (place[n + ends], place[self.border]))
        return int(np.isin(required, present).sum())

    @property
    def lowest_target(self) -> int:
        """The lowest face count to ask for: less than `smallest` where neighbourhoods may shrink."""
        return smallest_feasible(self.mesh, free_borders=self.free_borders) if self.shrink else self.smallest

    def simplified(self, faces: int) -> Mesh:
        """The Mesh of at most `faces` faces, in the frame of `mesh`, with its attributes.

        Borders between materials are preserved where that is feasible. With free borders and no points, also tries
        counts below the smallest feasible one, where the surface may lose its shape. Raises as `simplify` does.
        """
        try:
            return self._simplify(*self.cut, faces)
        except InfeasibleTarget:
            may_below = self.free_borders and len(self.points) == 0
            if len(self.cut[0].vertices) == len(self.mesh.vertices) and not may_below:
                raise
        return self._simplify(self.mesh, np.arange(len(self.mesh.vertices)), faces, may_below)

    def plain(self, faces: int) -> Mesh:
        """As `simplified`, by plain quadric edge collapse: no points, no weights."""
        no_points = np.zeros(0, dtype=np.int64)
        task = replace(self, points=no_points, rings=no_points, weights=None, shrink=False, attributes={})
        return task.simplified(faces)

    def points_kept(self, mesh: Mesh) -> np.ndarray:
        """(k,) boolean: the points that are vertices of a simplified mesh, bit for bit."""
        positions = set(map(bytes, mesh.vertices))
        return np.array([bytes(self.mesh.vertices[point]) in positions for point in self.points], dtype=bool)

    def upright(self, mesh: Mesh) -> Mesh:
        """A mesh in the frame of `mesh` as it is rendered: +z up, its texture baked into vertex colours."""
        return bake_texture(rotate_to_z_up(mesh))

    def restored(self, mesh: Mesh) -> Mesh:
        """A mesh in the frame of `mesh` in the units of `source`; unmoved vertices have their original coordinates."""
        centre, radius = centre_and_radius(self.source)
        vertices = mesh.vertices * (radius / RADIUS) + centre
        vertex = same_place(self.mesh.vertices, mesh.vertices)
        vertices[vertex >= 0] = self.source.vertices[vertex[vertex >= 0]]
        return replace(mesh, vertices=vertices)

    def _simplify(self, mesh, ids, faces, below=False):
        keep, rings = self._on_cut(ids)
        counts = {"weights": None if self.weights is None else self.weights[ids], "attributes": self.attributes}
        counts["free_borders"] = self._free(ids) if self.free_borders else False
        # Those that the error does not count are transferred once, at the end.
        bare = mesh if self.attributes else replace(mesh, colors=None, texture=None)
        reduced = simplify(bare, faces, keep, rings, self.backend, self.shrink, below=below, **counts)
        return self.mesh if reduced is bare else carry(self.mesh, close_borders(reduced, mesh, ids))

    def _free(self, ids):
        """(n',) boolean: of the cut mesh's vertices those of the boundary alone."""
        return np.isin(ids, self.boundary) & (np.bincount(ids)[ids] == 1)

    def _on_cut(self, ids):
        """(vertex ids, rings): the points on the cut mesh, whose vertices have the old ids `ids`; with all copies."""
        order = np.argsort(ids, kind="stable")
        first, last = (np.searchsorted(ids[order], self.points, side) for side in ("left", "right"))
        copies = np.repeat(np.arange(len(self.points)), last - first)
        offset = np.arange(len(copies)) - np.repeat(np.cumsum(last - first) - (last - first), last - first)
        return order[first[copies] + offset], self.rings[copies]


def _unpaired_edges(faces, opposite):
    alone = opposite < 0
    ends = np.stack([faces.ravel()[alone], np.roll(faces, -1, axis=1).ravel()[alone]], axis=1)
    return np.unique(np.sort(ends, axis=1), axis=0)


SAME = 1e-9  # of the diagonal: closer vertices coincide; a circle's last point is 1e-16 away from its first


def repaired(mesh: Mesh) -> tuple[Mesh, list[str]]:
    """(Mesh, notes): `haptic_glance.mesh.repair` of the mesh, coincident vertices merged where that closes the
    boundary.

    Files that store corners (a triangle soup, one patch per texture) have a boundary around each of them, and
    boundaries are preserved, so nothing could be collapsed. Raises MeshError as `clean` does.
    """
    cleaned, notes = clean(mesh)
    if (half_edges(cleaned.faces)[1] >= 0).all():
        return cleaned, notes
    first, ids = merge_equal_rows(np.rint(mesh.vertices / (SAME * mesh.diagonal)))
    joint_mesh = replace(mesh, vertices=mesh.vertices[first], faces=ids[mesh.faces], colors=None)
    joint_mesh, blended = _coloured(joint_mesh, mesh, first, ids)
    joint_mesh, remarks = clean(joint_mesh)
    if (half_edges(joint_mesh.faces)[1] < 0).sum() >= (half_edges(cleaned.faces)[1] < 0).sum():
        return cleaned, notes
    return joint_mesh, [f"{len(ids) - len(first):,} coincident vertices merged", *blended, *remarks]


def _coloured(joint_mesh, mesh, first, ids):
    """(the mesh of merged vertices with the colours of `mesh`, notes): faces of one colour each keep it in a texture.

    Other colours that meet at one place are blended.
    """
    if mesh.colors is None:
        return joint_mesh, []
    colors = mesh.colors[first]
    if (colors[ids] == mesh.colors).all():
        return replace(joint_mesh, colors=colors), []
    corners = mesh.colors[mesh.faces]
    if (corners == corners[:, :1]).all():
        return replace(joint_mesh, texture=flat_texture(corners[:, 0])), []
    count = np.bincount(ids)[:, None]
    sums = np.stack([np.bincount(ids, weights=column) for column in mesh.colors.T.astype(np.float64)], axis=1)
    colors = np.rint(sums / count).astype(np.uint8)
    return replace(joint_mesh, colors=colors), ["colours that meet at one place are blended"]


PLAIN, QSLIM = "qem", "qslim"  # quadric edge collapse by the backend of the settings, and without its fit
SOFT = "soft"


@dataclass(frozen=True)
class Variant:
    """One way of simplifying: the method of salient_points (None: plain QEM), and how it is used.

    rule: that of `neighbourhoods`, which preserves the points, or `soft`: the saliency weights the error and nothing is
    frozen; None for plain QEM. backend: who simplifies; None for that of the settings.
    """

    name: str
    method: str | None
    rule: str | None
    backend: str | None = None


def variant(name: str) -> Variant:
    """The Variant of a name: `qem`, `qslim`, `glance` (three rings), `glance-adaptive`, `-area` or `-soft`.

    Raises ValueError that names the wrong part.
    """
    if name in (PLAIN, QSLIM):
        return Variant(name, None, None, QSLIM if name == QSLIM else None)
    method, dash, rule = name.partition("-")
    suffixes = [suffix for suffix in (*NEIGHBOURHOODS, SOFT) if suffix != "fixed"]
    methods = (PLAIN, QSLIM, *METHODS)
    if not is_method(method):
        hint = meant(method.lower(), methods) or f"; methods are {', '.join(methods)}"
        raise ValueError(f"{name!r}: unknown method {method!r}{hint}")
    if dash and rule not in suffixes:
        raise ValueError(f"{name!r} ends in {rule!r}; endings are -{', -'.join(suffixes)}, or none")
    return Variant(name, method, rule or "fixed")


def infeasible(task: SimplificationTask, error: InfeasibleTarget, neighbourhood: str = SOFT) -> str:
    """The message for a target that is too low: the reason, and what is feasible; neighbourhood: as --neighbourhood."""
    frozen = [f"{number(error.frozen, 'face')} around {number(len(task.points), 'point')}"] if error.frozen else []
    if len(task.boundary) and not task.free_borders:
        frozen.append(f"{number(len(task.boundary), 'boundary edge')}")
    reason = f", since {' and '.join(frozen)} are frozen" if frozen else ""
    ways = remedies(task, error, neighbourhood) or ["the mesh cannot be simplified further"]
    return (
        f"{number(error.faces, 'face')} {'is' if error.faces == 1 else 'are'} infeasible{reason}: {', or '.join(ways)}"
    )


FREE_BORDERS = "let the boundary be simplified with --free-borders"


def may_free_borders(task: SimplificationTask) -> bool:
    """Whether the mesh has a boundary that stays, and that the backend could simplify."""
    able = not task.attributes and task.backend != "pymeshlab"
    return able and not task.free_borders and len(task.boundary) > 0


def remedies(task: SimplificationTask, error: InfeasibleTarget, neighbourhood: str) -> list[str]:
    """The remedies; empty where there is none."""
    total = len(task.mesh.faces)
    possible = smallest_feasible(task.mesh, free_borders=task.free_borders) < total  # with nothing frozen
    ways = [f"ask for {number(error.smallest, 'face')} or more"] if error.smallest < total else []
    if may_free_borders(task) and (possible or smallest_feasible(task.mesh, free_borders=True) < total):
        ways += [FREE_BORDERS]
    if error.frozen and possible:
        ways += _thaw(task, neighbourhood)
    return ways + ([] if possible else _mend(task.mesh))


def _thaw(task, neighbourhood):
    ways = ["--keep fewer points"] if len(task.points) > 1 else []
    if neighbourhood == "fixed" and task.rings.any():
        ways += ["take fewer --rings"]
    return [*ways, *(() if task.shrink else ("let them --shrink",)), "leave --neighbourhood out"]


def _mend(mesh):
    shape = topology(mesh.faces)
    holes = shape.boundary_loops - (shape.components - shape.closed_components)  # one loop of each may be its outline
    ways = [f"close its {number(holes, 'hole')} first"] if holes > 0 else []
    return [*ways, *(["join its connected components first"] if shape.components > 1 and shape.boundary_edges else [])]


def number(count: int, noun: str) -> str:
    """`1 face`, `1,280 faces`."""
    return f"{count:,} {noun}{'' if count == 1 else 's'}"

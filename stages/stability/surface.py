"""Whether a simplified mesh is sound, and the error beyond which a result is ruined.

The checks (boundary edges, components, degenerate and duplicate faces, folds, non-manifold parts) use trimesh and numpy
and not the simplifiers' own functions, so that an error in those shows here. The limit follows from the error of plain
quadric edge collapse (QEM) by face count.
"""

from dataclasses import dataclass
from functools import cached_property

import numpy as np
import point_cloud_utils as pcu
import pymeshlab
import trimesh
from scipy import sparse
from scipy.sparse.csgraph import connected_components

from haptic_glance.base.rng import rng
from haptic_glance.lod.export import face_count
from haptic_glance.mesh.mesh import Mesh

from .broken import DAMAGES

FOLDED = 0.99  # cosine between two neighbours seen along their edge: at most 8 degrees apart
FLAT = 1e-8  # height of a face over the diagonal, below which it counts as without area


@dataclass(frozen=True, eq=False)
class Surface:
    """The counts of a mesh, which must have a face."""

    mesh: Mesh

    @cached_property
    def as_trimesh(self) -> trimesh.Trimesh:
        """The mesh in trimesh, with nothing merged, at unit size since trimesh's tolerances are absolute."""
        vertices, size = self.mesh.vertices, self.mesh.diagonal or 1.0
        centre = vertices[self.mesh.faces[0, 0]]
        return trimesh.Trimesh((vertices - centre) / size, self.mesh.faces, process=False, validate=False)

    @cached_property
    def edge_counts(self) -> tuple[np.ndarray, np.ndarray]:
        """((e, 2) edges, (e,) how many faces each has)."""
        edges, count = np.unique(self.as_trimesh.edges_sorted, axis=0, return_counts=True)
        return edges, count

    @cached_property
    def welded(self) -> trimesh.Trimesh:
        """The mesh in trimesh with vertices at equal positions merged, without faces that then name a vertex twice."""
        places, place_ids = np.unique(self.as_trimesh.vertices, axis=0, return_inverse=True)
        faces = place_ids.ravel()[self.mesh.faces]
        whole = (faces != np.roll(faces, 1, axis=1)).all(axis=1)
        return trimesh.Trimesh(places, faces[whole], process=False, validate=False)

    @cached_property
    def boundary_edges(self) -> set[bytes]:
        """The edges that an odd number of faces share once equal positions are merged, as bytes of both ends.

        This is the boundary in the sense of homology. A collapse inside the surface leaves it unchanged, whatever it
        does to non-manifold edges; a hole that opens, closes or moves changes it.
        """
        places, place_ids = np.unique(self.mesh.vertices, axis=0, return_inverse=True)
        ends = np.sort(place_ids.ravel()[self.mesh.faces][:, [[0, 1], [1, 2], [2, 0]]].reshape(-1, 2), axis=1)
        edges, count = np.unique(ends[ends[:, 0] != ends[:, 1]], axis=0, return_counts=True)
        return {pair.tobytes() for pair in places[edges[count % 2 == 1]] + 0.0}  # + 0.0: minus zero is zero

    @cached_property
    def components(self) -> int:
        """The number of connected components: faces are connected by edges that exactly two of them share."""
        return len(
            trimesh.graph.connected_components(self.as_trimesh.face_adjacency, nodes=np.arange(len(self.mesh.faces)))
        )

    @cached_property
    def degenerate_faces(self) -> int:
        """The number of faces without area or with a repeated vertex."""
        return int((~trimesh.triangles.nondegenerate(self.as_trimesh.triangles, height=FLAT)).sum())

    @cached_property
    def folds(self) -> np.ndarray:
        """(2,) numbers of pairs of neighbouring faces that are folded onto each other, of the mesh as it is and welded.

        The first misses a fold at an edge without length, the second one at an edge with a third face.
        """
        return np.array([_folds(self.as_trimesh), _folds(self.welded)])

    @cached_property
    def duplicate_faces(self) -> int:
        """The number of faces with the same corner positions as another one."""
        corners = np.sort(self.welded.faces, axis=1)
        return len(corners) - len(np.unique(corners, axis=0))

    @cached_property
    def non_manifold_edges(self) -> int:
        """The number of edges with three faces or more."""
        return int((self.edge_counts[1] > 2).sum())

    @cached_property
    def non_manifold_vertices(self) -> int:
        """The number of fans of faces that share nothing but a vertex with the others around it."""
        pairs, edges = self.as_trimesh.face_adjacency, self.as_trimesh.face_adjacency_edges
        faces, n = self.mesh.faces, len(self.mesh.faces)
        tails, heads = [], []
        for end in edges.T:
            corner = [3 * face + (faces[face] == end[:, None]).argmax(axis=1) for face in pairs.T]
            tails, heads = [*tails, corner[0]], [*heads, corner[1]]
        links = np.ones(2 * len(pairs), dtype=bool)
        adjacency = sparse.csr_matrix((links, (np.concatenate(tails), np.concatenate(heads))), shape=(3 * n, 3 * n))
        return connected_components(adjacency, directed=False)[0] - len(np.unique(faces))

    @cached_property
    def volume(self) -> float:
        """The signed volume of a closed surface, in cubed diagonals."""
        return float(np.einsum("ij,ij->", self.as_trimesh.triangles[:, 0], self.as_trimesh.triangles_cross) / 6)

    @cached_property
    def deduplicated(self) -> "Surface":
        """The Surface without duplicate faces and without faces that name a vertex twice."""
        corners = np.sort(self.mesh.faces, axis=1)
        whole = (corners[:, 0] != corners[:, 1]) & (corners[:, 1] != corners[:, 2])
        first = np.zeros(len(corners), dtype=bool)
        first[np.unique(corners, axis=0, return_index=True)[1]] = True
        return Surface(Mesh(self.mesh.vertices, self.mesh.faces[whole & first]))

    @cached_property
    def closed(self) -> bool:
        """True when every edge has two faces with consistent winding."""
        return bool(self.as_trimesh.is_watertight and self.as_trimesh.is_winding_consistent)


def _folds(scene):
    """The number of folds; measured along the edge, so that the winding does not matter."""
    ends = scene.vertices[scene.face_adjacency_edges]
    along = trimesh.util.unitize(ends[:, 1] - ends[:, 0])
    sides = []
    for tip in scene.face_adjacency_unshared.T:
        offset = scene.vertices[tip] - ends[:, 0]
        sides.append(trimesh.util.unitize(offset - np.einsum("ij,ij->i", offset, along)[:, None] * along))
    return int((np.einsum("ij,ij->i", *sides) > FOLDED).sum())


COUNTS = {  # counts of a Surface that simplification must not increase -> their names in messages
    "degenerate_faces": "faces without area",
    "folds": "folds",
    "duplicate_faces": "duplicate faces",
    "non_manifold_edges": "non-manifold edges",
    "non_manifold_vertices": "non-manifold vertices",
}
SAMPLES = 2000  # points on each surface: the mean error is then exact to 3 %


def find_faults(
    old: Surface, simplified: Mesh, faces: int, kept_vertices: np.ndarray, kept_faces: np.ndarray
) -> list[str]:
    """The faults of a simplified mesh as phrases, [] when it is sound.

    old: the surface before simplification; simplified: the result; faces: the number asked for; kept_vertices (k,) ids
    and kept_faces (j, 3): what must survive bit for bit. A simplifier may first remove duplicate faces and faces
    that name a vertex twice: boundary and connected components may be those of the mesh with or without them.
    """
    if len(simplified.faces) == 0:
        return ["no face left"]
    before, new, faults = old.mesh, Surface(simplified), []
    if len(simplified.faces) > faces:
        faults.append(f"{len(simplified.faces)} faces, {faces} asked")
    lost_count = _missing(before.vertices[kept_vertices], simplified.vertices[np.unique(simplified.faces)])
    if lost_count:
        faults.append(f"{lost_count} kept vertices lost")
    lost_count = _missing(_triples(before.vertices[kept_faces]), _triples(simplified.vertices[simplified.faces]))
    if lost_count:
        faults.append(f"{lost_count} kept faces lost")
    if new.boundary_edges not in (old.boundary_edges, old.deduplicated.boundary_edges):
        faults.append(f"boundary changed in {len(new.boundary_edges ^ old.boundary_edges)} edges")
    if new.components not in (old.components, old.deduplicated.components):
        faults.append(f"{new.components} connected components instead of {old.components}")
    for name, words in COUNTS.items():
        more = np.min(getattr(new, name) - getattr(old, name))  # folds are counted in two ways
        if more > 0:
            faults.append(f"{more} new {words}")
    if old.closed and not new.closed:
        faults.append("no longer closed")
    elif old.closed and old.volume * new.volume < 0:
        faults.append("inside out")
    return faults


def surface_error(before: Mesh, after: Mesh) -> float:
    """The mean distance of two surfaces, the larger of both directions, over the diagonal of the first (T3.1.4).

    Measured at points drawn uniformly by area, or at the corners of the faces where a mesh has no area.
    """
    place, size = before.vertices[before.faces[0, 0]], before.diagonal or 1.0
    first, second = (
        trimesh.Trimesh((mesh.vertices - place) / size, mesh.faces, process=False) for mesh in (before, after)
    )
    return max(_mean_distance(first, second), _mean_distance(second, first))


def _mean_distance(source, target):
    has_area = source.area > FLAT**2
    points = trimesh.sample.sample_surface(source, SAMPLES, seed=0)[0] if has_area else source.triangles.reshape(-1, 3)
    faces = np.ascontiguousarray(target.faces, dtype=np.int64)
    gaps = pcu.closest_points_on_mesh(np.ascontiguousarray(points), np.ascontiguousarray(target.vertices), faces)[0]
    return float(np.mean(gaps))


def _missing(rows, among):
    """How many of the rows (k, d) are not bit for bit among the others."""
    row_bytes = {row.tobytes() for row in np.ascontiguousarray(among)}
    return sum(row.tobytes() not in row_bytes for row in np.ascontiguousarray(rows))


def _triples(corners):
    """(j, 9): the corners (j, 3, 3) of each triangle sorted by position, so that equal triangles give equal rows."""
    order = np.lexsort(corners.transpose(2, 0, 1)[::-1], axis=-1)
    return np.take_along_axis(corners, order[:, :, None], axis=1).reshape(-1, 9)


# pymeshlab comes without types:
# pyright: reportAttributeAccessIssue=false


FEWEST_FACES = 16  # below this number the error of plain QEM is a matter of chance
LEAST_ERROR = 1e-4  # of the diagonal: smaller errors, as on flat faces, are set to this


class QemErrorCurve:
    """The mean error of plain QEM on a sound mesh at any face count, interpolated between a few measured ones."""

    def __init__(self, sound: Mesh) -> None:
        counts = {face_count(target, len(sound.faces)) for target in ("16", "64", "256", "1024", "50%")}
        self.counts = sorted(count for count in counts if FEWEST_FACES <= count < len(sound.faces))
        self.errors = [max(surface_error(sound, plain_qem(sound, count)), LEAST_ERROR) for count in self.counts]

    def error(self, faces: int) -> float:
        """The mean error over the diagonal: linear between the counts in log-log space, infinite below FEWEST_FACES."""
        if faces < FEWEST_FACES or not self.counts:
            return np.inf
        return float(np.exp(np.interp(np.log(faces), np.log(self.counts), np.log(self.errors))))


def plain_qem(mesh: Mesh, faces: int) -> Mesh:
    """The mesh at `faces` faces by pymeshlab's quadric edge collapse, without any of its constraints."""
    work = pymeshlab.MeshSet(verbose=False)
    work.add_mesh(pymeshlab.Mesh(mesh.vertices / mesh.diagonal, mesh.faces))
    work.apply_filter(
        "meshing_decimation_quadric_edge_collapse", targetfacenum=faces, targetperc=0.0, qualitythr=0.3,
        preserveboundary=False, boundaryweight=1.0, preservenormal=False, preservetopology=False,
        optimalplacement=True, planarquadric=True, planarweight=1e-5, qualityweight=False, autoclean=False,
        selected=False,
    )  # fmt: skip
    reduced = work.current_mesh()
    return Mesh(reduced.vertex_matrix() * mesh.diagonal, reduced.face_matrix())


RINGS = 3  # rings of faces kept around a kept vertex; T3.1.3
RUIN = 4.0  # times the mean error of plain QEM on the sound mesh at the number of free faces
LARGEST_ERROR = 0.15  # of the diagonal, allowed at any budget; a tetrahedron inscribed in a sphere has 0.12
KEPT = {"none": 0, "1": 1, "5": 5, "60": 60, "half": 0.5, "all": 1.0}  # kept vertices: a number or a share
WEIGHTS = {
    "zero": lambda n, _: np.zeros(n),
    "equal": lambda n, _: np.full(n, 0.5),
    "spike": lambda n, generator: np.eye(1, n, generator.integers(n))[0],
    "random": lambda n, generator: generator.random(n),
}


@dataclass(frozen=True)
class Case:
    """The request: the face count, the kept vertices (a name of KEPT) and the weights (a name of WEIGHTS)."""

    budget: str
    kept: str = "none"
    soft: str = ""


class Specimen:
    """A sound mesh broken in one way (a name of DAMAGES), with what its cases share.

    name and seed decide all random numbers.
    """

    def __init__(self, sound: Mesh, curve: QemErrorCurve, damage: str, name: str, seed: int) -> None:
        self.curve, self.damage, self.name, self.seed = curve, damage, f"{name} {damage}", seed
        self.mesh = DAMAGES[damage].make(sound, rng(seed, self.name))
        self.surface = Surface(self.mesh)

    @cached_property
    def _order(self) -> np.ndarray:
        return rng(self.seed, f"{self.name} kept").permutation(np.unique(self.surface.deduplicated.mesh.faces))

    def kept(self, case: Case) -> np.ndarray:
        """Ids of the vertices that a case keeps: the first of all used vertices in one random order."""
        count = KEPT[case.kept]
        return self._order[: round(count * len(self._order)) if isinstance(count, float) else count]

    def weights(self, case: Case) -> np.ndarray | None:
        """The weights (n,) of a case, or None."""
        generator = rng(self.seed, f"{self.name} {case.soft}")
        return WEIGHTS[case.soft](len(self.mesh.vertices), generator) if case.soft else None

    def kept_faces(self, kept: np.ndarray) -> np.ndarray:
        """(j, 3) faces that must survive with the kept vertices: those within RINGS edges of them."""
        faces = self.surface.deduplicated.mesh.faces
        near = np.isin(np.arange(len(self.mesh.vertices)), kept)
        for _ in range(RINGS):
            near[faces[near[faces].any(axis=1)]] = True
        return faces[near[faces].all(axis=1)]

    def limit(self, target: int, frozen: int) -> float:
        """The largest mean error allowed for a result of `target` faces, `frozen` of them kept.

        Each boundary edge needs one face and each further connected component four; the other faces are free. What the
        damage itself moved is added.
        """
        free = target - frozen - len(self.surface.boundary_edges) - 4 * (self.surface.deduplicated.components - 1)
        return min(RUIN * self.curve.error(free) + DAMAGES[self.damage].moved, LARGEST_ERROR)

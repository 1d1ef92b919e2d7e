"""A mesh broken in one way, the cases of its simplification, and the error beyond which a result is ruined."""

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from haptic_glance.base.rng import rng
from haptic_glance.mesh.mesh import Mesh

from .broken import DAMAGES
from .qem_error_curve import QemErrorCurve
from .surface import Surface

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
    """What is asked for: the face count, the kept vertices (a name of KEPT) and the weights (a name of WEIGHTS)."""

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

    def limit(self, asked: int, frozen: int) -> float:
        """The largest mean error allowed for a result of `asked` faces, `frozen` of them kept.

        Each boundary edge needs one face and each further connected component four; the other faces are free. What the
        damage itself moved is added.
        """
        free = asked - frozen - len(self.surface.boundary_edges) - 4 * (self.surface.deduplicated.components - 1)
        return min(RUIN * self.curve.error(free) + DAMAGES[self.damage].moved, LARGEST_ERROR)

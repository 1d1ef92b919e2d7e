"""A mesh broken in one way, what is asked of its simplification, and the error beyond which the answer is a ruin."""

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from stages.kit.rng import rng

from .broken import BROKEN
from .plain_curve import PlainCurve
from .surface import Surface

RINGS = 3  # round a kept vertex; T3.1.3
RUIN = 4.0  # times the mean error of plain QEM of the sound mesh with as many faces as are free here
FURTHEST = 0.15  # of the diagonal: a ruin at any budget; 0.12 is that of a tetrahedron whose corners lie on a sphere
KEPT = {"none": 0, "1": 1, "5": 5, "60": 60, "half": 0.5, "all": 1.0}  # kept vertices: a number or a share
WEIGHTS = {
    "zero": lambda n, _: np.zeros(n),
    "equal": lambda n, _: np.full(n, 0.5),
    "spike": lambda n, generator: np.eye(1, n, generator.integers(n))[0],
    "random": lambda n, generator: generator.random(n),
}


@dataclass(frozen=True)
class Case:
    """What is asked: the face count, how many vertices are kept (KEPT), with which weights (WEIGHTS)."""

    budget: str
    kept: str = "none"
    soft: str = ""


class Specimen:
    """A sound mesh broken in one way (a name of BROKEN), with what its cases share. name, seed decide every draw."""

    def __init__(self, sound, curve: PlainCurve, damage, name, seed):
        self.curve, self.damage, self.name, self.seed = curve, damage, f"{name} {damage}", seed
        self.mesh = BROKEN[damage].make(sound, rng(seed, self.name))
        self.surface = Surface(self.mesh)

    @cached_property
    def _order(self):
        return rng(self.seed, f"{self.name} kept").permutation(np.unique(self.surface.tidy.mesh.faces))

    def kept(self, case):
        """Ids of the vertices that a case keeps, of those that a face uses, in an order drawn once."""
        count = KEPT[case.kept]
        return self._order[: round(count * len(self._order)) if isinstance(count, float) else count]

    def weights(self, case):
        """dict(weights=(n,)) of a case, or an empty one."""
        generator = rng(self.seed, f"{self.name} {case.soft}")
        return {"weights": WEIGHTS[case.soft](len(self.mesh.vertices), generator)} if case.soft else {}

    def kept_faces(self, kept):
        """(j, 3) faces that must survive with the kept vertices: those within RINGS edges of them."""
        faces = self.surface.tidy.mesh.faces
        near = np.isin(np.arange(len(self.mesh.vertices)), kept)
        for _ in range(RINGS):
            near[faces[near[faces].any(axis=1)]] = True
        return faces[near[faces].all(axis=1)]

    def limit(self, asked, frozen):
        """The mean error beyond which `asked` faces, `frozen` of them kept, are a ruin.

        Each edge of the rim takes a face, each further piece four: what is left is free. What the damage itself moved
        is allowed on top.
        """
        free = asked - frozen - len(self.surface.border) - 4 * (self.surface.tidy.pieces - 1)
        return min(RUIN * self.curve.error(free) + BROKEN[self.damage].moved, FURTHEST)

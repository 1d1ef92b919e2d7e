"""The levels of an object, from its own mesh down to the coarsest sound one, each with its measured error."""

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from stages.kit import Mesh, RayScene
from stages.kit.rng import rng
from stages.lod import InfeasibleTarget, SimplifyError, simplify
from stages.lod.nearest import Surface
from stages.views.shading import corner_groups

from .place import bounds

STEP = 2**-0.5  # faces of a level over those of the one before: two levels a halving
COARSEST = 12  # faces: below, no household object can be told from another
SAMPLES = 2000  # points on each surface: the 99 % quantile is then known to about 10 %
ERRORS = ("rms", "q95", "q99", "max")


@dataclass(frozen=True, eq=False)
class Level:
    """A mesh of the ladder. error: distances to the object's own surface in units of the mesh, dict of ERRORS."""

    mesh: Mesh
    error: dict[str, float]

    @property
    def faces(self):
        """How many faces it has."""
        return len(self.mesh.faces)

    @cached_property
    def box(self):
        """(low (3,), high (3,)): a coarse level may stick out of the box of the finest."""
        return bounds(self.mesh)

    @cached_property
    def rays(self):
        """The mesh made ready for rays."""
        return RayScene(self.mesh)

    @cached_property
    def corners(self):
        """(groups, normals) of the corners of its faces, for shading."""
        return corner_groups(self.mesh)

    @cached_property
    def surface(self):
        """The mesh made ready for distances."""
        return Surface(self.mesh)


def build_ladder(mesh, seed=0, **options):
    """tuple of Levels of a mesh, most faces first, two a halving down to COARSEST; the first is the mesh itself.

    options: those of stages.lod.simplify, say the salient vertices to keep; their neighbourhoods shrink from the least
    salient on where there are too few faces for them. A count that cannot be had soundly is left out.
    """
    levels = [finest(mesh)]
    for count in steps(len(mesh.faces)):
        try:
            found = simplify(mesh, count, shrink=True, **options)
        except InfeasibleTarget:
            break
        except SimplifyError:
            continue
        if len(found.faces) < levels[-1].faces:
            levels.append(Level(found, surface_errors(found, levels[0].surface, seed)))
    return tuple(levels)


def finest(mesh):
    """The Level of a mesh as it is."""
    return Level(mesh, dict.fromkeys(ERRORS, 0.0))


def steps(faces):
    """Face counts below `faces`, each STEP times the one before, down to COARSEST."""
    counts = np.rint(faces * STEP ** np.arange(1, 60)).astype(int)
    return [int(count) for count in counts if count >= COARSEST]


def surface_errors(level_mesh, own, seed=0):
    """dict of ERRORS: distances of a mesh and the Surface `own` in their unit, the larger of the two directions.

    From SAMPLES points spread over either surface, and the vertices.
    """
    other = Surface(level_mesh)
    there, back = _distances(own, other, rng(seed, "own")), _distances(other, own, rng(seed, "level"))
    found = {"rms": np.sqrt([(there**2).mean(), (back**2).mean()])}
    found |= {f"q{share}": [np.quantile(side, share / 100) for side in (there, back)] for share in (95, 99)}
    corners = [own.nearest(_corners(level_mesh))[0].max(), other.nearest(_corners(own.mesh))[0].max()]
    found["max"] = [there.max(), back.max(), *corners]
    return {name: float(max(found[name])) for name in ERRORS}


def _distances(surface, other, generator):
    return other.nearest(surface.sample(SAMPLES, generator)[0])[0]


def _corners(mesh):
    return mesh.vertices[np.unique(mesh.faces)]

"""The LOD chain of an object, from its own mesh down to the coarsest sound one, each level with its measured error."""

from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np

from haptic_glance.base.rng import rng
from haptic_glance.look.views.shading import corner_groups
from haptic_glance.mesh.mesh import Mesh, bounding_box
from haptic_glance.mesh.nearest import SurfaceIndex
from haptic_glance.mesh.rays import RayScene

from ..feasibility import InfeasibleTarget, SimplifyError
from ..simplify import simplify
from .camera import Box

STEP = 2**-0.5  # faces of a level over those of the previous one: two levels per halving
COARSEST = 12  # faces: with fewer, no household object can be recognised
SAMPLES = 2000  # points on each surface: the 99 % quantile is then known to about 10 %
ERRORS = ("rms", "q95", "q99", "max")


@dataclass(frozen=True, eq=False)
class Level:
    """A mesh of the chain. error: dict of ERRORS, distances to the object's own surface in units of the mesh."""

    mesh: Mesh
    error: dict[str, float]

    @property
    def faces(self) -> int:
        """The face count."""
        return len(self.mesh.faces)

    @cached_property
    def box(self) -> Box:
        """(low (3,), high (3,)): a coarse level may exceed the box of the finest."""
        return bounding_box(self.mesh)

    @cached_property
    def rays(self) -> RayScene:
        """The mesh, for ray casting."""
        return RayScene(self.mesh)

    @cached_property
    def corners(self) -> tuple[np.ndarray, np.ndarray]:
        """(groups, normals) of the corners of its faces, for shading."""
        return corner_groups(self.mesh)

    @cached_property
    def surface(self) -> SurfaceIndex:
        """The mesh, for distances."""
        return SurfaceIndex(self.mesh)


def build_lod_chain(mesh: Mesh, seed: int = 0, **options: Any) -> tuple[Level, ...]:
    """The levels of detail of a mesh, most faces first, two per halving of the faces; the first is the mesh itself.

    Parameters
    ----------
    mesh : Mesh
        The mesh.
    seed : int
        Seed of the points that the errors are measured at.
    **options
        Options of `haptic_glance.lod.simplify`, for example the salient vertices to keep; their neighbourhoods shrink,
        the least salient first, where there are too few faces for them.

    Returns
    -------
    tuple of Level
        The levels with their errors. A count without a sound mesh is left out.

    Examples
    --------
    >>> import trimesh
    >>> from haptic_glance import as_mesh
    >>> from haptic_glance.lod.scene import build_lod_chain
    >>> [level.faces for level in build_lod_chain(as_mesh(trimesh.creation.icosphere(2)))][:3]
    [320, 226, 160]
    """
    levels = [finest(mesh)]
    for count in face_counts(len(mesh.faces)):
        try:
            reduced = simplify(mesh, count, shrink=True, **options)
        except InfeasibleTarget:
            break
        except SimplifyError:
            continue
        if len(reduced.faces) < levels[-1].faces:
            levels.append(Level(reduced, level_errors(reduced, levels[0].surface, seed)))
    return tuple(levels)


def finest(mesh: Mesh) -> Level:
    """The Level of the unsimplified mesh."""
    return Level(mesh, dict.fromkeys(ERRORS, 0.0))


def face_counts(faces: int) -> list[int]:
    """Face counts below `faces`, each STEP times the previous one, down to COARSEST."""
    counts = np.rint(faces * STEP ** np.arange(1, 60)).astype(int)
    return [int(count) for count in counts if count >= COARSEST]


def level_errors(level_mesh: Mesh, base: SurfaceIndex, seed: int = 0) -> dict[str, float]:
    """dict of ERRORS: distances between a mesh and the surface `base` in their unit, the larger of the two directions.

    From SAMPLES points on either surface, and the vertices.
    """
    coarse = SurfaceIndex(level_mesh)
    forth, back = _distances(base, coarse, rng(seed, "own")), _distances(coarse, base, rng(seed, "level"))
    distances = {"rms": np.sqrt([(forth**2).mean(), (back**2).mean()])}
    distances |= {f"q{share}": [np.quantile(side, share / 100) for side in (forth, back)] for share in (95, 99)}
    ways = (level_mesh, base), (base.mesh, coarse)
    corners = [surface.nearest(mesh.vertices[mesh.used])[0].max() for mesh, surface in ways]
    distances["max"] = [forth.max(), back.max(), *corners]
    return {name: float(max(distances[name])) for name in ERRORS}


def _distances(surface, target, generator):
    return target.nearest(surface.sample(SAMPLES, generator)[0])[0]

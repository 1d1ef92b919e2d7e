"""What the comparison needs of one object."""

from dataclasses import dataclass, field
from functools import cached_property

import numpy as np

from haptic_glance.lod.perceptual import Analysis, analyse
from haptic_glance.mesh.mesh import Mesh


@dataclass(frozen=True)
class ObjectInputs:
    """What all cells of one object share.

    Its mesh; the points and the saliency (n,) by method; its own pictures (views, rows, columns), or None where they
    are not compared; human gaze spread over the surface (n,), or None; and a cache of its simplified meshes and their
    errors, since many methods keep the same faces, above all where nothing can be kept.
    """

    name: str
    mesh: Mesh
    points: dict[str, np.ndarray]
    saliency: dict[str, np.ndarray]
    pictures: np.ndarray | None = None
    gaze: np.ndarray | None = None
    cache: dict = field(default_factory=dict, repr=False)

    @cached_property
    def analyses(self) -> list[Analysis] | None:
        """What comparisons need of its own pictures."""
        return None if self.pictures is None else analyse(self.pictures)

"""The inner loops of simplification and of its error measures: compiled kernels on plain arrays."""

from .attributes import Wedges
from .corners import fans, opposites
from .decimate import decimate
from .faults import count_faults
from .parts import face_components, signed_volumes, split_fans
from .quadrics import vertex_quadrics
from .refit import refit
from .surface import HalfEdgeMesh, compact

__all__ = [
    "HalfEdgeMesh", "Wedges", "compact", "count_faults", "decimate", "face_components", "fans", "opposites",
    "refit", "signed_volumes", "split_fans", "vertex_quadrics",
]  # fmt: skip

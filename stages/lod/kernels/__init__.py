"""What simplification does a million times a second: compiled kernels on plain arrays."""

from .components import components
from .corners import fans, partners
from .decimate import decimate
from .faults import count_faults
from .quadrics import vertex_quadrics
from .refit import refit
from .surface import Surface, compact

__all__ = [
    "Surface", "compact", "components", "count_faults", "decimate", "fans", "partners", "refit", "vertex_quadrics",
]  # fmt: skip

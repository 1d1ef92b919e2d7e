"""What simplification does a million times a second: compiled kernels on plain arrays."""

from .components import components
from .corners import fans, partners
from .decimate import decimate
from .faults import count_faults
from .parts import pieces, signed_volumes, split_fans
from .quadrics import vertex_quadrics
from .refit import refit
from .surface import Surface, compact, unit_box

__all__ = [
    "Surface", "compact", "components", "count_faults", "decimate", "fans", "partners", "pieces",
    "refit", "signed_volumes", "split_fans", "unit_box", "vertex_quadrics",
]  # fmt: skip

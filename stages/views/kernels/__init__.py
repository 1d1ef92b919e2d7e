"""What every pixel of a view asks for: compiled kernels on plain arrays."""

from .background import background_colour
from .cover import find_cover
from .depth import fold_depth, unfold_depth
from .raster import rasterise, shade_pixels

__all__ = ["background_colour", "find_cover", "fold_depth", "rasterise", "shade_pixels", "unfold_depth"]

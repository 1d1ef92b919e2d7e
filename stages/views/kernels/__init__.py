"""What every pixel of a view asks for: compiled kernels on plain arrays."""

from .raster import rasterise, shade_pixels

__all__ = ["rasterise", "shade_pixels"]

"""What every pixel of a map asks for: compiled kernels on plain arrays."""

from .surface import locate_pixels

__all__ = ["locate_pixels"]

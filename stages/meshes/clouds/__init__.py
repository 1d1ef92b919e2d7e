"""Point clouds and depth images: what a scanner or a camera gives, as a surface."""

from .cloud import Cloud
from .depth import FORMAT as DEPTH
from .depth import cloud_of_depth, read_depth
from .read import FORMATS, cloud_of, read_cloud
from .surface import surface_of

__all__ = ["DEPTH", "FORMATS", "Cloud", "cloud_of", "cloud_of_depth", "read_cloud", "read_depth", "surface_of"]

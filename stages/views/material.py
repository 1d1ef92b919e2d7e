"""How a surface reflects the light: matte by default, with a highlight where a setting asks for one."""

from dataclasses import astuple, dataclass

import numpy as np


@dataclass
class Material:
    """How a surface reflects the head light; the default is Lambert's, matte. The names are MATLAB's (T3.1.5).

    A point of colour C, whose normal has the cosine c to the light, has the brightness C (ambient + diffuse c) + white
    specular c^shininess, at most white. That is the model of Blinn (Models of light reflection for computer synthesized
    pictures, SIGGRAPH 1977): the half vector of a head light is the view axis. Raises ValueError for a share of the
    light outside 0..1, and for a shininess outside 1..1000.
    """

    ambient: float = 0.0  # share of the light that comes from all sides
    diffuse: float = 1.0  # share of the head light that leaves in the surface's own colour
    specular: float = 0.0  # share of the head light in the middle of a highlight, which is white
    shininess: float = 20.0  # exponent: the higher, the smaller the highlight; 5 to 20 are usual

    def __post_init__(self) -> None:
        for name, value in vars(self).items():
            low, high = (1, 1000) if name == "shininess" else (0, 1)
            if not low <= value <= high:
                raise ValueError(f"{name}={value} of a material must be between {low} and {high}")

    @property
    def values(self) -> np.ndarray:
        """(4,) f8: ambient, diffuse, specular, shininess."""
        return np.array(astuple(self), dtype=np.float64)


LAMBERT = Material()

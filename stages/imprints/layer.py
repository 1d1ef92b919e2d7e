"""The elastic layer over the array, in physical units: what turns an indentation into a pressure."""

from dataclasses import dataclass

import numpy as np

LIMITS = {"thickness": (0, np.inf), "modulus": (0, np.inf), "poisson": (-1, 0.5), "friction": (0, np.inf)}
UNITS = {"thickness": "metres", "modulus": "pascals"}


@dataclass(frozen=True)
class Layer:
    """A foam or soft rubber bonded to the rigid array, as Winkler's elastic foundation: a bed of separate springs.

        layer = Layer(thickness=0.002, modulus=2e5)

    A spring's pressure grows with its own indentation alone. This holds for a layer that is thin against the contact
    and compressible (Johnson, Contact Mechanics, 1985, sections 4.3 and 5.8). A rubber near a Poisson's ratio of 0.5
    bulges sideways, and this model is too stiff for it.

    thickness: metres; modulus: Young's, in pascals; poisson: Poisson's ratio, below 0.5; friction: Coulomb's
    coefficient between layer and object. The defaults are 2 mm of a soft open-celled foam.
    Raises ValueError for values out of range.
    """

    thickness: float = 0.002
    modulus: float = 2e5
    poisson: float = 0.2
    friction: float = 0.6

    def __post_init__(self) -> None:
        for name, (low, high) in LIMITS.items():
            value = getattr(self, name)
            if not (isinstance(value, int | float | np.number) and low < value < high):  # NaN fails as well
                upper = f" and below {high}" if high < np.inf else ", finite"
                unit = f" {UNITS[name]}" if name in UNITS else ""
                raise ValueError(f"layer: {name} must be above {low}{unit}{upper}, got {value}")

    @property
    def stiffness(self) -> float:
        """Pressure per indentation, in Pa/m: the layer cannot spread sideways (Johnson 1985, section 5.8)."""
        confined = (1 - self.poisson) / ((1 + self.poisson) * (1 - 2 * self.poisson))
        return self.modulus * confined / self.thickness

    @property
    def shear_stiffness(self) -> float:
        """Shear traction per tangential displacement, in Pa/m: simple shear of the layer."""
        return self.modulus / (2 * (1 + self.poisson)) / self.thickness

"""Nine channels of attention: what stands out in a view, and on the surface that it shows (T3.1.1, T3.2)."""

from .channels import CHANNELS, conspicuity
from .facing import facing
from .sight import Sight
from .storage import read_sight

__all__ = ["CHANNELS", "Sight", "conspicuity", "facing", "read_sight"]

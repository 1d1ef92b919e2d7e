"""What the frozen network is given: variants that differ from the plain one in one thing."""

from dataclasses import dataclass, replace

import numpy as np
import torch

from haptic_glance.deep.images import to_images
from haptic_glance.touch import Skin

RATES = (1e-4, 3e-4, 1e-3, 3e-3, 1e-2)


@dataclass(frozen=True)
class Variant:
    """What the frozen network is given. share: of the touches of each object that are trained on."""

    cells: int = 16
    weights: str = "imagenet"
    grey: bool = False  # the imprint in all three channels, not in the red one alone
    blocks: bool = False  # a cell becomes a block of equal pixels, not a smooth passage to the next
    own_statistics: bool = False  # the normalisation layers have the statistics of the touches, not of photographs
    rates: tuple[float, ...] = RATES
    share: float = 1.0
    skin: Skin = Skin()
    size: int = 80

    def images(self, imprints: np.ndarray) -> torch.Tensor:
        """(k, 3, size, size) f4 in 0..1 of imprints (k, cells, cells)."""
        pressed = self.skin(imprints)
        if self.blocks:
            pressed = pressed.repeat(self.size // self.cells, axis=1).repeat(self.size // self.cells, axis=2)
        images = to_images(pressed, self.size)
        return images[:, :1].expand(-1, 3, -1, -1) if self.grey else images


PLAIN = Variant()
FAULTY = Skin(blur=1.0, noise=0.1, dead=0.05)
VARIANTS = {
    "plain": PLAIN,
    "fine_array": replace(PLAIN, cells=128),
    "random_weights": replace(PLAIN, weights="random", own_statistics=True),
    "three_channels": replace(PLAIN, grey=True),
    "blocks": replace(PLAIN, blocks=True),
    "settled": replace(PLAIN, own_statistics=True),
    "size_224": replace(PLAIN, size=224),
    "rate_of_table_5_3": replace(PLAIN, rates=(1e-5,)),
    "rate_of_table_5_4": replace(PLAIN, rates=(1e-4,)),
    "fine_array_rate_of_table_5_4": replace(PLAIN, cells=128, rates=(1e-4,)),
    "fine_array_rate_of_table_5_3": replace(PLAIN, cells=128, rates=(1e-5,)),
    "quarter_of_the_touches": replace(PLAIN, share=0.25),
    "noise_0.05": replace(PLAIN, skin=Skin(noise=0.05)),
    "noise_0.2": replace(PLAIN, skin=Skin(noise=0.2)),
    "skin": replace(PLAIN, skin=FAULTY),
    "skin_and_rate": replace(PLAIN, skin=FAULTY, rates=(1e-5,)),
}

"""A denoising autoencoder for imprints (T6.3; Vincent et al. 2008, Extracting and composing robust features)."""

from functools import partial

import numpy as np
import torch
from torch.nn import functional

from haptic_glance.deep.device import repeatable
from haptic_glance.touch import Skin

from .denoisers import Denoiser

# What it learns to undo: harshest severity of each property of haptic_glance.touch.Skin. Severities are drawn between
# 0 and these; the harshest ones of touch_stability.severities lie beyond.
UNDONE = {"noise": 0.3, "dead": 0.3, "blur": 3.0}
CHANNELS = (16, 32, 64)
PASSES = 150
BATCH = 32
RATE = 0.003


class Autoencoder(torch.nn.Module):
    """Imprints (b, 1, rows, cols) in 0..1 to the same shape, by way of feature maps of a quarter of the size."""

    def __init__(self) -> None:
        super().__init__()
        one, two, three = CHANNELS
        self.down = torch.nn.ModuleList(
            torch.nn.Conv2d(before, after, 3, stride, padding=1)
            for before, after, stride in ((1, one, 1), (one, two, 2), (two, three, 2))
        )
        self.up = torch.nn.ModuleList(
            torch.nn.Conv2d(before, after, 3, padding=1) for before, after in ((three, two), (two, one))
        )
        self.last = torch.nn.Conv2d(one, 1, 3, padding=1)

    def forward(self, images: torch.Tensor) -> torch.Tensor:
        sizes = []
        for layer in self.down:
            sizes.append(images.shape[-2:])
            images = functional.relu(layer(images))
        for layer, size in zip(self.up, sizes[::-1], strict=False):
            images = functional.relu(layer(functional.interpolate(images, size=[*size])))
        return torch.sigmoid(self.last(images))


def train(training: np.ndarray, seed: int) -> Denoiser:
    """A Denoiser that learned from imprints (k, rows, cols) in 0..1, disturbed anew in every step, in eight symmetries.

    Its loss is the mean squared error. Architecture, passes and rate were fixed before any test touch was seen.
    """
    with repeatable(seed):
        network, random = Autoencoder(), np.random.default_rng(seed)
        steps = PASSES * -(-len(training) // BATCH)
        optimiser = torch.optim.Adam(network.parameters())
        schedule = torch.optim.lr_scheduler.OneCycleLR(optimiser, RATE, total_steps=steps)
        for _ in range(PASSES):
            for ids in np.array_split(random.permutation(len(training)), steps // PASSES):
                clean = turned(training[ids], random)
                optimiser.zero_grad()
                functional.mse_loss(network(_tensor(disturbed(clean, random))), _tensor(clean)).backward()
                optimiser.step()
                schedule.step()
    return partial(denoise, network.eval())


def disturbed(images: np.ndarray, random: np.random.Generator) -> np.ndarray:
    """The images (b, rows, cols) with one disturbance of UNDONE, of a severity drawn at random."""
    kind = random.choice(list(UNDONE))
    # Seeds far from those of the tested skins, whose dead cells it must not know.
    return Skin(**{kind: random.uniform(0, UNDONE[kind])}, seed=int(random.integers(2**20, 2**31)))(images, "training")


def turned(images: np.ndarray, random: np.random.Generator) -> np.ndarray:
    """The images (b, n, n) in one of their eight symmetries drawn at random; half a turn at most where not square."""
    quarter = 1 if images.shape[1] == images.shape[2] else 2
    rotated = np.rot90(images, quarter * int(random.integers(4)), axes=(1, 2))
    return rotated[:, ::-1] if random.integers(2) else rotated


@torch.inference_mode()
def denoise(network: Autoencoder, images: np.ndarray) -> np.ndarray:
    """(k, rows, cols) f4: what the network makes of imprints, on one thread."""
    with repeatable(0):
        return network(_tensor(images))[:, 0].numpy()


def _tensor(images):
    return torch.from_numpy(np.ascontiguousarray(images, dtype=np.float32))[:, None]

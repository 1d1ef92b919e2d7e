"""Training of the two networks: gradient descent whose rate halves when the loss stops falling (T4.4.8)."""

import numpy as np
import torch

from stages.kit.repeatable import repeatable

from .networks import ImageNet, NormalNet

RATE = 0.05  # initial learning rate: the default of mdCNN, the tool of T4.4.8, which has no momentum
IMAGE_BATCH, NORMAL_BATCH = 10, 16  # sequences per step, T4.4.8
PATIENCE = 3  # epochs without a lower loss, after which the rate halves
PREDICTION_BATCH = 64  # sequences predicted at once


class ImageInputs:
    """Imprints of sequences as input of a network, standardised by the training sequences.

    images (n, frames, rows, cols) u1 are kept as they are; a batch is converted to f4 when it is used.
    """

    batch = IMAGE_BATCH

    def __init__(self, images: np.ndarray, train: np.ndarray) -> None:
        self.images = images
        histogram = np.sum([np.bincount(part.ravel(), minlength=256) for part in _batches(images, train)], axis=0)
        share = histogram / histogram.sum()
        self.mean = float(share @ np.arange(256))
        self.std = max(float(np.sqrt(share @ (np.arange(256) - self.mean) ** 2)), 1.0)

    def network(self, classes: int) -> ImageNet:
        """An untrained network for these imprints."""
        return ImageNet(self.images.shape[1], self.images.shape[2:], classes)

    def __call__(self, ids: np.ndarray) -> torch.Tensor:
        return torch.from_numpy(self.images[ids]).float().sub_(self.mean).div_(self.std)


class NormalInputs:
    """Series of normals (n, frames, 3) f4, each coordinate standardised by the training sequences (table 4.8)."""

    batch = NORMAL_BATCH

    def __init__(self, normals: np.ndarray, train: np.ndarray) -> None:
        chosen = normals[train].astype(np.float64)
        spread = np.maximum(chosen.std(axis=(0, 1)), 1e-6)
        self.normals = ((normals - chosen.mean(axis=(0, 1))) / spread).astype(np.float32)

    def network(self, classes: int) -> NormalNet:
        """An untrained network for these series."""
        return NormalNet(self.normals.shape[1], classes)

    def __call__(self, ids: np.ndarray) -> torch.Tensor:
        return torch.from_numpy(self.normals[ids])


def train_network(
    inputs: ImageInputs | NormalInputs, labels: np.ndarray, train: np.ndarray, classes: int, epochs: int, seed: int
) -> ImageNet | NormalNet:
    """A network in evaluation mode, trained on the sequences `train` (n,) of `inputs` with labels (k,) i8.

    Minimises the cross-entropy by gradient descent in shuffled batches; an incomplete last batch is left out. mdCNN
    halves the rate when the loss of the *test* data has not fallen for a while. Here the loss of the training data
    decides, so that no test sequence is used.
    """
    with repeatable(seed):
        network = inputs.network(classes)
        parameters, rate = list(network.parameters()), RATE
        train, targets = np.asarray(train), torch.as_tensor(labels)
        batch, best, stalled = min(inputs.batch, len(train)), np.inf, 0
        network.train()
        for _ in range(epochs):
            shuffled, total = train[torch.randperm(len(train)).numpy()], 0.0
            for start in range(0, len(train) - batch + 1, batch):
                chosen = shuffled[start : start + batch]
                loss = torch.nn.functional.cross_entropy(network(inputs(chosen)), targets[chosen])
                slopes = torch.autograd.grad(loss, parameters)
                with torch.no_grad():  # torch.optim loads the compiler, which takes longer than a small training
                    for parameter, slope in zip(parameters, slopes, strict=True):
                        parameter.sub_(slope, alpha=rate)
                total += loss.item()
            stalled = 0 if total < best else stalled + 1
            if stalled >= PATIENCE:
                rate, stalled = rate / 2, 0
            best = min(best, total)
        return network.eval()


@torch.no_grad()
def class_probabilities(network: torch.nn.Module, inputs: ImageInputs | NormalInputs, ids: np.ndarray) -> np.ndarray:
    """(n, classes) f4: the softmax for the sequences `ids`; equal probabilities where it is not finite."""
    with repeatable(0):
        parts = [network(inputs(part)).softmax(dim=1) for part in np.array_split(ids, -(-len(ids) // PREDICTION_BATCH))]
    found = torch.cat(parts)
    even = torch.full_like(found, 1 / found.shape[1])
    return torch.where(found.isfinite().all(dim=1, keepdim=True), found, even).numpy()


def _batches(images, ids):
    return (images[part] for part in np.array_split(ids, -(-len(ids) // PREDICTION_BATCH)))

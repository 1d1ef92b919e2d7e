"""The two networks of T tables 4.7 and 4.8, for the sequence of imprints and the series of normals, and their training.

Where the tables say nothing or cannot be followed, these choices were made. The fully connected layers have 64 and 32
units. The softmax layer has weights of its own: scores bounded by the second layer's tanh would limit a probability
among eight classes to 0.51, and the sum of both networks would follow the weaker one. Batch normalisation works per
channel, not per cell. In table 4.8 kernels of 3 x 3 on one remaining row are 3 frames wide, and pooling by 0.2 is read
as 2. Dropout in the tables is the share that is kept, as in mdCNN. Training is gradient descent whose rate halves when
the loss stops falling (T4.4.8).
"""

from typing import NamedTuple

import numpy as np
import torch

from haptic_glance.deep.device import repeatable

KEPT_HIDDEN = 0.8  # tables 4.7 and 4.8, first fully connected layer
KEPT_CONVOLVED = 0.5  # table 4.8, second convolution
HIDDEN = (64, 32)  # units of the fully connected layers; the tables give none
SMALLEST = 5  # cells per side that the 3D network needs, so that its second kernel fits
SHORTEST = 8  # frames that the 1D network needs: five and three for its kernels, two for its pooling


class ImageNet(torch.nn.Module):
    """The 3D network of T table 4.7: imprints (b, frames, rows, cols) u1 to scores (b, classes) before the softmax.

    The first convolution has a kernel of five frames and a stride of five. Where fewer than three steps remain after
    it, the second kernel is as deep as they are. The table gives the first convolution no activation.
    """

    def __init__(self, frames: int, cells: tuple[int, int], classes: int) -> None:
        super().__init__()
        if min(cells) < SMALLEST:
            raise ValueError(f"the 3D network needs imprints of {SMALLEST} x {SMALLEST} cells or more, got {cells}")
        steps, across = _output_length(frames, 5, 5, 2), [_output_length(count, 5, 2, 2) for count in cells]
        depth = min(3, steps)
        self.conv1 = torch.nn.Conv3d(1, 8, 5, stride=(5, 2, 2), padding=2)
        self.norm = torch.nn.BatchNorm3d(8)
        self.conv2 = torch.nn.Conv3d(8, 16, (depth, 5, 5), padding=(0, 1, 1))
        remaining = (steps - depth + 1) * _output_length(across[0], 5, 1, 1) * _output_length(across[1], 5, 1, 1)
        self.fc1 = torch.nn.Linear(16 * remaining, HIDDEN[0])
        self.drop = torch.nn.Dropout(1 - KEPT_HIDDEN)
        self.fc2 = torch.nn.Linear(*HIDDEN)
        self.scores = torch.nn.Linear(HIDDEN[1], classes)

    def forward(self, images: torch.Tensor) -> torch.Tensor:
        values = self.norm(self.conv1(images[:, None]))
        values = torch.tanh(self.conv2(values)).flatten(1)
        values = self.drop(torch.tanh(self.fc1(values)))
        return self.scores(torch.tanh(self.fc2(values)))


class NormalNet(torch.nn.Module):
    """The 1D network of T table 4.8: normals (b, frames, 3) to scores (b, classes) before the softmax."""

    def __init__(self, frames: int, classes: int) -> None:
        super().__init__()
        if frames < SHORTEST:
            raise ValueError(f"the 1D network needs {SHORTEST} frames or more, got {frames}")
        self.conv1 = torch.nn.Conv1d(3, 32, 5)
        self.norm = torch.nn.BatchNorm1d(32)
        self.conv2 = torch.nn.Conv1d(32, 32, 3)
        self.drop_convolved = torch.nn.Dropout(1 - KEPT_CONVOLVED)
        self.fc1 = torch.nn.Linear(32 * ((frames - 6) // 2), HIDDEN[0])
        self.drop = torch.nn.Dropout(1 - KEPT_HIDDEN)
        self.fc2 = torch.nn.Linear(*HIDDEN)
        self.scores = torch.nn.Linear(HIDDEN[1], classes)

    def forward(self, normals: torch.Tensor) -> torch.Tensor:
        values = self.norm(torch.relu(self.conv1(normals.transpose(1, 2))))
        values = torch.max_pool1d(torch.relu(self.conv2(values)), 2)
        values = self.drop_convolved(values).flatten(1)
        values = self.drop(torch.relu(self.fc1(values)))
        return self.scores(torch.relu(self.fc2(values)))


def _output_length(count, kernel, stride, padding):
    return (count + 2 * padding - kernel) // stride + 1


@torch.no_grad()
def layers(network: torch.nn.Module, *inputs: torch.Tensor) -> list[dict]:
    """Rows of a network's layers in order of execution: layer, kind, output (shape per sample), parameters as value."""
    rows, hooks = [], []
    for name, layer in network.named_children():

        def record(layer, _, values, name=name):
            shape = "x".join(map(str, values.shape[1:]))
            count = sum(p.numel() for p in layer.parameters())
            rows.append({"layer": name, "kind": type(layer).__name__, "output": shape, "value": count})

        hooks.append(layer.register_forward_hook(record))
    network.eval()(*inputs)
    for hook in hooks:
        hook.remove()
    return rows


RATE = 0.05  # initial learning rate: the default of mdCNN, the tool of T4.4.8, which has no momentum
IMAGE_BATCH, NORMAL_BATCH = 10, 16  # sequences per step, T4.4.8
PATIENCE = 3  # epochs without a lower loss, after which the rate halves
HALVINGS = 10  # after which the rate is a thousandth of the first and a training ends: nothing improves any more
PREDICTION_BATCH = 64  # sequences predicted at once


class ImageInputs:
    """Imprints of sequences as input of a network, standardised by the training sequences.

    images (n, frames, rows, cols) u1 are kept as they are; a batch is converted to f4 when it is used.
    """

    batch = IMAGE_BATCH

    def __init__(self, images: np.ndarray, train: np.ndarray) -> None:
        self.images = images
        parts = np.array_split(train, -(-len(train) // PREDICTION_BATCH))
        histogram = np.sum([np.bincount(images[part].ravel(), minlength=256) for part in parts], axis=0)
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
        training = normals[train].astype(np.float64)
        spread = np.maximum(training.std(axis=(0, 1)), 1e-6)
        self.normals = ((normals - training.mean(axis=(0, 1))) / spread).astype(np.float32)

    def network(self, classes: int) -> NormalNet:
        """An untrained network for these series."""
        return NormalNet(self.normals.shape[1], classes)

    def __call__(self, ids: np.ndarray) -> torch.Tensor:
        return torch.from_numpy(self.normals[ids])


class Trained(NamedTuple):
    """A network in evaluation mode; passes: how many trained it; settled: whether its loss had stopped falling."""

    network: ImageNet | NormalNet
    passes: int
    settled: bool


def train_network(
    inputs: ImageInputs | NormalInputs, labels: np.ndarray, train: np.ndarray, classes: int, epochs: int, seed: int
) -> Trained:
    """Trains a network on the sequences `train` (n,) of `inputs` with labels (k,) i8, in at most `epochs` passes.

    Minimises the cross-entropy by gradient descent in shuffled batches; an incomplete last batch is left out. mdCNN
    halves the rate when the loss of the *test* data has not fallen for a while. Here the loss of the training data
    decides, so that no test sequence is used. The training is settled and ends when the rate has halved HALVINGS times.
    """
    with repeatable(seed):
        network = inputs.network(classes)
        parameters, rate = list(network.parameters()), RATE
        train, targets = np.asarray(train), torch.as_tensor(labels)
        batch, best, stalled, passes = min(inputs.batch, len(train)), np.inf, 0, 0
        network.train()
        while passes < epochs and rate > RATE / 2**HALVINGS:
            shuffled, total = train[torch.randperm(len(train)).numpy()], 0.0
            for start in range(0, len(train) - batch + 1, batch):
                ids = shuffled[start : start + batch]
                loss = torch.nn.functional.cross_entropy(network(inputs(ids)), targets[ids])
                slopes = torch.autograd.grad(loss, parameters)
                with torch.no_grad():  # torch.optim loads the compiler, which takes longer than a small training
                    for parameter, slope in zip(parameters, slopes, strict=True):
                        parameter.sub_(slope, alpha=rate)
                total += loss.item()
            stalled = 0 if total < best else stalled + 1
            if stalled >= PATIENCE:
                rate, stalled = rate / 2, 0
            best, passes = min(best, total), passes + 1
        return Trained(network.eval(), passes, rate <= RATE / 2**HALVINGS)


@torch.no_grad()
def class_probabilities(network: torch.nn.Module, inputs: ImageInputs | NormalInputs, ids: np.ndarray) -> np.ndarray:
    """(n, classes) f4: the softmax for the sequences `ids`; equal probabilities where it is not finite."""
    with repeatable(0):
        parts = [network(inputs(part)).softmax(dim=1) for part in np.array_split(ids, -(-len(ids) // PREDICTION_BATCH))]
    scores = torch.cat(parts)
    even = torch.full_like(scores, 1 / scores.shape[1])
    return torch.where(scores.isfinite().all(dim=1, keepdim=True), scores, even).numpy()

"""Training of the two networks: plain gradient descent whose rate halves when the loss stops falling (T4.4.8)."""

import numpy as np
import torch

from stages.kit.repeatable import repeatable

from .networks import ImageNet, NormalNet

RATE = 0.05  # first learning rate: the default of mdCNN, the tool of T4.4.8, which has no momentum either
IMAGE_BATCH, NORMAL_BATCH = 10, 16  # sequences a step, T4.4.8
PATIENCE = 3  # passes without a new least loss after which the rate halves
ANSWERED = 64  # sequences answered at once


class Images:
    """The films of a set of sequences as a network takes them, standardised by those it trains on.

    images (n, frames, rows, cols) u1 stay as they are; a batch becomes f4 when it is asked for.
    """

    batch = IMAGE_BATCH

    def __init__(self, images, train):
        self.images = images
        levels = sum(np.bincount(part.ravel(), minlength=256) for part in _parts(images, train))
        share = levels / levels.sum()
        self.mean = float(share @ np.arange(256))
        self.std = max(float(np.sqrt(share @ (np.arange(256) - self.mean) ** 2)), 1.0)

    def network(self, classes):
        """An untrained network for these films."""
        return ImageNet(self.images.shape[1], self.images.shape[2:], classes)

    def __call__(self, ids):
        return (torch.from_numpy(self.images[ids]).float() - self.mean) / self.std


class Normals:
    """The series of normals (n, frames, 3) f4, each coordinate standardised by those trained on (table 4.8)."""

    batch = NORMAL_BATCH

    def __init__(self, normals, train):
        chosen = normals[train].astype(np.float64)
        spread = np.maximum(chosen.std(axis=(0, 1)), 1e-6)
        self.normals = ((normals - chosen.mean(axis=(0, 1))) / spread).astype(np.float32)

    def network(self, classes):
        """An untrained network for these series."""
        return NormalNet(self.normals.shape[1], classes)

    def __call__(self, ids):
        return torch.from_numpy(self.normals[ids])


def learn(inputs, labels, train, classes, epochs, seed):
    """A network, in evaluation mode, trained on the sequences `train` (n,) of `inputs` with labels (k,) i8.

    Minimises the cross-entropy by gradient descent in shuffled batches; an odd rest below a batch waits for the next
    pass. mdCNN halves the rate when the loss of the *test* data has not fallen for a while; here that of the training
    data decides, so that no test sequence is looked at.
    """
    with repeatable(seed):
        network = inputs.network(classes)
        optimiser = torch.optim.SGD(network.parameters(), lr=RATE)
        train, labels = np.asarray(train), torch.as_tensor(labels)
        batch, best, waited = min(inputs.batch, len(train)), np.inf, 0
        network.train()
        for _ in range(epochs):
            shuffled, total = train[torch.randperm(len(train)).numpy()], 0.0
            for start in range(0, len(train) - batch + 1, batch):
                chosen = shuffled[start : start + batch]
                loss = torch.nn.functional.cross_entropy(network(inputs(chosen)), labels[chosen])
                optimiser.zero_grad()
                loss.backward()
                optimiser.step()
                total += loss.item()
            waited = 0 if total < best else waited + 1
            if waited >= PATIENCE:
                optimiser.param_groups[0]["lr"], waited = optimiser.param_groups[0]["lr"] / 2, 0
            best = min(best, total)
        return network.eval()


@torch.no_grad()
def probabilities(network, inputs, ids):
    """(n, classes) f4: the softmax for the sequences `ids`; one that is not finite says nothing (all classes alike)."""
    with repeatable(0):
        parts = [network(inputs(part)).softmax(dim=1) for part in np.array_split(ids, -(-len(ids) // ANSWERED))]
    found = torch.cat(parts)
    even = torch.full_like(found, 1 / found.shape[1])
    return torch.where(found.isfinite().all(dim=1, keepdim=True), found, even).numpy()


def _parts(images, ids):
    return (images[part] for part in np.array_split(ids, -(-len(ids) // ANSWERED)))

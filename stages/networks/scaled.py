"""A head on cached features that are scaled first."""

import torch

DEAD = 1e-6  # of the largest deviation: a feature that varies less is not scaled up


class Scaled(torch.nn.Module):
    """A linear head (b, width) -> (b, classes) behind features of mean 0 and deviation 1 over what it learns from.

    With them one set of learning rates serves every network: the features of an untrained one differ from image to
    image by a hundredth of their size, and a head on them as they are would learn next to nothing in ten passes. A
    linear head on scaled features is one on the features themselves, with other numbers.
    """

    def __init__(self, head, width):
        super().__init__()
        self.head = head
        self.register_buffer("mean", torch.zeros(width))
        self.register_buffer("deviation", torch.ones(width))

    def forward(self, features):
        return self.head((features - self.mean) / self.deviation)

    @torch.no_grad()
    def fit(self, features):
        """Takes mean and deviation of features (n, width)."""
        spread = features.std(dim=0, correction=0)
        self.mean.copy_(features.mean(dim=0))
        self.deviation.copy_(torch.where(spread > DEAD * spread.max(), spread, 1))

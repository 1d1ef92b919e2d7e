"""A linear head on standardised features."""

import torch

DEAD = 1e-6  # of the largest deviation: features that vary less are not scaled


class ScaledHead(torch.nn.Module):
    """A linear head (b, width) -> (b, classes) on features of mean 0 and deviation 1 over the training touches.

    Standardised features let one set of learning rates serve every network: those of an untrained network differ
    between images by a hundredth of their size, and a head on them would learn next to nothing in ten epochs. A linear
    head on standardised features is equivalent to one on the features themselves.
    """

    mean: torch.Tensor
    deviation: torch.Tensor

    def __init__(self, head: torch.nn.Module, width: int) -> None:
        super().__init__()
        self.head = head
        self.register_buffer("mean", torch.zeros(width))
        self.register_buffer("deviation", torch.ones(width))

    def forward(self, features: torch.Tensor) -> torch.Tensor:
        return self.head((features - self.mean) / self.deviation)

    @torch.no_grad()
    def fit(self, features: torch.Tensor) -> None:
        """Sets mean and deviation to those of features (n, width)."""
        spread = features.std(dim=0, correction=0)
        self.mean.copy_(features.mean(dim=0))
        self.deviation.copy_(torch.where(spread > DEAD * spread.max(), spread, 1))

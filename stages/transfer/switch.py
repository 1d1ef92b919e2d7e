"""The Switch-Scale layer of the hybrid network: a stream with an empty input is multiplied by zero (T5.5)."""

import torch


def present(images: torch.Tensor) -> torch.Tensor:
    """(b,) boolean: whether a sense is present, by its channels. images: (b, 3, h, w), any scale.

    In the thesis a stream is absent when the variance of each of its three channels is zero. So any constant channels
    count, black or white, before a normalisation or after it. The largest and smallest values are compared, since a
    variance in floating point may not be exactly zero.
    """
    return (images.amax(dim=(2, 3)) != images.amin(dim=(2, 3))).any(dim=1)


class Switch(torch.nn.Module):
    """Activations (b, c, i, j), set to zero where the images (b, 3, h, w) they come from are absent."""

    def forward(self, images: torch.Tensor, activations: torch.Tensor) -> torch.Tensor:
        return activations * present(images).to(activations.dtype)[:, None, None, None]

"""The Switch-Scale layer of the hybrid network: a stream with an empty input is multiplied by zero (T5.5)."""

import torch


def present(images):
    """(b,) boolean: the sense whose channels these are has something to say. images: (b, 3, h, w), any scale.

    The thesis calls a stream absent when the variance of each of its three channels is zero, so not only zeros: any
    constant channels count, black or white, before a normalisation or after it. A variance is zero where the largest
    value is the smallest, and that is what is compared, since a sum of squares in floating point may miss its zero.
    """
    return (images.amax(dim=(2, 3)) != images.amin(dim=(2, 3))).any(dim=1)


class Switch(torch.nn.Module):
    """Activations (b, c, i, j) times 1 where the images (b, 3, h, w) they came from are present, times 0 elsewhere."""

    def forward(self, images, activations):
        return activations * present(images).to(activations.dtype)[:, None, None, None]

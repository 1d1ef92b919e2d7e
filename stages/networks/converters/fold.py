"""Another convention for the colours of the input, moved into the first layers of a network."""

import torch

from ..images import MEAN, STD


def fold_input(state, convolution, normalisation, epsilon, scale, shift):
    """The state with its first convolution and normalisation layer changed to take inputs as ours are.

    convolution, normalisation: their names in the state; epsilon: what the normalisation adds to its variance. The
    published ones take scale * image + shift a colour, where image holds 0..1 red, green and blue; scale, shift: three
    values or one. The kernels keep their magnitude, so that a training moves them as it would the published ones: the
    normalisation takes up the factor. Exact but at the border: there our padding is ImageNet's mean colour, and theirs
    was what their convention calls zero.
    """
    scale, shift = torch.as_tensor(scale), torch.as_tensor(shift)
    gain = (scale * torch.tensor(STD)).expand(3)
    constant = (scale * torch.tensor(MEAN) + shift).expand(3)
    kernel = state[f"{convolution}.weight"]
    mean, variance = state[f"{normalisation}.running_mean"], state[f"{normalisation}.running_var"]
    factor = gain.mean()
    return state | {
        f"{convolution}.weight": kernel * (gain / factor).view(3, 1, 1),
        f"{normalisation}.running_mean": (mean - kernel.sum(dim=(2, 3)) @ constant) / factor,
        f"{normalisation}.running_var": (variance + epsilon) / factor**2 - epsilon,
    }

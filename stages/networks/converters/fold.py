"""Another convention for the colours of the input, folded into the first layers of a network."""

from collections.abc import Sequence

import torch

from ..images import MEAN, STD


def fold_input(
    state: dict[str, torch.Tensor],
    convolution: str,
    normalisation: str,
    epsilon: float,
    scale: float | Sequence[float],
    shift: float | Sequence[float] | torch.Tensor,
) -> dict[str, torch.Tensor]:
    """The state with its first convolution and normalisation changed to take images normalised as in stages.networks.

    convolution, normalisation: their names in the state; epsilon: what the normalisation adds to its variance. The
    published network takes scale * image + shift per colour, where image holds red, green and blue in 0..1; scale,
    shift: three values or one. The kernels keep their magnitude, so that training changes them as it would the
    published ones; the normalisation absorbs the factor. Exact except at the border, where the padding is ImageNet's
    mean colour here and was zero in the published convention.
    """
    gain = (torch.as_tensor(scale) * torch.tensor(STD)).expand(3)
    constant = (torch.as_tensor(scale) * torch.tensor(MEAN) + torch.as_tensor(shift)).expand(3)
    kernel = state[f"{convolution}.weight"]
    mean, variance = state[f"{normalisation}.running_mean"], state[f"{normalisation}.running_var"]
    factor = gain.mean()
    return state | {
        f"{convolution}.weight": kernel * (gain / factor).view(3, 1, 1),
        f"{normalisation}.running_mean": (mean - kernel.sum(dim=(2, 3)) @ constant) / factor,
        f"{normalisation}.running_var": (variance + epsilon) / factor**2 - epsilon,
    }

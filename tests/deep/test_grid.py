"""Where the cells of the last maps lie: held against networks that hand on the middle of every kernel alone."""

import numpy as np
import pytest
import torch

from haptic_glance.deep.network import NETWORKS, build
from haptic_glance.deep.resize import GRIDS, cell_positions

SIZE = 96


def middles(network):
    """The network with nothing but the middle tap of each kernel, and pools that average: its cells look at points."""
    for name, layer in list(network.named_modules()):
        if isinstance(layer, torch.nn.Conv2d):
            layer.weight.data.zero_()
            row, column = (size // 2 for size in layer.kernel_size)
            layer.weight.data[..., row, column] = 1 / layer.weight.shape[1]
            if layer.bias is not None:
                layer.bias.data.zero_()
        if isinstance(layer, torch.nn.MaxPool2d):
            parent = network.get_submodule(name.rpartition(".")[0])
            own = torch.nn.AvgPool2d(layer.kernel_size, layer.stride, layer.padding, layer.ceil_mode)
            setattr(parent, name.rpartition(".")[2], own)
    return network


@pytest.mark.slow
@pytest.mark.parametrize("name", NETWORKS)
def test_a_cell_lies_where_it_looks(name):
    network = middles(build(name, 2, "random", 0)).requires_grad_(False)
    image = torch.full((1, 3, SIZE, SIZE), 1e-3, requires_grad=True)  # far from what ReLU6 cuts
    maps = network.convolutions(image)
    cell = maps.shape[2] // 2
    maps[0, :, cell, cell].sum().backward()
    felt = image.grad[0].abs().sum(dim=0).numpy()
    row = (felt.sum(axis=1) * np.arange(SIZE)).sum() / felt.sum()
    stride, first = GRIDS[name]
    assert row == pytest.approx(first + stride * cell, abs=0.6)


def test_pixels_beyond_the_outer_cells_belong_to_them():
    found = cell_positions("mobilenet_v2", 224, 7)
    assert found[0] == 0 and found[32] == 1 and found[208] == 6 and found[-1] == 6


def test_an_unknown_network_is_named():
    with pytest.raises(ValueError, match="unknown network 'lenet'"):
        cell_positions("lenet", 224, 7)

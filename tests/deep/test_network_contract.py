"""Every entry of NETWORKS: size and cost of the papers, a grid of last maps, usable untrained, its own weights."""

from copy import deepcopy

import numpy as np
import pytest
import torch

from haptic_glance.deep import device as costs
from haptic_glance.deep.architectures import restore
from haptic_glance.deep.device import cost
from haptic_glance.deep.network import NETWORKS, SMALLEST, build, recalibrate
from haptic_glance.deep.resize import GRIDS

pytestmark = pytest.mark.slow

SIDE = {"alexnet": 13, "vgg16": 14}  # of the last maps at 224 pixels; 7 for the others
PUBLISHED = {  # million parameters, giga multiply-adds, as torchvision and the papers give them, with 1000 classes
    "googlenet": (6.62, 1.498),
    "resnet50": (25.56, 3.86),  # the paper's strides; torchvision's need 4.09
    "resnet101": (44.55, 7.801),
    "mobilenet_v2": (3.50, 0.301),
    "efficientnet_lite0": (4.65, 0.385),  # as counted; its publishers say 0.407, with more than the convolutions
}
CONVOLUTIONS = {"alexnet": (2.47, 0.656), "vgg16": (14.71, 15.347)}  # kernel areas times maps


@pytest.fixture(params=list(NETWORKS), scope="module")
def untrained(request):
    return request.param, build(request.param, 1000, "random", 0)


@torch.no_grad()
def test_size_and_cost_are_those_of_the_papers_and_the_last_maps_keep_a_grid(untrained, monkeypatch):
    name, network = untrained
    monkeypatch.setattr(costs, "RUNS", 1)
    monkeypatch.setattr(costs, "WARM_UPS", 0)
    costs_of_one = cost(network, 224)
    million, giga = PUBLISHED.get(name) or CONVOLUTIONS[name]
    head = 0 if name in PUBLISHED else network.head[1].weight.numel()
    assert costs_of_one["parameters"] - head == pytest.approx(million * 1e6, rel=0.005)
    assert costs_of_one["operations"] - head == pytest.approx(giga * 1e9, rel=0.005)
    assert costs_of_one["milliseconds"] > 0
    side = max(SIDE.get(name, 7) * 64 // 224, 2)
    assert network.convolutions(torch.zeros(1, 3, 64, 64)).shape[2:] == (side, side)
    assert network(torch.zeros(1, 3, SMALLEST, SMALLEST)).shape == (1, 1000)


def momenta_of(network):
    return [layer.momentum for layer in network.modules() if isinstance(layer, torch.nn.BatchNorm2d)]


@torch.no_grad()
def test_untrained_networks_tell_images_apart_once_settled(untrained):
    network = deepcopy(untrained[1])
    before, momenta = [value.clone() for value in network.parameters()], momenta_of(network)
    images = torch.randn(8, 3, 64, 64, generator=torch.Generator().manual_seed(0))
    images *= torch.linspace(0.2, 2, 8).view(8, 1, 1, 1)
    recalibrate(network, lambda ids: images[ids], np.arange(8), batch=5)
    features = network.features(images)
    assert 1e-2 < features.std(dim=0).mean() < 1e2
    assert features.abs().mean() < 1e2
    assert all(torch.equal(a, b) for a, b in zip(before, network.parameters(), strict=True))
    assert momenta_of(network) == momenta


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
            average = torch.nn.AvgPool2d(layer.kernel_size, layer.stride, layer.padding, layer.ceil_mode)
            setattr(parent, name.rpartition(".")[2], average)
    return network


def test_a_cell_lies_where_it_looks(untrained):
    name, network = untrained
    size, network = 96, middles(deepcopy(network)).requires_grad_(False)
    image = torch.full((1, 3, size, size), 1e-3, requires_grad=True)  # far from what ReLU6 cuts
    maps = network.convolutions(image)
    cell = maps.shape[2] // 2
    maps[0, :, cell, cell].sum().backward()
    seen = image.grad[0].abs().sum(dim=(0, 2)).numpy()
    stride, first = GRIDS[name]
    assert (seen * np.arange(size)).sum() / seen.sum() == pytest.approx(first + stride * cell, abs=0.6)


def test_the_seed_decides_the_weights_and_only_its_own_come_back(untrained):
    name, network = untrained
    state = network.state_dict()
    torch.manual_seed(3)
    expected = torch.rand(1)
    torch.manual_seed(3)
    again = build(name, 1000, "random", 0)
    assert torch.equal(torch.rand(1), expected)  # the caller's numbers stay
    assert all(torch.equal(value, state[key]) for key, value in again.state_dict().items())
    restore(again, {key: value.numpy() for key, value in state.items()}, name)
    first = next(iter(state))
    for wrong, reason in (
        ({key: value for key, value in state.items() if key != first}, f"weights of {name}: 1 missing, first {first}"),
        (state | {first: state[first][:1]}, f"weights of {name}: {first} is "),
        (state | {first: state[first] * np.nan}, f"weights of {name} are damaged: {first} holds"),
    ):
        with pytest.raises(ValueError, match=reason):
            restore(again, wrong, name)
    assert all(torch.equal(value, state[key]) for key, value in again.state_dict().items())
    for shape in ((3, 64, 64), (1, 1, 64, 64), (1, 3, 16, 64)):
        with pytest.raises(ValueError, match="images must have shape"):
            network(torch.zeros(shape))

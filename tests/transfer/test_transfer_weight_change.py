"""How much training has altered each convolution."""

import copy

import pytest
import torch

from haptic_glance.deep.network import Network, build
from stages.transfer.export import network_parts, weight_changes


@pytest.fixture
def network():
    layers = [torch.nn.Conv2d(3, 8, 3), torch.nn.ReLU(), torch.nn.Conv2d(8, 8, 3, groups=8)]
    return Network(torch.nn.Sequential(*layers), 8, 2, dropout=0.0)


def test_a_network_has_not_changed_from_itself(network):
    assert weight_changes(network, copy.deepcopy(network)) == {"convolutions.0": 0.0, "convolutions.2": 0.0}


def test_scale_and_shift_of_a_layers_weights_are_no_change(network):
    other = copy.deepcopy(network)
    with torch.no_grad():
        other.convolutions[0].weight.mul_(3).add_(0.5)
    assert weight_changes(network, other)["convolutions.0"] < 1e-12


def test_the_change_is_the_mean_squared_difference_of_the_scaled_weights(network):
    other = copy.deepcopy(network)
    with torch.no_grad():
        for model, values in ((network, [0.0, 1.0, 2.0, 4.0]), (other, [0.0, 1.0, 1.0, 2.0])):
            model.convolutions[2].weight.copy_(torch.tensor(values * 18).view(8, 1, 3, 3))
    assert weight_changes(network, other)["convolutions.2"] == pytest.approx((0.25**2 + 0 + 0 + 0) / 4)


def test_weights_that_are_all_alike_have_not_changed(network):
    with torch.no_grad():
        network.convolutions[0].weight.fill_(0.1)
    assert weight_changes(network, network)["convolutions.0"] == 0.0


def test_convolutions_of_mobilenet_v2_belong_to_matlabs_blocks(network):
    found = list(dict.fromkeys(network_parts(build("mobilenet_v2", 2, "random", 0)).values()))
    assert found == ["Conv1", "expanded_conv", *(f"block_{i}" for i in range(1, 17)), "Conv_1"]
    assert list(network_parts(network).values()) == ["conv_1", "conv_2"]

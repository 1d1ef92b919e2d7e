"""Matlab's 154 layers of MobileNetV2 and the modules that they are."""

import pytest
import torch

from haptic_glance.deep.modes import LAYERS, frozen_modules, layers, parse_range
from haptic_glance.deep.network import Network, build

pytestmark = pytest.mark.slow


@pytest.fixture(scope="module")
def network():
    return build("mobilenet_v2", 2, "random", 0)


def with_parameters(network):
    return {name for name, module in network.named_modules() if list(module.parameters(recurse=False))}


def test_every_layer_has_one_number_and_every_parameter_one_layer(network):
    assert [layer.number for layer in layers()] == list(range(1, LAYERS + 1))
    assert len({layer.name for layer in layers()}) == LAYERS
    modules = [layer.module for layer in layers() if layer.module]
    assert len(set(modules)) == len(modules)
    assert with_parameters(network) <= set(modules) <= dict(network.named_modules()).keys()


def test_the_numbers_that_table_5_6_cuts_at_are_those_of_matlab():
    named = {layer.number: layer.name for layer in layers()}
    ends = {1: "input_1", 10: "block_1_expand", 16: "block_1_project", 17: "block_1_project_BN", 18: "block_2_expand"}
    ends |= {134: "block_15_depthwise", 138: "block_15_project_BN", 139: "block_15_add", 140: "block_16_expand"}
    ends |= {144: "block_16_depthwise_BN", 150: "out_relu", 151: "global_average_pooling2d_1", 152: "Logits"}
    assert {number: named[number] for number in ends} == ends


def test_layers_are_of_the_kind_that_their_names_say(network):
    kinds = {"BN": torch.nn.BatchNorm2d, "bn": torch.nn.BatchNorm2d, "relu": torch.nn.ReLU6}
    kinds |= dict.fromkeys(("expand", "depthwise", "project"), torch.nn.Conv2d)
    named = [(layer, layer.name.rpartition("_")[2]) for layer in layers()]
    named = [(network.get_submodule(layer.module), end) for layer, end in named if "_" in layer.name and end in kinds]
    assert len(named) == 136
    for module, end in named:
        assert isinstance(module, kinds[end]) and (end != "depthwise" or module.groups == module.in_channels)
    sums = {int(layer.name.split("_")[1]) for layer in layers() if layer.name.endswith("_add")}
    assert sums == {i for i in range(1, 17) if network.convolutions[i + 1].use_res_connect}


@pytest.mark.parametrize(
    ("layer_range", "first", "last"),
    [
        ("18:139", "convolutions.3.conv.0.0", "convolutions.16.conv.3"),
        ("16:138", "convolutions.2.conv.2", "convolutions.16.conv.3"),
        ("10:150", "convolutions.2.conv.0.0", "convolutions.18.1"),
    ],
)
def test_a_range_freezes_what_lies_within_and_nothing_else(network, layer_range, first, last):
    order = [layer.module for layer in layers() if layer.module in with_parameters(network)]
    assert frozen_modules(layer_range, network) == order[order.index(first) : order.index(last) + 1]


@pytest.mark.parametrize(
    ("layer_range", "reason"),
    [("139:18", "first before last"), ("0:9", "1 to 154"), ("18-139", "not a range")],
)
def test_ranges_that_cannot_be_are_refused(layer_range, reason):
    with pytest.raises(ValueError, match=reason):
        parse_range(layer_range)


def test_the_classifier_must_learn_and_other_networks_have_no_ranges(network):
    with pytest.raises(ValueError, match="must be trained"):
        frozen_modules("18:154", network)
    other = Network(torch.nn.Sequential(torch.nn.Conv2d(3, 8, 3)), 8, 2, dropout=0.0)
    with pytest.raises(ValueError, match="another network"):
        frozen_modules("18:139", other)

"""Every network ends at its last maps, starts usable, and refuses what is not its own."""

import sys
from copy import deepcopy
from types import SimpleNamespace

import numpy as np
import pytest
import torch

from haptic_glance.base.files import sha256
from haptic_glance.deep import architectures
from haptic_glance.deep import device as costs
from haptic_glance.deep.architectures import restore, torchvision
from haptic_glance.deep.converters import convert_googlenet
from haptic_glance.deep.device import cost
from haptic_glance.deep.network import NETWORKS, SMALLEST, ScaledHead, build, count_parameters, recalibrate
from haptic_glance.deep.resize import GRIDS, cell_positions
from haptic_glance.deep.weights import available_weights

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


def test_pixels_beyond_the_outer_cells_belong_to_them():
    cells = cell_positions("mobilenet_v2", 224, 7)
    assert cells[0] == 0 and cells[32] == 1 and cells[208] == 6 and cells[-1] == 6
    with pytest.raises(ValueError, match="unknown network 'lenet'"):
        cell_positions("lenet", 224, 7)


def test_the_seed_fixes_everything_and_the_callers_numbers_stay():
    torch.manual_seed(3)
    expected = torch.rand(1)
    torch.manual_seed(3)
    first, again, other = (build("alexnet", 3, "random", seed).state_dict() for seed in (0, 0, 1))
    assert torch.equal(torch.rand(1), expected)
    assert all(torch.equal(first[key], again[key]) for key in first)
    assert not torch.equal(first["convolutions.0.weight"], other["convolutions.0.weight"])


def test_resnet50_halves_its_maps_where_its_weights_were_trained_to():
    for source, expected in (("package", 2), ("download", 1)):
        block = build("resnet50", 2, "random", 0, source).convolutions.layer2[0]
        assert (block.conv1.stride[0], block.conv2.stride[0]) == (expected, 3 - expected)


@pytest.mark.parametrize(
    ("change", "reason"),
    [
        ({"name": "lenet"}, "unknown network 'lenet', known: alexnet"),
        ({"weights": "mars"}, "unknown weights"),
        ({"source": "mail"}, "unknown source"),
        ({"classes": 1}, "two classes or more, got 1"),
    ],
)
def test_unknown_names_and_one_class_are_refused(change, reason):
    with pytest.raises(ValueError, match=reason):
        build(**({"name": "mobilenet_v2", "classes": 2, "weights": "random", "seed": 0} | change))


def test_images_that_a_network_cannot_take_are_refused():
    network = build("alexnet", 2, "random", 0)
    for shape in ((3, 64, 64), (1, 1, 64, 64), (1, 3, 16, 64)):
        with pytest.raises(ValueError, match="images must have shape"):
            network(torch.zeros(shape))
    with pytest.raises(ValueError, match="two touches or more, got 1"):
        recalibrate(build("mobilenet_v2", 2, "random", 0), lambda ids: torch.zeros(len(ids), 3, 32, 32), [0])


def test_a_checkpoint_comes_back_from_arrays_and_that_of_another_network_is_refused_by_name():
    network, other = build("mobilenet_v2", 3, "random", 0), build("mobilenet_v2", 3, "random", 1)
    restore(network, {key: value.numpy() for key, value in other.state_dict().items()}, "mobilenet_v2")
    before = [value.clone() for value in network.parameters()]
    assert all(torch.equal(a, b) for a, b in zip(before, other.parameters(), strict=True))
    for state, reason in (
        (build("alexnet", 3, "random", 0).state_dict(), "weights of mobilenet_v2: .*missing, first .*unexpected, f"),
        (build("mobilenet_v2", 4, "random", 0).state_dict(), r"head\.1\.weight is \(4, 1280\) instead of \(3, 1280\)"),
        (other.state_dict() | {"head.1.bias": torch.tensor([0.0, float("nan"), 0.0])},
         "damaged: head.1.bias holds values that are not finite"),
        (7, "not weights of mobilenet_v2"),
    ):  # fmt: skip
        with pytest.raises(ValueError, match=reason):
            restore(network, state, "mobilenet_v2")
    assert all(torch.equal(a, b) for a, b in zip(before, network.parameters(), strict=True))


def test_cost_leaves_the_network_and_the_threads_as_they_were():
    network, threads = build("alexnet", 2, "random", 0).train(), torch.get_num_threads()
    assert cost(network, 64)["parameters"] == count_parameters(network)
    assert network.training and torch.get_num_threads() == threads
    with pytest.raises(ValueError, match="1 pixel or more"):
        cost(network, 0)
    with pytest.raises(ValueError, match="cannot take an image of 3 x 64 x 64"):
        cost(torch.nn.Conv2d(6, 1, 3), 64)


def test_downloaded_weights_take_the_same_path(monkeypatch, tmp_path):
    urls = {}
    monkeypatch.setattr(torch.hub, "get_dir", lambda: str(tmp_path))
    monkeypatch.setattr(torchvision.models, "get_weight", lambda name: SimpleNamespace(url=urls[name]))
    (tmp_path / "checkpoints").mkdir()
    for name, published, kind in (("alexnet", "AlexNet", "convolutions"), ("googlenet", "GoogLeNet", "complete")):
        options = {"init_weights": False} if name == "googlenet" else {}
        whole = torchvision.models.get_model(name, **options)
        torch.save(whole.state_dict(), tmp_path / "saved")
        file = f"{name}-{sha256(tmp_path / 'saved')[:8]}.pth"
        (tmp_path / "saved").rename(tmp_path / "checkpoints" / file)
        urls[f"{published}_Weights.IMAGENET1K_V1"] = f"https://example.org/{file}"
        network = build(name, 2, "imagenet", 0, "download")
        weights = [parameter for parameter in whole.parameters() if parameter.ndim == 4][1]
        assert any(torch.equal(weights, parameter) for parameter in network.parameters())
        assert available_weights(name, "download") == kind


def test_googlenets_own_colours_move_into_its_first_layer():
    with torch.random.fork_rng(devices=[]), torch.no_grad():
        torch.manual_seed(0)
        theirs = torchvision.models.googlenet(init_weights=False, transform_input=True).eval()
        theirs.conv1.bn.running_mean.normal_()
        theirs.conv1.bn.running_var.uniform_(0.5, 2)
        ours = torchvision.models.googlenet(init_weights=False, aux_logits=False, transform_input=False).eval()
        ours.load_state_dict(convert_googlenet(theirs.state_dict()))
        images = torch.randn(2, 3, 48, 48)
        expected = theirs.conv1(theirs._transform_input(images))
        inside = (..., slice(2, -2), slice(2, -2))  # the kernel of 7 reaches the padding outside
        assert torch.allclose(ours.conv1(images)[inside], expected[inside], atol=1e-5)


def test_features_get_mean_zero_and_deviation_one_whatever_their_size():
    features = torch.tensor([[1.0, 10.0, 7.0], [3.0, 30.0, 7.0]])  # the last never changes
    scaled = ScaledHead(torch.nn.Identity(), 3)
    scaled.fit(features)
    assert torch.allclose(scaled(features), torch.tensor([[-1.0, -1.0, 0.0], [1.0, 1.0, 0.0]]))


def test_torchvisions_schemas_are_declared_after_the_known_failure_only_and_half_modules_dropped(monkeypatch):
    calls, modules = [], {"torchvision": 1, "torchvision.extension": 1, "torchvision_other": 1, "sys": sys}

    def half_import(name):
        calls.append(name)
        if len(calls) == 1:
            raise RuntimeError("operator torchvision::nms does not exist")
        return "second"

    class Library:
        def __init__(self, namespace, kind):
            self.made = [namespace, kind]

        def define(self, schema):
            self.made.append(schema.partition("(")[0])

    monkeypatch.setattr(architectures, "_declared", [])
    monkeypatch.setattr(architectures.sys, "modules", modules)
    monkeypatch.setattr(architectures.importlib, "import_module", half_import)
    monkeypatch.setattr(torch.library, "Library", Library)
    assert architectures.load() == "second"
    assert set(modules) == {"torchvision_other", "sys"}
    assert architectures._declared.pop().made == ["torchvision", "FRAGMENT", "nms", "qnms"]
    assert architectures.load() == "second" and not architectures._declared  # nothing where the import works


def test_another_failure_of_torchvision_is_told_with_its_remedy(monkeypatch):
    def broken(name):
        raise RuntimeError("libcudart is too old")

    monkeypatch.setattr(architectures, "_declared", [])
    monkeypatch.setattr(architectures.importlib, "import_module", broken)
    with pytest.raises(ImportError, match="libcudart is too old.*constraints.txt"):
        architectures.load()

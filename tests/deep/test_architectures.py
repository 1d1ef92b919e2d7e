"""Every network ends at its last maps, starts usable, and refuses what is not its own."""

from types import SimpleNamespace

import numpy as np
import pytest
import torch

from haptic_glance.base.files import sha256
from haptic_glance.deep import device as costs
from haptic_glance.deep.architectures import restore, torchvision
from haptic_glance.deep.converters import convert_googlenet
from haptic_glance.deep.device import cost
from haptic_glance.deep.network import NETWORKS, SMALLEST, build, count_parameters, imagenet_classifier, recalibrate
from haptic_glance.deep.weights import available_weights

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


@pytest.mark.slow
def test_size_and_cost_are_those_of_the_papers(untrained, monkeypatch):
    name, network = untrained
    monkeypatch.setattr(costs, "RUNS", 1)
    monkeypatch.setattr(costs, "WARM_UPS", 0)
    found = cost(network, 224)
    million, giga = PUBLISHED.get(name) or CONVOLUTIONS[name]
    head = 0 if name in PUBLISHED else network.head[1].weight.numel()
    assert found["parameters"] - head == pytest.approx(million * 1e6, rel=0.005)
    assert found["operations"] - head == pytest.approx(giga * 1e9, rel=0.005)
    assert found["milliseconds"] > 0


@pytest.mark.slow
def test_last_maps_keep_a_grid_to_look_at(untrained):
    name, network = untrained
    side = SIDE.get(name, 7) * 64 // 224
    with torch.no_grad():
        assert network.convolutions(torch.zeros(1, 3, 64, 64)).shape[2:] == (max(side, 2),) * 2
        assert network(torch.zeros(1, 3, SMALLEST, SMALLEST)).shape == (1, 1000)


@pytest.mark.slow
def test_untrained_networks_tell_images_apart_once_settled(untrained):
    _, network = untrained
    images = torch.randn(8, 3, 64, 64, generator=torch.Generator().manual_seed(0))
    images *= torch.linspace(0.2, 2, 8).view(8, 1, 1, 1)
    recalibrate(network, lambda ids: images[ids], np.arange(8))
    with torch.no_grad():
        features = network.features(images)
    assert 1e-2 < features.std(dim=0).mean() < 1e2
    assert features.abs().mean() < 1e2


def test_the_seed_fixes_everything_and_the_callers_numbers_stay():
    torch.manual_seed(3)
    expected = torch.rand(1)
    torch.manual_seed(3)
    first, again, other = (build("alexnet", 3, "random", seed).state_dict() for seed in (0, 0, 1))
    assert torch.equal(torch.rand(1), expected)
    assert all(torch.equal(first[key], again[key]) for key in first)
    assert not torch.equal(first["convolutions.0.weight"], other["convolutions.0.weight"])


@pytest.mark.slow
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


@pytest.mark.parametrize("shape", [(3, 64, 64), (1, 1, 64, 64), (1, 3, 16, 64)])
def test_images_of_another_shape_are_refused(shape):
    with pytest.raises(ValueError, match="images must have shape"):
        build("alexnet", 2, "random", 0)(torch.zeros(shape))


def test_statistics_of_one_image_are_refused():
    with pytest.raises(ValueError, match="two touches or more, got 1"):
        recalibrate(build("mobilenet_v2", 2, "random", 0), lambda ids: torch.zeros(len(ids), 3, 32, 32), [0])


def test_a_checkpoint_comes_back_from_arrays_as_from_tensors():
    first, second = build("mobilenet_v2", 3, "random", 0), build("mobilenet_v2", 3, "random", 1)
    restore(second, {key: value.numpy() for key, value in first.state_dict().items()}, "mobilenet_v2")
    assert all(torch.equal(a, b) for a, b in zip(first.parameters(), second.parameters(), strict=True))


def test_a_checkpoint_of_another_network_is_refused_by_name():
    network = build("mobilenet_v2", 3, "random", 0)
    before = network.head[1].weight.clone()
    with pytest.raises(ValueError, match=r"not weights of mobilenet_v2: .*missing, first .*unexpected, first"):
        restore(network, build("alexnet", 3, "random", 0).state_dict(), "mobilenet_v2")
    with pytest.raises(ValueError, match=r"head\.1\.weight is \(4, 1280\) instead of \(3, 1280\)"):
        restore(network, build("mobilenet_v2", 4, "random", 0).state_dict(), "mobilenet_v2")
    damaged = network.state_dict() | {"head.1.bias": torch.tensor([0.0, float("nan"), 0.0])}
    with pytest.raises(ValueError, match="damaged: head.1.bias holds values that are not finite"):
        restore(network, damaged, "mobilenet_v2")
    with pytest.raises(ValueError, match="not weights of mobilenet_v2"):
        restore(network, 7, "mobilenet_v2")
    assert torch.equal(network.head[1].weight, before)


def test_cost_leaves_the_network_and_the_threads_as_they_were():
    network, threads = build("alexnet", 2, "random", 0).train(), torch.get_num_threads()
    found = cost(network, 64)
    assert network.training and torch.get_num_threads() == threads
    assert found["parameters"] == count_parameters(network)
    with pytest.raises(ValueError, match="1 pixel or more"):
        cost(network, 0)
    with pytest.raises(ValueError, match="cannot take an image of 3 x 64 x 64"):
        cost(torch.nn.Conv2d(6, 1, 3), 64)


def test_convolutions_alone_classify_nothing_of_imagenet():
    with pytest.raises(ValueError, match="only the convolutions of vgg16"):
        imagenet_classifier("vgg16", "download")


@pytest.mark.slow
def test_downloaded_weights_take_the_same_path(monkeypatch, tmp_path):
    urls = {}
    monkeypatch.setattr(torch.hub, "get_dir", lambda: str(tmp_path))
    monkeypatch.setattr(torchvision.models, "get_weight", lambda name: SimpleNamespace(url=urls[name]))
    (tmp_path / "checkpoints").mkdir()
    for name, published in (("alexnet", "AlexNet"), ("googlenet", "GoogLeNet")):
        options = {"init_weights": True} if name == "googlenet" else {}
        whole = torchvision.models.get_model(name, **options)
        torch.save(whole.state_dict(), tmp_path / "saved")
        file = f"{name}-{sha256(tmp_path / 'saved')[:8]}.pth"
        (tmp_path / "saved").rename(tmp_path / "checkpoints" / file)
        urls[f"{published}_Weights.IMAGENET1K_V1"] = f"https://example.org/{file}"
        network = build(name, 2, "imagenet", 0, "download")
        weights = [parameter for parameter in whole.parameters() if parameter.ndim == 4][1]
        assert any(torch.equal(weights, parameter) for parameter in network.parameters())
    assert (
        available_weights("alexnet", "download") == "convolutions"
        and available_weights("googlenet", "download") == "complete"
    )


@pytest.mark.slow
def test_googlenets_own_colours_move_into_its_first_layer():
    with torch.random.fork_rng(devices=[]), torch.no_grad():
        torch.manual_seed(0)
        theirs = torchvision.models.googlenet(init_weights=True, transform_input=True).eval()
        theirs.conv1.bn.running_mean.normal_()
        theirs.conv1.bn.running_var.uniform_(0.5, 2)
        ours = torchvision.models.googlenet(init_weights=True, aux_logits=False, transform_input=False).eval()
        ours.load_state_dict(convert_googlenet(theirs.state_dict()))
        images = torch.randn(2, 3, 48, 48)
        expected = theirs.conv1(theirs._transform_input(images))
        inside = (..., slice(2, -2), slice(2, -2))  # the kernel of 7 reaches the padding outside
        assert torch.allclose(ours.conv1(images)[inside], expected[inside], atol=1e-5)

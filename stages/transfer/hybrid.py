"""The hybrid network: two MobileNetV2 that share their middle, stitched into one with two streams (T5.5)."""

import copy
from typing import NamedTuple

import torch

from stages.networks.device import device_of
from stages.networks.images import MEAN, STD
from stages.networks.network import Network

from .switch import Switch, present

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
        self.register_buffer("temperature", torch.ones(2))  # of each head's softmax, from stages.transfer.fusion
        self.requires_grad_(False).eval().to(device_of(vision))

    def forward(self, images: torch.Tensor) -> Scores:
        """Scores of images (b, 6, h, w) in 0..1."""
        shared = self.shared(self._stream(images, 0) + self._stream(images, 1))
        return Scores(*(self._head(images, shared, sense) for sense in range(2)))

    def separate_scores(self, images: torch.Tensor) -> Scores:
        """Scores like those of forward, but each head gets its own stream alone, even where both senses are present."""
        return Scores(*(self._head(images, self.shared(self._stream(images, sense)), sense) for sense in range(2)))

    def features(self, images: torch.Tensor, sense: int) -> torch.Tensor:
        """(b, width): what the head of one sense, an index of SENSES, gets of images (b, 6, h, w) in 0..1."""
        # the items of a ModuleList are typed as Module
        return self.late[sense][:-1](self.shared(self._stream(images, sense)))  # pyright: ignore

    @torch.no_grad()
    def predict(self, images: torch.Tensor) -> Prediction:
        """Prediction for images (b, 6, h, w) by the more confident of the present senses, of equals vision.

        Confidence is the highest probability after each head's `temperature`. Raises ValueError for images of another
        shape and for values that are not in 0..1.
        """
        check_images(images)
        scaled = [scores / t for scores, t in zip(self.separate_scores(images), self.temperature, strict=True)]
        best = torch.stack([scores.softmax(dim=1).amax(dim=1).nan_to_num(nan=-1) for scores in scaled])
        probability, sense = best.max(dim=0)
        labels = torch.stack([scores.argmax(dim=1) for scores in scaled])
        label = labels.gather(0, sense[None])[0]
        none = probability < 0
        return Prediction(
            label.masked_fill(none, -1), probability.masked_fill(none, torch.nan), sense.masked_fill(none, -1)
        )

    @property
    def classes(self) -> tuple[int, int]:
        """The numbers of classes of the heads of (vision, touch)."""
        # the items of a ModuleList are typed as Module
        return tuple(late[-1][-1].out_features for late in self.late)  # pyright: ignore

    def _own(self, images, sense):
        return images[:, 3 * sense : 3 * sense + 3]

    def _stream(self, images, sense):
        own, channels = self._own(images, sense), slice(3 * sense, 3 * sense + 3)
        normal = ((own - self.mean[channels]) / self.std[channels]).contiguous(memory_format=torch.channels_last)
        return self.switch(own, self.early[sense](normal))

    def _head(self, images, shared, sense):
        available = present(self._own(images, sense))
        return self.late[sense](shared).where(available[:, None], torch.nan)


def join_senses(pictures: torch.Tensor | None, imprints: torch.Tensor | None) -> torch.Tensor:
    """(b, 6, h, w) f4: the input of a HybridNet from images (b, 3, h, w) of each sense; None for an absent sense."""
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
    if images.ndim != 4 or images.shape[1] != 6 or 0 in images.shape:
        raise ValueError(f"images must have shape (b, 6, h, w) and not be empty, got {tuple(images.shape)}")
    if not bool(((images >= 0) & (images <= 1)).all()):
        raise ValueError("images must hold values in 0..1, and neither NaN nor infinity")


def _check(vision, touch, middle):
    start, stop = middle
    if not 0 < start < stop < LAYERS:
        raise ValueError(f"the middle must be (start, stop) with 0 < start < stop < {LAYERS}, got {middle}")
    for sense, network in zip(SENSES, (vision, touch), strict=True):
        found = len(getattr(network, "convolutions", ()))
        if found != LAYERS:
            raise ValueError(f"{sense} is not a mobilenet_v2: its convolutions have {found} parts instead of {LAYERS}")
    other = touch.convolutions[start:stop].state_dict()
    for key, value in vision.convolutions[start:stop].state_dict().items():
        if "num_batches_tracked" in key:  # a counter that nothing in evaluation mode reads
            continue
        if key not in other or value.shape != other[key].shape or not torch.equal(value, other[key]):
            layer, _, rest = key.partition(".")
            raise ValueError(
                f"the two networks do not share features[{start}:{stop}]: features.{layer}.{rest} differs. Train both "
                "with these layers frozen, from the same weights"
            )
    return start, stop

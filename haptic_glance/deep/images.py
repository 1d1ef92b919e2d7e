"""Imprints as inputs of a network trained on photographs: red channel, size, normalisation, augmentation (T5.3)."""

from collections.abc import Callable, Sequence

import numpy as np
import torch
from kornia import augmentation as kornia_augmentation
from kornia.augmentation import AugmentationSequential

Transform = Callable[[torch.Tensor], torch.Tensor]  # of images or ids to images, such as an augmentation
MEAN = (0.485, 0.456, 0.406)  # of red, green and blue in ImageNet, as for torchvision's weights
STD = (0.229, 0.224, 0.225)
SHIFT = 0.1  # translation, as a share of the side; the thesis gives no range
SCALE = (0.9, 1.1)  # likewise


def to_images(imprints: np.ndarray | list[np.ndarray], size: int) -> torch.Tensor:
    """Images (k, 3, size, size) f4 in 0..1: the imprint in the red channel, green and blue zero (T5.3).

    imprints: (k, r, c), u1 or floats in 0..1; resized bilinearly, with an anti-aliasing filter where they shrink.
    Raises ValueError for another shape, several sizes, values out of range or NaN.
    """
    grey = as_floats(imprints, "imprints")
    if grey.ndim != 3 or 0 in grey.shape:
        raise ValueError(f"imprints must have shape (k, rows, columns) and not be empty, got {tuple(grey.shape)}")
    images = torch.zeros(len(grey), 3, size, size)
    images[:, 0] = resized(grey[:, None], size)[:, 0]
    return images


def as_floats(images: np.ndarray | Sequence[np.ndarray], name: str) -> torch.Tensor:
    """The images, u1 or floats in 0..1, as one f4 tensor; raises ValueError for several sizes and for other values."""
    sizes = [] if hasattr(images, "shape") else sorted({np.shape(image) for image in images})
    if len(sizes) > 1:
        raise ValueError(f"images of several sizes, {', '.join(map(str, sizes))}: resize them to one first")
    if isinstance(images, np.ndarray):
        images = np.require(images, requirements=["C", "W"])  # torch refuses reversed axes, warns of read-only ones
    tensor = torch.as_tensor(images)
    tensor = tensor.float() / 255 if tensor.dtype == torch.uint8 else tensor.float()
    if not bool(((tensor >= 0) & (tensor <= 1)).all()):
        raise ValueError(f"{name} must hold values in 0..1, and neither NaN nor infinity")
    return tensor


def resized(images: torch.Tensor, size: int) -> torch.Tensor:
    """(k, c, size, size) of images (k, c, h, w) in 0..1: bilinear, with an anti-aliasing filter where they shrink."""
    if images.shape[2:] == (size, size):
        return images
    return torch.nn.functional.interpolate(images, (size, size), mode="bilinear", antialias=True).clamp(0, 1)


def normalise(images: torch.Tensor) -> torch.Tensor:
    """Images (k, 3, h, w) in 0..1, normalised by ImageNet's mean and standard deviation per channel."""
    mean = torch.tensor(MEAN, device=images.device).view(3, 1, 1)
    std = torch.tensor(STD, device=images.device).view(3, 1, 1)
    return ((images - mean) / std).contiguous(memory_format=torch.channels_last)


def augmentation(upright: bool = False) -> AugmentationSequential:
    """Random reflection, translation and scaling of images in 0..1, for training only (T5.3).

    Uses torch's random numbers. Pixels that move in from outside repeat the imprint's border, since black, the usual
    fill value, would mean contact. upright: reflect left to right alone, for pictures of upright objects.
    """
    sideways = kornia_augmentation.RandomHorizontalFlip(p=0.5)
    upside_down = [] if upright else [kornia_augmentation.RandomVerticalFlip(p=0.5)]
    moves = {"translate": (SHIFT, SHIFT), "scale": SCALE, "padding_mode": "border"}
    return AugmentationSequential(sideways, *upside_down, kornia_augmentation.RandomAffine(degrees=0, p=1.0, **moves))

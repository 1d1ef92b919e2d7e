"""Damaged pictures: a worse camera, less light, something in front of the object."""

import numpy as np

from haptic_glance.base.lazy import cv2
from haptic_glance.touch.skin import as_shares

from .imprint import PERTURBATIONS, disturb, with_square
from .perturbed import in_range

PICTURE, IMPRINT = "picture_", "imprint_"  # prefixes of perturbations: the sense that is damaged
MISSING = "missing"  # the sense is absent


def noise(images: np.ndarray, severity: float, random: np.random.Generator) -> np.ndarray:
    """Gaussian noise with a sigma of `severity` of full scale, independent in each channel."""
    return images + random.normal(0, in_range(severity, 0, 10, "sigma over full scale"), images.shape)


def blur(images: np.ndarray, severity: float, random: np.random.Generator) -> np.ndarray:
    """A Gaussian blur with a sigma of `severity` of the image's side: out of focus."""
    sigma, blurred = in_range(severity, 0, 1, "sigma over the side") * images.shape[1], images.copy()
    for image in blurred if sigma > 0 else ():
        image[:] = cv2.GaussianBlur(image, (0, 0), sigma, borderType=cv2.BORDER_REPLICATE)
    return blurred


def darkness(images: np.ndarray, severity: float, random: np.random.Generator) -> np.ndarray:
    """The light is reduced by the share `severity` and quantised to 256 levels."""
    return np.round(images * (1 - in_range(severity, 0, 1, "the share of the light")) * 255) / 255


def occlusion(images: np.ndarray, severity: float, random: np.random.Generator) -> np.ndarray:
    """A grey square of `severity` of the picture's area at a random position, such as a hand or a box."""
    return with_square(images, severity, random, 0.5)


PICTURES = {"noise": noise, "blur": blur, "darkness": darkness, "occlusion": occlusion}
KNOWN = (*(PICTURE + name for name in PICTURES), *(IMPRINT + name for name in PERTURBATIONS))


def damage_pictures(pictures: np.ndarray, name: str, severity: float, random: np.random.Generator) -> np.ndarray:
    """(k, h, w, 3) f4 in 0..1: pictures (k, h, w, 3), u1 or floats in 0..1, under one of PICTURES.

    Raises ValueError for other values, and for a severity out of range.
    """
    damaged = PICTURES[name](as_shares(pictures), severity, random)
    return np.clip(damaged, 0, 1).astype(np.float32)


def damage(raw: np.ndarray, name: str, severity: float, random: np.random.Generator) -> np.ndarray | None:
    """Damaged pictures (k, h, w, 3) or imprints (k, r, c) of one sense, f4 in 0..1, or None where it is missing.

    name: `picture_NAME` of PICTURES, `imprint_NAME` of haptic_glance.disturb.imprint, or either with `missing`.
    """
    effect = name.partition("_")[2]
    if effect == MISSING:
        return None
    return (damage_pictures if name.startswith(PICTURE) else disturb)(raw, effect, severity, random)

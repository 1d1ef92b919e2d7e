"""Pictures that went wrong: a worse camera, less light, something in front of the object."""

import cv2
import numpy as np

from .disturbed import PERTURBATIONS, disturb

PICTURE, IMPRINT = "picture_", "imprint_"  # begin the name of a perturbation: which sense suffers
MISSING = "missing"  # that sense gives nothing


def noise(images, severity, random):
    """Gaussian noise with a sigma of `severity` of full scale, each channel its own."""
    return images + random.normal(0, severity, images.shape)


def blur(images, severity, random):
    """A Gaussian blur with a sigma of `severity` of the image's side: out of focus."""
    sigma = severity * images.shape[1]
    return np.stack([cv2.GaussianBlur(image, (0, 0), sigma, borderType=cv2.BORDER_REPLICATE) for image in images])


def darkness(images, severity, random):
    """`severity` of the light is gone, and the camera has 256 steps for what is left."""
    return np.round(images * (1 - severity) * 255) / 255


def occlusion(images, severity, random):
    """A grey square of `severity` of the picture's area at a random place: somebody's hand, a box."""
    size = images.shape[1]
    side = min(round(size * np.sqrt(severity)), size)
    found = images.copy()
    for image, (row, column) in zip(found, random.integers(0, size - side + 1, (len(images), 2)), strict=True):
        image[row : row + side, column : column + side] = 0.5
    return found


PICTURES = {"noise": noise, "blur": blur, "darkness": darkness, "occlusion": occlusion}


def damage_pictures(pictures, name, severity, random):
    """(k, h, w, 3) f4 in 0..1: pictures (k, h, w, 3) u1 under one of PICTURES; random: a numpy generator."""
    found = PICTURES[name](pictures.astype(np.float32) / 255, severity, random)
    return np.clip(found, 0, 1).astype(np.float32)


def damage(raw, name, severity, random):
    """One sense's pictures (k, h, w, 3) or imprints (k, r, c), u1, worse: f4 in 0..1, or None where it is missing.

    name: `picture_NAME` of PICTURES, `imprint_NAME` of stages.transfer.disturbed, or either with `missing`.
    """
    what = name.partition("_")[2]
    if what == MISSING:
        return None
    return (damage_pictures if name.startswith(PICTURE) else disturb)(raw, what, severity, random)


def check(severities):
    """Raises ValueError for the name of a perturbation that is not known."""
    known = [*(PICTURE + name for name in PICTURES), *(IMPRINT + name for name in PERTURBATIONS)]
    strange = sorted(set(severities) - set(known))
    if strange:
        raise ValueError(f"transfer.hybrid_severities: {', '.join(strange)} not known, choose of {', '.join(known)}")

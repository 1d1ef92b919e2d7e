"""Perturbations of imprints by a worse sensor or a less steady hand, which are not in the training data."""

from functools import partial

import numpy as np

from haptic_glance.base.lazy import cv2
from haptic_glance.touch import Skin
from haptic_glance.touch.skin import as_shares

from .perturbed import in_range

FEW_TOUCHES = "few_touches"  # not a perturbation of the test touches: fewer touches are used for training


def _skin(images, severity, random, effect):
    return Skin(**{effect: severity}, seed=int(random.integers(2**31)))(images)


def occlusion(images: np.ndarray, severity: float, random: np.random.Generator) -> np.ndarray:
    """A square of the array, `severity` of its area, at a random position, gives no contact, as with a torn wire."""
    return with_square(images, severity, random, 1)


def with_square(images: np.ndarray, severity: float, random: np.random.Generator, value: float) -> np.ndarray:
    """Images (k, r, c, ...) with a square of a value at a random position, `severity` of the area; a rectangle of their
    proportions where they are none."""
    sides = np.array(images.shape[1:3])
    extent = np.rint(sides * np.sqrt(in_range(severity, 0, 1, "the share of the area"))).astype(np.int64)
    damaged = images.copy()
    for image, (row, column) in zip(damaged, random.integers(0, sides - extent + 1, (len(images), 2)), strict=True):
        image[row : row + extent[0], column : column + extent[1]] = value
    return damaged


def rotation(images: np.ndarray, severity: float, random: np.random.Generator) -> np.ndarray:
    """Each imprint rotated about its centre by `severity` degrees to either side; its border pixels are repeated."""
    in_range(severity, 0, 180, "the turn in degrees")
    rows, columns = images.shape[1:]
    centre, rotated = ((columns - 1) / 2, (rows - 1) / 2), np.empty_like(images)
    for i, side in enumerate(random.choice([-1, 1], len(images))):
        turn = cv2.getRotationMatrix2D(centre, float(side * severity), 1.0)
        rotated[i] = cv2.warpAffine(images[i], turn, (columns, rows), borderMode=cv2.BORDER_REPLICATE)
    return rotated


def resolution(images: np.ndarray, severity: float, random: np.random.Generator) -> np.ndarray:
    """The imprint of an array as wide with `severity` sensels a side, each the mean of those it replaces."""
    cells = int(in_range(severity, 1, min(images.shape[1:]), "the sensels a side"))
    coarse = [cv2.resize(image, (cells, cells), interpolation=cv2.INTER_AREA) for image in images]
    return np.reshape(coarse, (-1, cells, cells))


PERTURBATIONS = {
    "noise": partial(_skin, effect="noise"),  # sigma, share of full scale
    "blur": partial(_skin, effect="blur"),  # sigma in cells
    "dead_cells": partial(_skin, effect="dead"),  # share of the cells
    "occlusion": occlusion,  # share of the area
    "rotation": rotation,  # degrees
    "resolution": resolution,  # cells a side
}
KNOWN = (*PERTURBATIONS, FEW_TOUCHES)


def disturb(images: np.ndarray, name: str, severity: float, random: np.random.Generator) -> np.ndarray:
    """(k, rows, cols) f4 in 0..1: imprints (k, r, c), u1 or floats in 0..1, under one of PERTURBATIONS.

    Raises ValueError for other values and names, and for a severity out of range.
    """
    if name not in PERTURBATIONS:
        raise ValueError(f"unknown disturbance {name!r}: choose one of {', '.join(PERTURBATIONS)}")
    return np.clip(PERTURBATIONS[name](as_shares(images), severity, random), 0, 1).astype(np.float32)

"""Perturbations of imprints by a worse sensor."""

from functools import partial

import numpy as np

from haptic_glance.touch import Skin
from haptic_glance.touch.skin import as_shares

from .perturbed import in_range


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


PERTURBATIONS = {
    "noise": partial(_skin, effect="noise"),  # sigma, share of full scale
    "blur": partial(_skin, effect="blur"),  # sigma in cells
    "dead_cells": partial(_skin, effect="dead"),  # share of the cells
    "occlusion": occlusion,  # share of the area
}


def disturb(images: np.ndarray, name: str, severity: float, random: np.random.Generator) -> np.ndarray:
    """(k, rows, cols) f4 in 0..1: imprints (k, r, c), u1 or floats in 0..1, under one of PERTURBATIONS.

    Raises ValueError for other values and names, and for a severity out of range.
    """
    if name not in PERTURBATIONS:
        raise ValueError(f"unknown disturbance {name!r}: choose one of {', '.join(PERTURBATIONS)}")
    return np.clip(PERTURBATIONS[name](as_shares(images), severity, random), 0, 1).astype(np.float32)

"""Imprints as a worse sensor, or a hand less steady, would give them: what the networks did not learn from."""

from functools import partial

import cv2
import numpy as np

from stages.imprints import Skin

FEW = "few_touches"  # not the test touches are disturbed: fewer are trained on


def _skin(images, severity, random, what):
    return Skin(**{what: severity}, seed=int(random.integers(2**31)))(images)


def occlusion(images, severity, random):
    """A square of the array, `severity` of its area, at a random place, feels nothing: a rag, or a torn wire."""
    cells = images.shape[1]
    side = min(round(cells * np.sqrt(severity)), cells)
    found = images.copy()
    for image, (row, column) in zip(found, random.integers(0, cells - side + 1, (len(images), 2)), strict=True):
        image[row : row + side, column : column + side] = 1
    return found


def rotation(images, severity, random):
    """Each imprint turned about its middle by `severity` degrees, left or right; at the rim its edge goes on."""
    rows, columns = images.shape[1:]
    middle, found = ((columns - 1) / 2, (rows - 1) / 2), np.empty_like(images)
    for i, side in enumerate(random.choice([-1, 1], len(images))):
        turn = cv2.getRotationMatrix2D(middle, float(side * severity), 1.0)
        found[i] = cv2.warpAffine(images[i], turn, (columns, rows), borderMode=cv2.BORDER_REPLICATE)
    return found


def resolution(images, severity, random):
    """The imprint by an array of `severity` sensels a side, equally wide: each the mean of those it replaces."""
    cells = int(severity)
    return np.stack([cv2.resize(image, (cells, cells), interpolation=cv2.INTER_AREA) for image in images])


PERTURBATIONS = {
    "noise": partial(_skin, what="noise"),  # sigma, share of full scale
    "blur": partial(_skin, what="blur"),  # sigma in cells
    "dead_cells": partial(_skin, what="dead"),  # share of the cells
    "occlusion": occlusion,  # share of the area
    "rotation": rotation,  # degrees
    "resolution": resolution,  # cells a side
}


def disturb(images, name, severity, random):
    """(k, rows, cols) f4 in 0..1: imprints (k, r, c) u1 under one of PERTURBATIONS; random: a numpy generator."""
    return np.clip(PERTURBATIONS[name](images.astype(np.float32) / 255, severity, random), 0, 1).astype(np.float32)


def check(severities):
    """Raises ValueError for a perturbation that is not known."""
    strange = sorted(set(severities) - {*PERTURBATIONS, FEW})
    if strange:
        raise ValueError(
            f"transfer.severities: {', '.join(strange)} not known, choose of {', '.join((*PERTURBATIONS, FEW))}"
        )

"""Spin images: where the surface around a point lies, in cylindrical coordinates about its normal."""

import math

import numpy as np

from stages.kit.jit import kernel_of

kernel = kernel_of(__file__)


@kernel
def spin_images(
    positions: np.ndarray, areas: np.ndarray, centres: np.ndarray, normals: np.ndarray, radius: float, bins: int
) -> np.ndarray:
    """(k, 2 bins, bins) shares of the area around each of k centres (k, 3) with normals (k, 3).

    Rows are heights over the tangent plane from -radius to radius, columns distances from the normal's line up to it.
    positions (n, 3) with areas (n,) make up the surface; each within radius counts in the four bins around it. An image
    sums to one, or to zero where nothing is near. Source: Johnson and Hebert, Using spin images for efficient object
    recognition in cluttered 3D scenes, PAMI 21(5), 1999.
    """
    images = np.zeros((len(centres), 2 * bins, bins))
    for k in range(len(centres)):
        for i in range(len(positions)):
            square, height = 0.0, 0.0
            for axis in range(3):
                side = positions[i, axis] - centres[k, axis]
                square += side * side
                height += side * normals[k, axis]
            if square <= radius**2:
                aside = math.sqrt(max(square - height * height, 0.0))
                _add(images[k], (height / radius + 1) * bins - 0.5, aside / radius * bins - 0.5, areas[i])
        total = images[k].sum()
        if total > 0:
            images[k] /= total
    return images


@kernel
def _add(image, row, column, amount):
    """Shares an amount among the four bins around a place; what falls off the edge goes to the bin there."""
    first, left = math.floor(row), math.floor(column)
    for i, down in ((first, first + 1 - row), (first + 1, row - first)):
        for j, right in ((left, left + 1 - column), (left + 1, column - left)):
            place = min(max(i, 0), len(image) - 1), min(max(j, 0), image.shape[1] - 1)
            image[place] += amount * down * right

"""Pictures of the touched objects: renderings of their meshes from all sides (T5.5)."""

from collections.abc import Sequence

import numpy as np
import torch

from haptic_glance.look.camera import Viewpoint
from haptic_glance.look.views import render
from haptic_glance.mesh.mesh import Mesh

from .images import as_floats, resized, to_images

ELEVATIONS = (-10.0, 60.0)  # degrees: an object on a table, seen by a person who sits or stands, and never from below
STEP = 1 / 255  # the smallest step of a grey value
SAMPLES = 3  # rays per pixel and side; the pixel is their mean, so that thin parts are grey instead of dotted


def viewpoints(count: int, generator: np.random.Generator) -> list[Viewpoint]:
    """`count` Viewpoints around an upright object: azimuths evenly spaced from a random start, elevations random.

    Elevations are uniform in their sine, so that viewpoints are uniform on the sphere.
    """
    if count < 1:
        raise ValueError(f"the number of pictures must be 1 or more, got {count}")
    azimuths = (360 * np.arange(count) / count + 360 * generator.random()) % 360
    low, high = np.sin(np.radians(ELEVATIONS))
    elevations = np.degrees(np.arcsin(generator.uniform(low, high, count)))
    return [Viewpoint(float(a), float(e)) for a, e in zip(azimuths, elevations, strict=True)]


def take_pictures(mesh: Mesh, views: Sequence[Viewpoint], size: int, colour: bool = False) -> np.ndarray:
    """(k, size, size, 3) u1: the normalised mesh from k Viewpoints on a white background.

    Grey unless `colour`, since colours would distinguish objects of the same shape. The renderer `raster` makes
    them equal on every machine.
    """
    rendered = mesh if colour else Mesh(mesh.vertices, mesh.faces)
    fine = (size * SAMPLES, size * SAMPLES)
    renders = [render(rendered, view, fine, renderer="raster", background="white").rgb for view in views]
    blocks = np.stack(renders).reshape(-1, size, SAMPLES, size, SAMPLES, 3)
    return np.rint(blocks.mean(axis=(2, 4))).astype(np.uint8)


def picture_images(pictures: np.ndarray, size: int) -> torch.Tensor:
    """Images (k, 3, size, size) f4 in 0..1 of pictures (k, h, w, 3), u1 or floats in 0..1; resized where needed.

    Resizing is bilinear, with an anti-aliasing filter where they shrink. Raises ValueError for another shape, values
    out of range or NaN, and for several sizes.
    """
    images = as_floats(pictures, "pictures")
    if images.ndim != 4 or images.shape[3] != 3 or 0 in images.shape:
        raise ValueError(f"pictures must have shape (k, h, w, 3) and not be empty, got {tuple(images.shape)}")
    return resized(images.permute(0, 3, 1, 2).contiguous(), size)


def as_images(raw: np.ndarray, size: int) -> torch.Tensor:
    """Images (k, 3, size, size) f4 in 0..1 of pictures (k, h, w, 3) or imprints (k, r, c), u1 or f4 in 0..1."""
    return picture_images(raw, size) if raw.ndim == 4 else imprint_images(raw, size)


def imprint_images(imprints: np.ndarray, size: int) -> torch.Tensor:
    """Images (k, 3, size, size) f4 of imprints (k, r, c), as by `to_images` of .images, with full contact marked.

    A flat face pressed against the array gives zeros everywhere (distance 0), which in the thesis also means an absent
    sense: its switch would turn off the touch of a table top. So one corner pixel is raised by one grey step, and the
    variance is not zero. An imprint of ones, without contact, stays constant: absent.
    """
    images, grey = to_images(imprints, size), as_floats(imprints, "imprints").flatten(1)
    flat = grey.amin(dim=1) == grey.amax(dim=1)
    images[flat, 0] = grey[flat, :1, None]  # without the rounding errors of resizing, which would be a variance
    touched = flat & (grey[:, 0] < 1)
    images[touched, 0, 0, 0] = (images[touched, 0, 0, 0] + STEP).clamp(max=1)
    return images

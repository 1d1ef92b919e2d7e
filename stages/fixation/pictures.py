"""Grey pictures of an object from all sides, as inputs of a network for photographs (T3.3.2)."""

from pathlib import Path

import numpy as np
import torch
from kornia import augmentation as kornia_augmentation

from haptic_glance.base.files import read_arrays, read_mesh, write_arrays
from haptic_glance.base.timing import Stopwatch
from haptic_glance.deep import normalise
from haptic_glance.look.views import render
from haptic_glance.look.weights.convexity import convexity

from .schema import Params
from .shape import curvature_shares, eccentricity
from .viewpoints import viewpoint_sphere

DEGREES, SCALE = 20, (0.8, 1.2)  # random rotation and rescaling; T3.3.2 gives no range


def take_pictures(name: str, folder: Path, data: Path, settings: Params) -> list[dict]:
    """Stores the pictures of one object and measures its shape; returns one row per measure.

    The renderer `raster` draws them: it gives the same bytes on every machine.
    """
    mesh = read_mesh(data / "meshes" / f"{name}.npz")
    viewpoints, size = viewpoint_sphere(settings.parallels, settings.azimuths), (settings.size, settings.size)
    with Stopwatch() as watch:
        pictures = np.stack([render(mesh, viewpoint, size, "raster").rgb.mean(axis=2) for viewpoint in viewpoints])
    write_arrays(
        folder / ".pictures" / f"{name}.npz", pictures=np.rint(pictures).astype(np.uint8), seconds=watch.seconds
    )
    with Stopwatch() as watch:
        measures = {"convexity": convexity(mesh), "eccentricity": eccentricity(mesh)}
        measures |= dict(zip(("positive", "negative", "zero"), curvature_shares(mesh), strict=True))
    row = {"item": name, "method": "shape", "seconds": watch.seconds}
    return [row | {"metric": metric, "value": value} for metric, value in measures.items()]


def read_pictures(folder: Path, name: str) -> tuple[np.ndarray, float]:
    """(the pictures (v, size, size) u1, their seconds)."""
    stored = read_arrays(folder / ".pictures" / f"{name}.npz")
    return stored["pictures"], float(stored["seconds"])


def to_images(pictures: np.ndarray, device: str | torch.device = "cpu") -> torch.Tensor:
    """(b, 3, h, w) f4 in 0..1 on a torch device: grey pictures (b, h, w) u1."""
    grey = torch.as_tensor(pictures, device=device).float() / 255
    return grey[:, None].expand(-1, 3, -1, -1)


def network_inputs(pictures: np.ndarray, device: str | torch.device = "cpu") -> torch.Tensor:
    """(b, 3, h, w) f4 normalised images of grey pictures (b, h, w) u1."""
    return normalise(to_images(pictures, device))


def augmentation() -> torch.nn.Module:
    """Random rotation and rescaling of images in 0..1 (T3.3.2), by torch's random numbers."""
    return kornia_augmentation.RandomAffine(degrees=DEGREES, scale=SCALE, p=1.0)

"""Pictures of an object from all round, grey, as a network for photographs takes them (T3.3.2)."""

import numpy as np
import torch

from stages.kit import Stopwatch
from stages.kit.files import read_arrays, read_mesh, write_arrays
from stages.kit.run import DATA
from stages.networks import normalise
from stages.views import render
from stages.weights.convexity import convexity

from .shape import curvature_shares, eccentricity
from .viewpoints import sphere


def take(item, folder, settings):
    """Takes the pictures of one object (`shape@NAME`) and measures its shape; returns a row a measure.

    The ray caster draws them: at this size it is as fast as OpenGL, and gives the same bytes on every machine.
    """
    name = item.partition("@")[2]
    mesh = read_mesh(DATA / "meshes" / f"{name}.npz")
    viewpoints, size = sphere(settings.parallels, settings.azimuths), (settings.size, settings.size)
    with Stopwatch() as watch:
        pictures = np.stack([render(mesh, viewpoint, size, "raycast").rgb.mean(axis=2) for viewpoint in viewpoints])
    write_arrays(
        folder / ".pictures" / f"{name}.npz", pictures=np.rint(pictures).astype(np.uint8), seconds=watch.seconds
    )
    with Stopwatch() as watch:
        measures = {"convexity": convexity(mesh), "eccentricity": eccentricity(mesh)}
        measures |= dict(zip(("positive", "negative", "zero"), curvature_shares(mesh), strict=True))
    row = {"object": name, "method": "shape", "task": None, "view": None, "seconds": watch.seconds}
    return [row | {"metric": metric, "value": value} for metric, value in measures.items()]


def read_pictures(folder, name):
    """((v, size, size) u1, seconds that they took)."""
    stored = read_arrays(folder / ".pictures" / f"{name}.npz")
    return stored["pictures"], float(stored["seconds"])


def images_of(pictures, device="cpu"):
    """(b, 3, h, w) f4 in 0..1 on a torch device: grey pictures (b, h, w) u1."""
    grey = torch.as_tensor(pictures, device=device).float() / 255
    return grey[:, None].expand(-1, 3, -1, -1)


def inputs(pictures, device="cpu"):
    """(b, 3, h, w) f4 normalised images of grey pictures (b, h, w) u1."""
    return normalise(images_of(pictures, device))

"""The touches of one object, by arrays of several resolutions that are equally wide."""

from pathlib import Path

import numpy as np

from haptic_glance.base.files import read_arrays, read_mesh, write_arrays
from haptic_glance.base.rng import rng
from haptic_glance.touch import press_many
from stages.kit.run import Rows
from stages.salient_points import read_points
from stages.transfer.touches import choose_vertices

from .schema import Params


def process(name: str, folder: Path, data: Path, settings: Params, arrays: list[int], seed: int) -> Rows:
    """Presses each array at the same vertices and writes NAME.npz: per number of cells (touches, cells, cells)."""
    mesh, points = read_mesh(data / "meshes" / f"{name}.npz"), read_points(data / "salient_points" / f"{name}.npz")
    if settings.detector not in points:
        raise ValueError(f"coarse_imprints.detector={settings.detector} is not one of {', '.join(points)}")
    vertices = choose_vertices(mesh, points[settings.detector], settings.touches, rng(seed, f"touches {name}"))
    pressed = {str(cells): press_many(mesh, vertices, (cells, cells), settings.width / cells) for cells in arrays}
    write_arrays(folder / f"{name}.npz", **pressed)
    return []


def read_imprints(folder: Path, members: dict[str, list[str]], cells: int) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """(imprints (k, cells, cells), labels (k,) i8, objects (k,) i8) of members {class: its objects}."""
    images, labels, objects = [], [], []
    for label, names in enumerate(members.values()):
        for name in names:
            images.append(read_arrays(folder / f"{name}.npz")[str(cells)])
            objects += [len(images)] * len(images[-1])
            labels += [label] * len(images[-1])
    return np.concatenate(images), np.array(labels), np.array(objects)

"""Pictures of the touched objects: their files, and the pairing of touches with pictures."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import torch

from haptic_glance.base.files import read_arrays, read_mesh, write_arrays
from haptic_glance.base.rng import rng
from haptic_glance.deep.pictures import take_pictures, viewpoints

from .schema import Params
from .touches import Touches


@dataclass(frozen=True, eq=False)
class SenseData:
    """The items of one sense of all objects, split into parts.

    raw: pictures (k, h, w, 3) or imprints (k, r, c), u1; images (k, 3, h, w) f4 in 0..1; labels and objects (k,) i8;
    train, validation, test: ids of items.
    """

    raw: np.ndarray
    images: torch.Tensor
    labels: np.ndarray
    objects: np.ndarray
    train: np.ndarray
    validation: np.ndarray
    test: np.ndarray


def process(name: str, folder: Path, data: Path, settings: Params, seed: int) -> list[dict]:
    """Renders the pictures of one object to hybrid/pictures/NAME.npz; returns no rows.

    images (k, size, size, 3) u1; viewpoints (k, 2), azimuth and elevation in degrees.
    """
    mesh = read_mesh(data / "meshes" / f"{name}.npz")
    views = viewpoints(settings.hybrid_pictures, rng(seed, f"pictures {name}"))
    images = take_pictures(mesh, views, settings.size, settings.hybrid_colour)
    seen_from = np.array([(view.azimuth, view.elevation) for view in views])
    write_arrays(folder / "hybrid" / "pictures" / f"{name}.npz", images=images, viewpoints=seen_from)
    return []


def read_pictures(folder: Path, members: Mapping[str, Sequence[str]]) -> Touches:
    """The pictures of members {class: its objects}, in their order, as Touches whose images are (k, h, w, 3) u1.

    Their `vertices` are the index of each picture in its file. folder: data/SET/transfer.
    """
    listed = [(label, rank, name) for label, group in enumerate(members.values()) for rank, name in enumerate(group)]
    images = [read_arrays(folder / "hybrid" / "pictures" / f"{name}.npz")["images"] for _, _, name in listed]
    counts = [len(part) for part in images]
    labels, ranks = (np.repeat([one[i] for one in listed], counts) for i in range(2))
    indices = np.concatenate([np.arange(count) for count in counts])
    return Touches(np.concatenate(images), labels, ranks, indices, list(members))


def pair_pictures(picture_objects: np.ndarray, touch_objects: np.ndarray, random: np.random.Generator) -> np.ndarray:
    """(k,) ids of pictures: for each touch one of the same object.

    picture_objects (p,), touch_objects (k,) i8: the object of each. An object's pictures are shuffled and used in turn,
    repeatedly where it has more touches than pictures. Raises ValueError for an object with touches and no picture.
    """
    picture_objects, touch_objects = np.asarray(picture_objects), np.asarray(touch_objects)
    found = np.empty(len(touch_objects), dtype=np.int64)
    for one in np.unique(touch_objects):
        own, touched = np.flatnonzero(picture_objects == one), touch_objects == one
        if not len(own):
            raise ValueError(f"object {one} has touches but no picture")
        found[touched] = np.resize(random.permutation(own), touched.sum())
    return found

"""Pictures paired with touches for the hybrid network, and its scores with one sense or both, by way of fusion.

Senses are undamaged, damaged or missing (beyond T5.5).
"""

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
import torch

from haptic_glance.base.files import read_arrays, read_mesh, write_arrays
from haptic_glance.base.rng import rng
from haptic_glance.deep.device import device_of, explain_out_of_memory
from haptic_glance.deep.hybrid import SENSES, HybridNet, Scores, join_senses
from haptic_glance.deep.rendered_views import as_images, take_pictures, viewpoints
from haptic_glance.disturb.picture import IMPRINT, MISSING, PICTURE, damage

from . import Params, fusion
from .imprint_images import Touches


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
    labels, ranks = (np.repeat([entry[i] for entry in listed], counts) for i in range(2))
    indices = np.concatenate([np.arange(count) for count in counts])
    return Touches(np.concatenate(images), labels, ranks, indices, list(members))


def pair_pictures(picture_objects: np.ndarray, touch_objects: np.ndarray, random: np.random.Generator) -> np.ndarray:
    """(k,) ids of pictures: for each touch one of the same object.

    picture_objects (p,), touch_objects (k,) i8: the object of each. An object's pictures are shuffled and used in turn,
    repeatedly where it has more touches than pictures. Raises ValueError for an object with touches and no picture.
    """
    picture_objects, touch_objects = np.asarray(picture_objects), np.asarray(touch_objects)
    pictures = np.empty(len(touch_objects), dtype=np.int64)
    for number in np.unique(touch_objects):
        ids, touched = np.flatnonzero(picture_objects == number), touch_objects == number
        if not len(ids):
            raise ValueError(f"object {number} has touches but no picture")
        pictures[touched] = np.resize(random.permutation(ids), touched.sum())
    return pictures


UNDAMAGED = "none"  # the perturbation in rows without any


def fused_rows(
    hybrid: HybridNet, senses: Sequence[SenseData], settings: Params, random: np.random.Generator, seed: int
) -> Iterator[dict]:
    """Rows of the accuracy with both senses under every condition; each test touch has a picture of the same object."""
    vision, touch = senses
    paired = vision.test[pair_pictures(vision.objects[vision.test], touch.objects[touch.test], random)]
    raw, labels = (vision.raw[paired], touch.raw[touch.test]), touch.labels[touch.test]
    undamaged = [as_images(stream, settings.size) for stream in raw]
    clean = [sense_scores(hybrid, stream, kind) for kind, stream in enumerate(undamaged)]
    better = better_sense(hybrid, senses)
    for name, severity in conditions(settings.hybrid_severities):
        images, scores = list[torch.Tensor | None](undamaged), list(clean)
        if name != UNDAMAGED:
            kind = int(name.startswith(IMPRINT))
            damaged = damage(raw[kind], name, severity, rng(seed, f"{name} {severity}"))
            images[kind], scores[kind] = None, np.full_like(clean[kind], np.nan)
            if damaged is not None:
                images[kind] = changed = as_images(damaged, settings.size)
                scores[kind] = sense_scores(hybrid, changed, kind)
        summed = in_batches(hybrid, join_senses(*images), device_of(hybrid))
        for method, probabilities in method_probabilities(scores, summed, hybrid.temperature.tolist(), better).items():
            entry = row(method, "accuracy", fusion.accuracy(probabilities, labels)) | {"sense": "both"}
            yield entry | {"perturbation": name, "severity": severity}


def conditions(severities: Mapping[str, Sequence[float]]) -> list[tuple[str, float]]:
    """(name, severity) of all conditions: undamaged, each perturbation, and each sense missing."""
    pairs = [(name, severity) for name, levels in severities.items() for severity in levels]
    return [(UNDAMAGED, 0.0), *pairs, (PICTURE + MISSING, 1.0), (IMPRINT + MISSING, 1.0)]


def better_sense(hybrid: HybridNet, senses: Sequence[SenseData]) -> int:
    """The sense, 0 or 1, with the higher accuracy on the validation items."""
    accuracies = [
        fusion.accuracy(sense_scores(hybrid, s.images[s.validation], kind), s.labels[s.validation])
        for kind, s in enumerate(senses)
    ]
    return int(accuracies[1] > accuracies[0])


def method_probabilities(
    apart: Sequence[np.ndarray], summed: Sequence[np.ndarray], temperatures: Sequence[float], better: int
) -> dict[str, np.ndarray]:
    """{method: probabilities (n, k)} of every method; NaN where it gives none.

    apart, summed: scores (n, k) of the two heads, each on its own stream, and on the sum of both as in the thesis. The
    methods are vision and touch alone, the sense that `better` names, the fusions of both, one of them without
    temperatures, and for the sum its two heads and their mean.
    """
    alone, heads = (
        [fusion.probabilities(scores, value) for scores, value in zip(pair, temperatures, strict=True)]
        for pair in (apart, summed)
    )
    by_method = {"vision": alone[0], "touch": alone[1], "better_sense": alone[better]}
    by_method |= {f"fusion_{rule}": fusion.fuse(alone[0], alone[1], rule) for rule in fusion.FUSIONS}
    by_method["fusion_entropy_raw"] = fusion.fuse(
        fusion.probabilities(apart[0]), fusion.probabilities(apart[1]), "entropy"
    )
    return by_method | {
        "sum_vision": heads[0],
        "sum_touch": heads[1],
        "sum_mean": fusion.fuse(heads[0], heads[1], "mean"),
    }


BATCH = 64  # images


def single_sense(images: torch.Tensor, kind: int) -> torch.Tensor:
    """(k, 6, h, w): the images (k, 3, h, w) of one sense, with the other absent. kind: the sense, 0 or 1."""
    return join_senses(images, None) if kind == 0 else join_senses(None, images)


def sense_scores(hybrid: HybridNet, images: torch.Tensor, kind: int) -> np.ndarray:
    """(n, classes) f4 numpy: the scores of one sense's head for its images (n, 3, h, w), without the other sense."""
    return in_batches(lambda part: hybrid(single_sense(part, kind))[kind], images, device_of(hybrid))


@torch.no_grad()
def in_batches(function: Callable[[torch.Tensor], Any], images: torch.Tensor, device: torch.device) -> Any:
    """function(images), computed in batches on the device: an array for a tensor, a tuple of arrays for Scores."""
    with explain_out_of_memory():
        batches = [function(part.to(device)) for part in images.split(BATCH)]
    if isinstance(batches[0], Scores):
        return tuple(torch.cat(part).cpu().numpy() for part in zip(*batches, strict=True))
    return torch.cat(batches).cpu().numpy()


def row(method: str, metric: str, value: float, kind: int | None = None, seconds: float | None = None) -> dict:
    """A row of a measurement. kind: the sense, 0 or 1, or None for the whole network."""
    sense = None if kind is None else SENSES[kind]
    return {"method": method, "sense": sense, "metric": metric, "value": value, "seconds": seconds}

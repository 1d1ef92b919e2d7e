"""The imprints of one sampling of one set, with their similarities and the cost of their features."""

from pathlib import Path

import numpy as np

from haptic_glance.base.timing import Stopwatch
from haptic_glance.know.features import features, image_features, wavelet_features
from stages.imprints import read_imprints

from .trials import THESIS_COUNT, TouchSet


def gather(folder: Path, objects: list[str], sampling: str, count: int) -> tuple[TouchSet, np.ndarray]:
    """(TouchSet, labels (k,)): the first `count` imprints of each object, the objects in alphabetical order."""
    imprints_by_object = {one: read_imprints(folder / f"{one}.npz")[sampling] for one in sorted(objects)}
    images = np.concatenate([imprints.images[:count] for imprints in imprints_by_object.values()])
    places = np.concatenate([imprints.positions[:count] for imprints in imprints_by_object.values()])
    truth = np.repeat(np.arange(len(imprints_by_object)), count)
    width = max(imprints.width for imprints in imprints_by_object.values())
    return TouchSet.from_images(features(images), images, truth, places, width), np.array(list(imprints_by_object))[
        truth
    ]


def similar_share_rows(touched: TouchSet, objects: list[str]) -> list[dict]:
    """Rows of the share of imprints confusable with another object's: over all objects, and per object (`item`)."""
    rows = []
    for variant, part in (("plain", touched), (f"first_{THESIS_COUNT}", touched.first_of_each())):
        for name, own in ((None, slice(None)), *((one, part.truth == k) for k, one in enumerate(objects))):
            share = part.confusable[own]
            rows.append({"variant": variant, "classifier": None, "item": name, "metric": "similar_share"})
            rows[-1] |= {"imprints": len(share), "value": float(share.mean()), "seconds": None, "note": None}
    return rows


def feature_cost_rows(touched: TouchSet) -> list[dict]:
    """Rows of the seconds for the features of all imprints of a sampling; the value is the number of features."""
    images = touched.images
    rows = []
    for variant, make in (
        ("plain", features),
        ("wavelet_features", wavelet_features),
        ("image_features", image_features),
    ):
        values, seconds = make(images), []  # the first call may load a library
        for _ in range(3):
            with Stopwatch() as watch:
                values = make(images)
            seconds.append(watch.seconds)
        rows.append({"variant": variant, "classifier": None, "imprints": len(images), "metric": "features"})
        rows[-1] |= {"value": values.shape[1], "seconds": min(seconds), "note": None}
    return rows

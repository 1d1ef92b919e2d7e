"""The imprints of one sampling of one set, and what is told of them before anything is trained."""

import numpy as np

from stages.imprints import read_imprints
from stages.kit import Stopwatch

from .features import features, image_features, wavelet_features
from .trials import FIRST, Touched


def gather(folder, objects, sampling, count):
    """(Touched, labels (k,)): the first `count` imprints of each object, the objects in alphabetical order."""
    found = {one: read_imprints(folder / f"{one}.npz")[sampling] for one in sorted(objects)}
    images = np.concatenate([imprints.images[:count] for imprints in found.values()])
    places = np.concatenate([imprints.positions[:count] for imprints in found.values()])
    truth = np.repeat(np.arange(len(found)), count)
    width = max(imprints.width for imprints in found.values())
    return Touched.of(features(images), images, truth, places, width), np.array(list(found))[truth]


def alike(touched, objects):
    """Rows of the share of imprints that another object has too, of all objects and of each (column `of`)."""
    rows = []
    for variant, part in (("plain", touched), (f"first_{FIRST}", touched.first())):
        for of, own in (("all", slice(None)), *((one, part.truth == k) for k, one in enumerate(objects))):
            share = part.shared[own]
            rows.append({"variant": variant, "classifier": None, "of": of, "metric": "similar_share"})
            rows[-1] |= {"imprints": len(share), "value": float(share.mean()), "seconds": None, "note": None}
    return rows


def costs(touched):
    """Rows of the seconds that the features of all imprints of a sampling take; the value is how many features."""
    images = touched.images
    rows = []
    for variant, make in (
        ("plain", features),
        ("wavelet_features", wavelet_features),
        ("image_features", image_features),
    ):
        seconds = []
        for _ in range(3):  # the fastest counts: the first may load a library
            with Stopwatch() as watch:
                found = make(images)
            seconds.append(watch.seconds)
        rows.append({"variant": variant, "classifier": None, "imprints": len(images), "metric": "features"})
        rows[-1] |= {"value": found.shape[1], "seconds": min(seconds), "note": None}
    return rows

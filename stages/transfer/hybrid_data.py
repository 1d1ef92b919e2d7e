"""The objects that are touched, seen as well: their pictures in files, and touches paired with looks."""

import numpy as np

from stages.classes import read_object
from stages.kit.files import read_arrays, write_arrays
from stages.kit.rng import rng
from stages.kit.run import DATA
from stages.networks.images import to_images

from .pictures import picture_images, take_pictures, viewpoints
from .switch import present
from .touches import Touches

STEP = 1 / 255  # of grey, the smallest
ITEM = "pictures."  # begins the name of the work on one object's pictures: the touches of it are work of its own


def items(members):
    """The names of the work of `process`, one for each object of members {class: its objects}."""
    return [ITEM + name for objects in members.values() for name in objects]


def process(name, folder, settings, seed):
    """Takes the pictures of the object of an item; writes hybrid/pictures/NAME.npz, returns no rows.

    images (k, size, size, 3) u1; viewpoints (k, 2), azimuth and elevation in degrees.
    """
    name = name.removeprefix(ITEM)
    mesh, _ = read_object(DATA / "classes" / f"{name}.npz")
    views = viewpoints(settings.hybrid_pictures, rng(seed, f"pictures {name}"))
    images = take_pictures(mesh, views, settings.size, settings.hybrid_colour)
    seen_from = np.array([(view.azimuth, view.elevation) for view in views])
    write_arrays(folder / "hybrid" / "pictures" / f"{name}.npz", images=images, viewpoints=seen_from)
    return []


def read_pictures(folder, members):
    """The pictures of members {class: its objects}, in their order, as Touches whose images are (k, h, w, 3) u1.

    Their `vertices` count the looks at an object: the place of each in its file. folder: data/transfer.
    """
    known = [(label, rank, name) for label, group in enumerate(members.values()) for rank, name in enumerate(group)]
    images = [read_arrays(folder / "hybrid" / "pictures" / f"{name}.npz")["images"] for _, _, name in known]
    counts = [len(part) for part in images]
    labels, ranks = (np.repeat([one[i] for one in known], counts) for i in range(2))
    looks = np.concatenate([np.arange(count) for count in counts])
    return Touches(np.concatenate(images), labels, ranks, looks, list(members))


def as_images(raw, size):
    """Images (k, 3, size, size) f4 in 0..1 of pictures (k, h, w, 3) or imprints (k, r, c), u1 or f4 in 0..1."""
    return picture_images(raw, size) if raw.ndim == 4 else imprint_images(raw, size)


def imprint_images(imprints, size):
    """Images (k, 3, size, size) f4 of imprints (k, r, c), as stages.networks.to_images, but no full contact is flat.

    A flat face pressed against the array gives zeros everywhere (distance 0), which is how the thesis says that there
    is no touch at all: its switch would mute the touch of a table top. One corner pixel gets one grey step more, so
    that the variance is not zero. An imprint of ones felt nothing and stays as it is: absent.
    """
    images = to_images(imprints, size)
    flat = ~present(images) & (images[:, 0, 0, 0] < 1)
    images[flat, 0, 0, 0] += STEP
    return images


def pair(picture_objects, touch_objects, random):
    """(k,) ids into the pictures: for each touch a picture of the same object.

    picture_objects (p,), touch_objects (k,) i8: which object each is of. An object's pictures are shuffled and used in
    turn, again from the first where it has more touches than pictures. Raises ValueError for an object that was touched
    and not seen.
    """
    picture_objects, touch_objects = np.asarray(picture_objects), np.asarray(touch_objects)
    found = np.empty(len(touch_objects), dtype=np.int64)
    for one in np.unique(touch_objects):
        own, touched = np.flatnonzero(picture_objects == one), touch_objects == one
        if not len(own):
            raise ValueError(f"object {one} was touched, but there is no picture of it")
        found[touched] = np.resize(random.permutation(own), touched.sum())
    return found

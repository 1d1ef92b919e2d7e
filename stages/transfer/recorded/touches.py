"""The common result of the readers, and how they read pictures."""

from dataclasses import dataclass
from pathlib import Path

import numpy as np
from PIL import Image

PICTURES = (".jpg", ".jpeg", ".png", ".bmp")
SIZE = 224  # pixels a side that pictures of a camera are brought to as they are read: the networks' own input


@dataclass(frozen=True, eq=False)
class Recorded:
    """Recorded touches as images, those of one class and one group in the order of the recording.

    images (k, r, c) u1 of one channel or (k, r, c, 3) u1; labels (k,) i8 into classes; groups (k,) strings: the object
    or the recording that a touch belongs to, so that a split can keep it on one side, or None where nobody knows.
    Raises ValueError for parts that do not fit together, less than two classes, or a class without touches.
    """

    images: np.ndarray
    labels: np.ndarray
    classes: list[str]
    groups: np.ndarray | None

    def __post_init__(self):
        shape = self.images.shape
        if self.images.dtype != np.uint8 or len(shape) not in (3, 4) or shape[3:] not in ((), (3,)):
            raise ValueError(f"images must be u1 of shape (k, r, c) or (k, r, c, 3), got {self.images.dtype} {shape}")
        if len(self.labels) != len(self.images) or (self.groups is not None and len(self.groups) != len(self.images)):
            raise ValueError(f"{len(self.images)} images need as many labels and groups")
        counts = np.bincount(self.labels, minlength=len(self.classes))
        if len(self.classes) < 2 or len(counts) > len(self.classes) or not counts.all():
            poor = [name for name, count in zip(self.classes, counts, strict=False) if not count]
            raise ValueError(
                f"two classes or more are needed, each with touches; without any: {', '.join(poor) or '-'}"
            )


def collect(files, size):
    """The Recorded of pictures: files {class: [(file, group)]}, each brought to size x size pixels in colour."""
    pairs = [pair for group in files.values() for pair in group]
    return Recorded(
        images=np.stack([read_picture(file, size) for file, _ in pairs]),
        labels=np.repeat(np.arange(len(files)), [len(group) for group in files.values()]),
        classes=list(files),
        groups=np.array([group for _, group in pairs]),
    )


def read_picture(file, size):
    """(size, size, 3) u1; raises ValueError that names a file which is no picture."""
    try:
        with Image.open(file) as image:
            return np.asarray(image.convert("RGB").resize((size, size), Image.Resampling.BILINEAR))
    except OSError:  # what Pillow raises for anything that is no picture
        raise ValueError(f"{file} is no readable picture: unpack the archive anew") from None


def folder(path, wanted):
    """The path of an unpacked data set; raises ValueError with what is wanted where it is no folder."""
    path = Path(path)
    if not path.is_dir():
        raise ValueError(f"{path} is no folder: give the unpacked {wanted}")
    return path


def pictures(path, wanted, anywhere=False):
    """The pictures in a folder (or anywhere below it), by name; raises ValueError where there are none."""
    found = [file for file in (path.rglob("*") if anywhere else path.glob("*")) if file.suffix.lower() in PICTURES]
    if not found:
        raise ValueError(f"{path} holds no picture ({' '.join(PICTURES)}); wanted is {wanted}")
    return sorted(found, key=natural)


def natural(file):
    """Sorts names by the numbers in them: 2 before 10."""
    digits = "".join(letter if letter.isdigit() else " " for letter in file.stem).split()
    return str(file.parent), [int(number) for number in digits], file.name

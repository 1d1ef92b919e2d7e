"""The common result of the readers, and the reading of picture files."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from PIL import Image

from haptic_glance.base.files import open_picture

PICTURES = (".jpg", ".jpeg", ".png", ".bmp")
SIZE = 224  # pixels a side to which camera pictures are resized: the input size of the networks


@dataclass(frozen=True, eq=False)
class Recorded:
    """Recorded touches as images; those of one class and group are in the order of the recording.

    images (k, r, c) u1 of one channel or (k, r, c, 3) u1; labels (k,) i8 into classes; groups (k,) strings: the object
    or the recording that a touch belongs to, so that a split can keep it together, or None where it is not known.
    Raises ValueError for parts that do not fit together, fewer than two classes, or a class without touches.
    """

    images: np.ndarray
    labels: np.ndarray
    classes: list[str]
    groups: np.ndarray | None

    def __post_init__(self) -> None:
        shape = self.images.shape
        if self.images.dtype != np.uint8 or len(shape) not in (3, 4) or shape[3:] not in ((), (3,)):
            raise ValueError(f"images must be u1 of shape (k, r, c) or (k, r, c, 3), got {self.images.dtype} {shape}")
        if len(self.labels) != len(self.images) or (self.groups is not None and len(self.groups) != len(self.images)):
            raise ValueError(f"{len(self.images)} images need as many labels and groups")
        counts = np.bincount(self.labels, minlength=len(self.classes))
        if len(self.classes) < 2 or len(counts) > len(self.classes) or not counts.all():
            empty = [name for name, count in zip(self.classes, counts, strict=False) if not count]
            raise ValueError(
                f"two classes or more are needed, each with touches; classes without any: {', '.join(empty) or '-'}"
            )


def collect(files: Mapping[str, Sequence[tuple[Path, str]]], size: int) -> Recorded:
    """The Recorded of pictures: files {class: [(file, group)]}, resized to size x size pixels in colour."""
    pairs = [pair for group in files.values() for pair in group]
    return Recorded(
        images=np.stack([read_picture(file, size) for file, _ in pairs]),
        labels=np.repeat(np.arange(len(files)), [len(group) for group in files.values()]),
        classes=list(files),
        groups=np.array([group for _, group in pairs]),
    )


def read_picture(file: Path, size: int) -> np.ndarray:
    """(size, size, 3) u1: a picture file; raises ValueError, which names the file, where it is not a picture."""
    image = open_picture(file.read_bytes(), file).convert("RGB")
    return np.asarray(image.resize((size, size), Image.Resampling.BILINEAR))


def existing_folder(path: str | Path, wanted: str) -> Path:
    """The folder of an unpacked data set; raises ValueError with the layout `wanted` where it is not a folder."""
    path = Path(path)
    if not path.is_dir():
        raise ValueError(f"{path} is not a folder: give the unpacked {wanted}")
    return path


def pictures(path: Path, wanted: str, anywhere: bool = False) -> list[Path]:
    """The pictures in a folder (or anywhere below it), sorted by name; raises ValueError where there are none."""
    found = [file for file in (path.rglob("*") if anywhere else path.glob("*")) if file.suffix.lower() in PICTURES]
    if not found:
        raise ValueError(f"{path} holds no picture ({' '.join(PICTURES)}); expected is {wanted}")
    return sorted(found, key=natural_key)


def natural_key(file: Path) -> tuple[str, list[int], str]:
    """A sort key for file names by the numbers in them: 2 before 10."""
    digits = "".join(letter if letter.isdigit() else " " for letter in file.stem).split()
    return str(file.parent), [int(number) for number in digits], file.name

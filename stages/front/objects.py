"""Which objects the search may see, and which it may not: those that confirm what it found."""

import zlib
from collections import Counter
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

from haptic_glance.base.files import object_files
from haptic_glance.base.rng import rng
from stages.meshes.classes import read_classes

SIZES = ("medium", "small")  # of five basic shapes, which are equal to the large one once they are scaled
SIX = 6  # objects of one question: who of these six is it (T4.2.4)


@dataclass(frozen=True)
class Objects:
    """Shapes to tell apart, and classes {class: objects} whose unseen objects are to be named."""

    shapes: tuple[str, ...]
    classes: Mapping[str, tuple[str, ...]]

    def sixes(self, shapes: int, count: int, seed: int) -> list[list[str]]:
        """`count` sets of six of the first `shapes`, drawn so that each of these is in as many of them, or in one more.

        ValueError for fewer than six.
        """
        few, taken, sets = self.shapes[:shapes], Counter(), []
        if len(few) < SIX:
            raise ValueError(f"{len(few)} shapes to tell apart are too few: {SIX} are needed")
        for number in range(count):
            order = rng(seed, f"six {number}").permutation(few).tolist()
            sets.append(sorted(sorted(order, key=lambda name: taken[name])[:SIX]))  # of equals in the order drawn
            taken.update(sets[-1])
        return sets


def halves(shapes: Iterable[str], classes: Mapping[str, Sequence[str]], seed: int) -> tuple[Objects, Objects]:
    """(objects of the search, objects of the confirmation), which share neither a shape nor a class.

    A shape or class is of the search by its place in the order of a checksum of the seed and its name.
    """
    first, second = (
        Objects(tuple(part), {name: tuple(classes[name]) for name in sorted(groups)})
        for part, groups in zip(_halved(shapes, seed), _halved(classes, seed), strict=True)
    )
    return first, second


def _halved(names, seed):
    order = sorted(names, key=lambda name: (zlib.crc32(f"{seed} {name}".encode()), name))
    return order[: len(order) // 2], order[len(order) // 2 :]


def shapes_of(names: Iterable[str]) -> list[str]:
    """The names without those that are another size of a shape among them."""
    every = set(names)
    return sorted(
        name
        for name in every
        if not any(name.endswith(size) and f"{name.removesuffix(size)}large" in every for size in SIZES)
    )


def read_objects(data: Path, shapes: str, classes: str) -> tuple[list[str], dict[str, list[str]], dict[str, Path]]:
    """(shapes of one data set, {class: objects} of another, {object: its mesh} of both), from data/SET/meshes.

    ValueError where meshes are not there, where an object is of both sets (it could be searched on and confirm), and
    for a class of one object.
    """
    files: dict[str, Path] = {}
    for dataset in (shapes, classes):
        folder = data / dataset / "meshes"
        names = object_files(folder)
        if not names:
            remedy = f"`python -m stages.compose 'sets=[{shapes},{classes}]'`, then `dvc repro meshes@{dataset}`"
            raise ValueError(f"{folder} holds no meshes: {remedy}")
        if both := sorted(files.keys() & set(names)):
            raise ValueError(f"{', '.join(both)}: objects of both {shapes} and {classes}; name other --classes")
        files |= {name: folder / f"{name}.npz" for name in names}
    groups = read_classes(data / classes / "meshes")
    if few := [name for name, members in groups.items() if len(members) < 2]:
        raise ValueError(f"{classes}: of class {', '.join(few)} no object can be held out: two are needed")
    return shapes_of(object_files(data / shapes / "meshes")), groups, files

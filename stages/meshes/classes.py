"""Classes of several objects that are to be recognised by touch (T4.3.2, T4.4.10)."""

from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path
from typing import Any

from haptic_glance.base.files import read_table

CLASSES = "classes.csv"  # in data/SET/meshes: the class of each object, in the order of meshes.classes


def read_classes(folder: str | Path) -> dict[str, list[str]]:
    """{class: its objects} of data/SET/meshes, in the order of meshes.classes; objects that were refused are not there.

    Raises ValueError where the data set has no classes.
    """
    path = Path(folder) / CLASSES
    if not path.exists():
        raise ValueError(f"{path} is not there: name the classes of this data set in meshes.classes")
    table = read_table(path, dtype={"class": str, "object": str})
    return {str(name): list(rows["object"]) for name, rows in table.groupby("class", sort=False)}


def chosen_objects(objects: Sequence[str], classes: Mapping[str, Sequence[str]]) -> list[str]:
    """The objects to take: those named, or else those of all classes; an empty list stands for all of the source.

    Raises ValueError for a class without objects and for an object that is named twice.
    """
    if not all(classes.values()):
        raise ValueError("meshes.classes: every class must name at least one object")
    members = [name for names in classes.values() for name in names]
    twice = sorted({name for name in members if members.count(name) > 1})
    if twice:
        raise ValueError(f"meshes.classes: {', '.join(twice)} named twice; an object belongs to one class")
    return list(objects) or members


def small_classes(classes: Mapping[str, Sequence[str]], accepted: Sequence[str]) -> Iterator[dict[str, Any]]:
    """Rows with a note, one per class that is left with fewer than two objects."""
    for name, objects in classes.items():
        left = len(set(objects) & set(accepted))
        if left < 2:
            note = f"class {name} has {left} of its {len(objects)} objects: none of it can be held out"
            yield {"group": name, "metric": "objects", "value": left, "note": note}

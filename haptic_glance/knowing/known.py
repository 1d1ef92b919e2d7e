"""Objects that can be known without a file of one's own, and those of a folder."""

from collections.abc import Callable
from pathlib import Path

import numpy as np
import trimesh
from trimesh import creation

from stages.kit import Mesh
from stages.kit.files import read_mesh
from stages.meshes import MeshError, load, normalise, rotate_to_z_up
from stages.meshes.load import FORMATS

SIZES = ("medium", "small")  # the household set has its basic shapes in three sizes, which `normalise` makes equal


PRIMITIVES: dict[str, Callable[[], trimesh.Trimesh]] = {
    "ball": lambda: creation.icosphere(subdivisions=4),
    "box": lambda: creation.box((1.0, 0.7, 0.5)),
    "capsule": lambda: creation.capsule(height=1.0, radius=0.3),
    "cone": lambda: creation.cone(radius=0.4, height=1.0, sections=64),
    "cylinder": lambda: creation.cylinder(radius=0.3, height=1.0, sections=64),
    "torus": lambda: creation.torus(major_radius=1.0, minor_radius=0.35),
}


def primitives() -> dict[str, Mesh]:
    """{name: normalised mesh} of six basic shapes."""
    shapes = {name: make() for name, make in PRIMITIVES.items()}
    return {
        name: normalise(Mesh(np.asarray(shape.vertices), np.asarray(shape.faces))) for name, shape in shapes.items()
    }


def known_objects(folder: Path, most: int = 60) -> tuple[dict[str, Mesh], list[str]]:
    """({name: normalised mesh}, what was left out) of the first `most` meshes of a folder, in alphabetical order.

    The folder holds files of meshes, or is data/SET/meshes of the pipeline; one that is not there holds none.
    """
    files = sorted(path for path in folder.glob("*") if path.suffix.lower() in (*FORMATS, ".npz"))
    stems = {path.stem for path in files}
    files = [path for path in files if not _is_another_size(path.stem, stems)]
    found, notes = {}, [f"{path.name}: more than {most} objects" for path in files[most:]]
    for path in files[:most]:
        try:
            found[path.stem] = read_mesh(path) if path.suffix == ".npz" else normalise(rotate_to_z_up(load(path)))
        except (MeshError, ValueError, KeyError, OSError) as error:
            notes.append(f"{path.name}: {error}")
    return found, notes


def _is_another_size(stem, stems):
    return any(stem.endswith(size) and stem.removesuffix(size) + "large" in stems for size in SIZES)

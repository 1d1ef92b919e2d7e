"""Objects to know: basic shapes, and the meshes of a folder."""

from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import numpy as np

from haptic_glance.base.extras import MissingExtra
from haptic_glance.base.files import read_mesh
from haptic_glance.base.lazy import trimesh
from haptic_glance.mesh import MeshError, normalise, rotate_to_z_up
from haptic_glance.mesh.axes import Axis, axis_named
from haptic_glance.mesh.files import FORMATS, MeshLike, as_stated, names_of, with_known_up
from haptic_glance.mesh.mesh import Mesh
from haptic_glance.mesh.repair import area_share

SIZES = ("medium", "small")  # the household set has its basic shapes in three sizes, which `normalise` makes equal


PRIMITIVES: dict[str, Callable[[], "trimesh.Trimesh"]] = {
    "ball": lambda: trimesh.creation.icosphere(subdivisions=4),
    "box": lambda: trimesh.creation.box((1.0, 0.7, 0.5)),
    "capsule": lambda: trimesh.creation.capsule(height=1.0, radius=0.3),
    "cone": lambda: trimesh.creation.cone(radius=0.4, height=1.0, sections=64),
    "cylinder": lambda: trimesh.creation.cylinder(radius=0.3, height=1.0, sections=64),
    "torus": lambda: trimesh.creation.torus(major_radius=1.0, minor_radius=0.35),
}


def primitives() -> dict[str, Mesh]:
    """{name: normalised mesh} of six basic shapes."""
    shapes = {name: make() for name, make in PRIMITIVES.items()}
    return {
        name: normalise(Mesh(np.asarray(shape.vertices), np.asarray(shape.faces))) for name, shape in shapes.items()
    }


def known_objects(
    folder: str | Path, most: int = 60, sized: bool = False, up: Axis | None = None
) -> tuple[dict[str, Mesh], list[str]]:
    """Reads the meshes of a folder.

    Parameters
    ----------
    folder : path
        A folder of mesh files, or data/SET/meshes of the pipeline; a folder that is absent holds none.
    most : int
        Number of meshes at most, in alphabetical order.
    sized : bool
        Whether the files are in one unit, so that their sizes count. False: the meshes are normalised.
    up : str or (3,) array_like, optional
        The axis that points up in all files, as of `load`. None: as each file says, or as its shape suggests.

    Returns
    -------
    meshes : dict of str to Mesh
        Meshes by name, z up.
    left_out : list of str
        Names of the files that were left out, with the reasons.

    Raises
    ------
    ValueError
        For a file in place of a folder.

    Warns
    -----
    UserWarning
        For a mesh that does not say which axis points up.
    """
    if Path(folder).is_file():
        raise ValueError(f"{folder} is a file: give the folder that holds it")
    shown = sorted(path for path in Path(folder).glob("*") if not path.name.startswith("."))
    files = [path for path in shown if path.suffix.lower() in (*FORMATS, ".npz")]
    stems = {path.stem for path in files}
    files = [path for path in files if path.suffix != ".npz" or not _is_another_size(path.stem, stems)]
    meshes, notes = {}, [f"{path.name}: more than {most} objects" for path in files[most:]]
    for path, name in zip(files[:most], names_of(files), strict=False):
        try:
            meshes[name] = read_object(path, sized, up)
        except (MeshError, MissingExtra, ValueError, KeyError, OSError) as error:
            notes.append(f"{path.name}: {str(error).removeprefix(f'{path}: ')}")
    return meshes, notes


def read_object(path: Path, sized: bool = False, up: Axis | None = None) -> Mesh:
    """One mesh of `known_objects`; an error where the file holds none that can be touched."""
    if path.suffix == ".npz":
        mesh = read_mesh(path)
    else:
        mesh = upright_named(path.name, path if up is None else replace(as_stated(path), up=axis_named(up)))
    area_share(mesh)  # or `learn` would refuse all
    return mesh if sized else normalise(mesh)


def _is_another_size(stem, stems):
    return any(stem.endswith(size) and stem.removesuffix(size) + "large" in stems for size in SIZES)


def upright_named(name: str, mesh: MeshLike) -> Mesh:
    """The Mesh turned to z up; a warning names it where nothing says which axis points up."""
    return rotate_to_z_up(with_known_up(mesh, reason=f"{name} does not say which axis points up"))

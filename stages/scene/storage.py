"""The files of an LOD chain, data/SET/scene/levels/NAME/KIND_FACES.npz and KIND.csv with the errors; those of plans."""

from collections.abc import Mapping, Sequence
from pathlib import Path

import numpy as np
import pandas as pd

from haptic_glance.base.files import read_arrays, read_mesh, read_table, write_arrays, write_mesh, write_table
from haptic_glance.lod.scene.chain import Level, finest
from haptic_glance.mesh.mesh import Mesh

DIGITS = 9  # decimals of an error, enough for a mesh of unit size


def write_chain(folder: Path, kind: str, levels: Sequence[Level]) -> None:
    """Writes the levels below the finest, and KIND.csv: faces and the errors of each."""
    for level in levels[1:]:
        write_mesh(folder / f"{kind}_{level.faces}.npz", level.mesh)
    errors = [{name: round(error, DIGITS) for name, error in level.error.items()} for level in levels]
    rows = [{"faces": level.faces} | error for level, error in zip(levels, errors, strict=True)]
    write_table(folder / f"{kind}.csv", pd.DataFrame(rows))


def read_chain(folder: Path, kind: str, full: Level) -> tuple[Level, ...]:
    """The Levels of an object; full: the finest one, which all kinds share."""
    table = read_table(folder / f"{kind}.csv").set_index("faces")
    below = [Level(read_mesh(folder / f"{kind}_{faces}.npz"), dict(row)) for faces, row in table.iloc[1:].iterrows()]
    return (full, *below)


def read_chains(folder: Path, kind: str, full: Mapping[str, Level]) -> dict[str, tuple[Level, ...]]:
    """dict name -> Levels; full: dict name -> the finest Level."""
    return {name: read_chain(folder / name, kind, level) for name, level in full.items()}


def finest_levels(meshes: Mapping[str, Mesh]) -> dict[str, Level]:
    """dict name -> the finest Level, of dict name -> Mesh."""
    return {name: finest(mesh) for name, mesh in meshes.items()}


def write_plans(folder: Path, name: str, levels: Mapping[str, np.ndarray]) -> None:
    """Writes the levels (frames, objects) of plans for one case; levels: dict method.matched -> levels."""
    write_arrays(folder / f"plans/{name}.npz", **levels)


def read_plans(folder: Path, name: str) -> dict[str, np.ndarray]:
    """What write_plans wrote."""
    return read_arrays(folder / f"plans/{name}.npz")

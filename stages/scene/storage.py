"""The files of a ladder: data/scene/levels/NAME/KIND_FACES.npz, and KIND.csv with the errors."""

import pandas as pd

from stages.kit.files import read_mesh, read_table, write_mesh, write_table

from .ladder import Level, finest

DIGITS = 9  # decimals of an error, which a mesh of unit size does not need


def write_ladder(folder, kind, levels):
    """Writes the levels below the finest, and KIND.csv: faces and the errors of each."""
    for level in levels[1:]:
        write_mesh(folder / f"{kind}_{level.faces}.npz", level.mesh)
    errors = [{name: round(error, DIGITS) for name, error in level.error.items()} for level in levels]
    rows = [{"faces": level.faces} | error for level, error in zip(levels, errors, strict=True)]
    write_table(folder / f"{kind}.csv", pd.DataFrame(rows))


def read_ladder(folder, kind, full):
    """The Levels of an object; full: the finest one, which all kinds share."""
    table = read_table(folder / f"{kind}.csv").set_index("faces")
    below = [Level(read_mesh(folder / f"{kind}_{faces}.npz"), dict(row)) for faces, row in table.iloc[1:].iterrows()]
    return (full, *below)


def read_ladders(folder, kind, full):
    """dict name -> Levels; full: dict name -> the finest Level."""
    return {name: read_ladder(folder / name, kind, level) for name, level in full.items()}


def full_of(meshes):
    """dict name -> the finest Level of dict name -> Mesh."""
    return {name: finest(mesh) for name, mesh in meshes.items()}

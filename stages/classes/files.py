"""The files of the stage: data/classes/NAME.npz, classes.csv and refused.csv."""

from pathlib import Path

from stages.kit import Mesh
from stages.kit.files import read_arrays, read_table, write_arrays

TABLE = "classes.csv"
POINTS = ".points"  # ends the name of an array of vertex ids; before it stands the detector


def write_object(path, mesh, points):
    """Writes a mesh with its salient points: a dict detector -> (k,) vertex ids, most salient first."""
    colors = {} if mesh.colors is None else {"colors": mesh.colors}
    ids = {f"{method}{POINTS}": values for method, values in points.items()}
    write_arrays(path, vertices=mesh.vertices, faces=mesh.faces, **colors, **ids)


def read_object(path):
    """(Mesh, dict detector -> (k,) vertex ids, most salient first) of data/classes/NAME.npz."""
    arrays = read_arrays(path)
    points = {key.removesuffix(POINTS): values for key, values in arrays.items() if key.endswith(POINTS)}
    return Mesh(**{key: values for key, values in arrays.items() if not key.endswith(POINTS)}), points


def read_classes(folder):
    """Dict class -> its objects, in the order of classes.names, of data/classes; what was refused is not among them."""
    table = read_table(Path(folder) / TABLE).astype({"class": str, "object": str})
    return {name: list(rows["object"]) for name, rows in table.groupby("class", sort=False)}

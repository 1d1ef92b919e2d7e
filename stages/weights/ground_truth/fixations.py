"""Fixation density maps of Lavoue et al. 2018, Visual Attention for Rendered 3D Shapes (T3.3.2, T [236]).

Nineteen people looked at images of 32 meshes from three viewpoints, 300, 413 and 599. The published archives
FixationMaps.zip and CentricityAndVisibilityMaps.zip hold FixationMaps/NAME_VIEWnorm.txt (a density, spread by one
degree of visual angle) and CentricityAndVisibilityMaps/NAME_VIEW_visibility.txt (0 or 1), with one line per vertex. The
vertices are those of 3DModels-Simplif/NAME.obj.
"""

import re
from collections.abc import Callable, Mapping

import numpy as np

from haptic_glance.mesh.mesh import Mesh

VIEWS = ("300", "413", "599")
DENSITY, VISIBLE = "FixationMaps/{}_{}norm.txt", "CentricityAndVisibilityMaps/{}_{}_visibility.txt"
Files = list[tuple[str, Callable[[], bytes]]]  # (path, function that reads the bytes) of each


def fixation_files(files: Mapping[str, Callable[[], bytes]]) -> dict[str, Files]:
    """{object: its files, density and visibility of each view} of a collection (stages.meshes.sources).

    Raises ValueError that names a map which an object lacks.
    """
    matches = [(re.search(r"(FixationMaps|CentricityAndVisibilityMaps)/[^/]+\.txt$", path), path) for path in files]
    maps = {match[0]: (path, files[path]) for match, path in matches if match}
    names = sorted({path.split("/")[1].rsplit("_", 1)[0] for path in maps if path.endswith("norm.txt")})
    wanted = {name: [form.format(name, view) for view in VIEWS for form in (DENSITY, VISIBLE)] for name in names}
    missing = sorted(path for paths in wanted.values() for path in paths if path not in maps)
    if missing:
        raise ValueError(f"no {', '.join(missing)}: unpack both archives")
    return {name: [maps[path] for path in paths] for name, paths in wanted.items()}


def fixations_on_vertices(files: Files, mesh: Mesh) -> np.ndarray:
    """(n,) f8: how much people looked at each vertex of a mesh, the mean of the views that see it.

    files: of one object, as fixation_files gives them. A density counts by the area of its vertex. Raises ValueError
    that names the file where a map is not a list of numbers, one per vertex (the map of turbine is published with one
    line too few).
    """
    values = np.array([_values(path, content(), len(mesh.vertices)) for path, content in files])
    densities, visible = values[0::2], values[1::2] > 0
    return (densities * visible).sum(axis=0) / np.maximum(visible.sum(axis=0), 1) * mesh.vertex_areas


def _values(path, content, vertices):
    try:
        values = np.array(content.split(), dtype=np.float64)
    except ValueError as error:
        raise ValueError(f"{path}: not one number per line ({error})") from None
    if len(values) != vertices:
        raise ValueError(f"{path} has {len(values)} values for {vertices} vertices: is it the map of this mesh?")
    if not (np.isfinite(values) & (values >= 0)).all():
        raise ValueError(f"{path} holds NaN or negative values")
    return values

"""Fixation density maps of Lavoue et al. 2018, Visual Attention for Rendered 3D Shapes (T3.3.2, T [236]).

Nineteen people looked at images of 32 meshes from three viewpoints, 300, 413 and 599. The published archives
FixationMaps.zip and CentricityAndVisibilityMaps.zip hold FixationMaps/NAME_VIEWnorm.txt (a density, spread by one
degree of visual angle) and CentricityAndVisibilityMaps/NAME_VIEW_visibility.txt (0 or 1), with one line per vertex. The
vertices are those of 3DModels-Simplif/NAME.obj.
"""

from dataclasses import dataclass
from pathlib import Path

import numpy as np

from stages.meshes.sources import collection_files, match_files

VIEWS = ("300", "413", "599")
PUBLISHED = (
    "fixation",
    "FixationMaps/*norm.txt and CentricityAndVisibilityMaps/*_visibility.txt (FixationMaps.zip and"
    " CentricityAndVisibilityMaps.zip, both unpacked)",
    "https://perso.liris.cnrs.fr/guillaume.lavoue/data/saliency",
)


@dataclass(frozen=True, eq=False)
class Fixations:
    """One viewpoint: density (n,) f8 of fixations, zero where nobody looked; visible (n,) boolean."""

    density: np.ndarray
    visible: np.ndarray


def read_fixations(folder: str | Path, name: str, vertices: int) -> dict[str, Fixations]:
    """dict view (`300`, `413`, `599`) -> Fixations of the mesh `name` with a number of `vertices`.

    folder: with both archives unpacked, or a zip archive with both folders. Raises FetchError, saying what to get, when
    it is missing, ValueError when a map is not a list of numbers, one per vertex (the map of turbine is published with
    one line too few).
    """
    files = collection_files(folder, *PUBLISHED)
    maps = match_files(files, r"FixationMaps/([^/]+)norm\.txt")
    visibilities = match_files(files, r"CentricityAndVisibilityMaps/([^/]+)_visibility\.txt")
    return {
        view: Fixations(
            _values(maps, f"{name}_{view}", vertices), _values(visibilities, f"{name}_{view}", vertices) > 0
        )
        for view in VIEWS
    }


def _values(files, key, vertices):
    if key not in files:
        available = sorted({name.rsplit("_", 1)[0] for name in files})
        raise ValueError(f"no map {key}: there are maps of {', '.join(available)}")
    path, content = files[key]
    try:
        values = np.array(content().split(), dtype=np.float64)
    except ValueError as error:
        raise ValueError(f"{path}: not one number per line ({error})") from None
    if len(values) != vertices:
        raise ValueError(f"{path} has {len(values)} values for {vertices} vertices: is it the map of this mesh?")
    if not (np.isfinite(values) & (values >= 0)).all():
        raise ValueError(f"{path} holds NaN or negative values")
    return values

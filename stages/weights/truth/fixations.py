"""Fixation density maps of Lavoue et al. 2018, Visual Attention for Rendered 3D Shapes (T3.3.2, T [236]).

Nineteen people looked at pictures of 32 meshes from three viewpoints, 300, 413 and 599. The published archives
FixationMaps.zip and CentricityAndVisibilityMaps.zip hold, one number a vertex and line, FixationMaps/NAME_VIEWnorm.txt
(a density, spread by one degree of sight) and CentricityAndVisibilityMaps/NAME_VIEW_visibility.txt (0 or 1). The
vertices are those of 3DModels-Simplif/NAME.obj.
"""

from dataclasses import dataclass

import numpy as np

from stages.meshes.sources import named, stored_files

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


def read_fixations(folder, name, vertices):
    """dict view (`300`, `413`, `599`) -> Fixations of the mesh `name`, which has as many `vertices`.

    folder: where the two archives lie unpacked, or one zip with both folders. Raises FetchError that says what to get
    when it is not there, ValueError when a map is no list of numbers or not as long as the mesh has vertices (turbine
    is published with a line too few, and which one is not known).
    """
    files = stored_files(folder, *PUBLISHED)
    maps = named(files, r"FixationMaps/([^/]+)norm\.txt")
    visibilities = named(files, r"CentricityAndVisibilityMaps/([^/]+)_visibility\.txt")
    return {
        view: Fixations(
            _values(maps, f"{name}_{view}", vertices), _values(visibilities, f"{name}_{view}", vertices) > 0
        )
        for view in VIEWS
    }


def _values(found, key, vertices):
    if key not in found:
        known = sorted({name.rsplit("_", 1)[0] for name in found})
        raise ValueError(f"no map {key}; there are {', '.join(known)}")
    path, content = found[key]
    try:
        values = np.array(content().split(), dtype=np.float64)
    except ValueError as error:
        raise ValueError(f"{path}: not a number a line ({error})") from None
    if len(values) != vertices:
        raise ValueError(f"{path} has {len(values)} values for {vertices} vertices: is it the map of this mesh?")
    if not (np.isfinite(values) & (values >= 0)).all():
        raise ValueError(f"{path} holds NaN or negative values")
    return values

"""The features of the fixation model at each vertex: symmetry, position, visibility and curvature."""

from collections.abc import Sequence

import numpy as np

from stages.conspicuity.curvature import mean_curvature
from stages.kit import Mesh, Viewpoint

CURVATURE_SCALES = (
    0.01,
    0.02,
)  # of the diagonal: the finest curvature visible from a distance, and a coarser one
# The fewest channels without measurable loss (reports/tradeoff/attention_settings.png). The meshes with gaze have no
# texture or colour; on meshes that have, channels of the image may help.
CHANNEL_FEATURES = ("symmetry",)
POSITION_FEATURES = ("height", "height_squared", "upright", "sideways", "visible", "convexity", "detail")
# The standard deviation of each feature on a typical object: the median of 19 meshes with human gaze. A feature that
# varies by less than half of this is not scaled up to deviation 1, so that noise on a sphere is not amplified.
TYPICAL_DEVIATION = {
    "color": 0.02, "contrast": 0.025, "curvature": 0.030, "dkl": 0.019, "edge": 0.029, "entropy": 0.0037,
    "intensity": 0.017, "orientation": 0.025, "symmetry": 0.024, "height": 0.19, "height_squared": 0.036,
    "upright": 0.31, "sideways": 0.45, "visible": 0.15, "convexity": 1.8, "detail": 0.74,
}  # fmt: skip


def vertex_features(
    mesh: Mesh, viewpoints: Sequence[Viewpoint], facing: np.ndarray, channels: dict[str, np.ndarray]
) -> dict[str, np.ndarray]:
    """dict name -> (n,) f8, each with area-weighted mean 0 and deviation 1, or less for a feature that hardly varies.

    mesh: normalised; facing (v, n): stages.conspicuity.facing of the viewpoints; channels: dict name -> (n,), their
    conspicuity on the vertices (ViewMaps.vertex_values), may be empty. They come first, then POSITION_FEATURES: height
    over the centre of the bounding box and its square (people look at the upper part, and away from the ends); upright,
    |z| of the normal (a floor or a lid); sideways, the facing summed over views from the side; visible, the share of
    all views that see the vertex; convexity, the signed mean curvature with the finest smoothing on a log scale; and
    detail, its difference to the coarser smoothing (centre and surround, as in Lee 2005). None depends on the
    tessellation.
    """
    values = channels | _position(mesh, viewpoints, facing)
    return {
        name: standardise(feature, mesh.vertex_areas, TYPICAL_DEVIATION[name] / 2) for name, feature in values.items()
    }


def _position(mesh, viewpoints, facing):
    height = mesh.vertices[:, 2]
    elevation = np.radians([viewpoint.elevation for viewpoint in viewpoints])
    side = np.cos(2 * elevation).clip(0)  # 1 on the horizon, 0 from 45 degrees on
    fine, coarse = (mean_curvature(mesh, smoothing) * mesh.diagonal for smoothing in CURVATURE_SCALES)
    return {
        "height": height,
        "height_squared": height**2,
        "upright": np.abs(mesh.vertex_normals[:, 2]),
        "sideways": side @ facing,
        "visible": (facing > 0).mean(axis=0),
        "convexity": np.sign(fine) * np.log1p(np.abs(fine)),
        "detail": np.log1p(np.abs(fine - coarse)),
    }


def standardise(values: np.ndarray, areas: np.ndarray, min_deviation: float = 0.0) -> np.ndarray:
    """values (n,) minus their area-weighted mean, over their deviation, or over min_deviation if that is larger.

    Zeros if the values are constant, and at vertices without area.
    """
    total = areas.sum()
    if not total > 0:
        return np.zeros(len(values))
    centred = np.where(areas > 0, values - (values * areas).sum() / total, 0)
    deviation = np.sqrt((centred**2 * areas).sum() / total)
    level = np.abs(values[areas > 0]).max()
    return centred / max(deviation, min_deviation) if deviation > 1e-9 * max(level, 1e-30) else np.zeros(len(values))

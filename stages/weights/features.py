"""What the fixation model knows of each vertex: its symmetry, where the place is, who sees it, how it bends."""

import numpy as np

from stages.conspicuity.curvature import mean_curvature

REACHES = (0.01, 0.02)  # of the diagonal: the finest bend a person sees from afar, and the next coarser one
# The fewest channels that lose nothing measurable (reports/tradeoff/attention_settings.png). The meshes with gaze have
# no texture or colour: where yours have, the channels of the image may tell more.
SEEN = ("symmetry",)
POSITION = ("height", "height_squared", "upright", "sideways", "visible", "convexity", "detail")
# The deviation that a feature has on a common object, the median of 19 meshes with human gaze. Where a feature varies
# less than half of this it says little and is not blown up: the noise on a sphere must not become its features.
COMMON = {
    "color": 0.02, "contrast": 0.025, "curvature": 0.030, "dkl": 0.019, "edge": 0.029, "entropy": 0.0037,
    "intensity": 0.017, "orientation": 0.025, "symmetry": 0.024, "height": 0.19, "height_squared": 0.036,
    "upright": 0.31, "sideways": 0.45, "visible": 0.15, "convexity": 1.8, "detail": 0.74,
}  # fmt: skip


def vertex_features(mesh, viewpoints, facing, channels):
    """dict name -> (n,) f8, each with area-weighted mean 0 and deviation 1 or, where it hardly varies, less.

    mesh: normalised; facing (v, n): stages.conspicuity.facing of the viewpoints; channels: dict name -> (n,), their
    conspicuity on the vertices (Sight.averaged), may be empty. They come first, then POSITION: height over the centre
    of the bounding box and its square (people look at the upper part, and away from the ends); upright, |z| of the
    normal (a floor or a lid); sideways, how squarely views from the side see the place, visible, the share of all views
    that see it; convexity, the signed mean curvature over the finest reach on a log scale, and detail, its difference
    to the next coarser reach (centre and surround, as in Lee 2005). None depends on the tessellation.
    """
    values = channels | _position(mesh, viewpoints, facing)
    return {name: standardise(feature, mesh.vertex_areas, COMMON[name] / 2) for name, feature in values.items()}


def _position(mesh, viewpoints, facing):
    height = mesh.vertices[:, 2]
    elevation = np.radians([viewpoint.elevation for viewpoint in viewpoints])
    side = np.cos(2 * elevation).clip(0)  # 1 on the horizon, 0 from 45 degrees on
    fine, coarse = (mean_curvature(mesh, reach) * mesh.diagonal for reach in REACHES)
    return {
        "height": height,
        "height_squared": height**2,
        "upright": np.abs(mesh.vertex_normals[:, 2]),
        "sideways": side @ facing,
        "visible": (facing > 0).mean(axis=0),
        "convexity": np.sign(fine) * np.log1p(np.abs(fine)),
        "detail": np.log1p(np.abs(fine - coarse)),
    }


def standardise(values, areas, least=0.0):
    """values (n,) less their area-weighted mean, over their deviation or `least` where that is larger.

    Zeros for a constant, and where there is no area.
    """
    total = areas.sum()
    if not total > 0:
        return np.zeros(len(values))
    centred = np.where(areas > 0, values - (values * areas).sum() / total, 0)
    deviation = np.sqrt((centred**2 * areas).sum() / total)
    level = np.abs(values[areas > 0]).max()
    return centred / max(deviation, least) if deviation > 1e-9 * max(level, 1e-30) else np.zeros(len(values))

"""Attention of networks: Grad-CAM maps fused over tasks, projected to the surface, compared with human gaze (T3.3)."""

from haptic_glance.base.lazy import lazy_names

_MODULES = {
    "centre_distance": "centres",
    "curvature_shares": "shape",
    "eccentricity": "shape",
    "entropy": "fusion",
    "fuse": "fusion",
    "gaussian_curvature": "shape",
    "half_share": "concentration",
    "highest_level": "fusion",
    "mean_over_views": "vertices",
    "project_by_boxes": "vertices",
    "project_to_vertices": "vertices",
    "subtractive_clusters": "subtractive",
    "viewpoint_sphere": "viewpoints",
}
__all__ = list(_MODULES)  # pyright: ignore[reportUnsupportedDunderAll]
__getattr__ = lazy_names(__name__, _MODULES)

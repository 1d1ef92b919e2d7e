"""Attention of networks: Grad-CAM maps fused over tasks, projected to the surface, compared with human gaze (T3.3)."""

from stages.kit.lazy import lazy_names

_MODULES = {  # public name -> its module
    "viewpoint_sphere": "viewpoints",
    "gaussian_curvature": "shape",
    "curvature_shares": "shape",
    "eccentricity": "shape",
    "grad_cam": "cam",
    "entropy": "fusion",
    "fuse": "fusion",
    "highest_level": "fusion",
    "project_to_vertices": "vertices",
    "project_by_boxes": "vertices",
    "mean_over_views": "vertices",
    "centre_distance": "centres",
    "half_share": "concentration",
    "subtractive_clusters": "subtractive",
}
__all__ = list(_MODULES)  # pyright: ignore[reportUnsupportedDunderAll]
__getattr__ = lazy_names(__name__, _MODULES)

"""Where a network looks: Grad-CAM attention fused over tasks, projected to the surface, beside human gaze (T3.3)."""

from importlib import import_module

_HOME = {
    "sphere": "viewpoints",
    "gaussian_curvature": "shape",
    "curvature_shares": "shape",
    "eccentricity": "shape",
    "grad_cam": "cam",
    "entropy": "fusion",
    "fuse": "fusion",
    "narrowed": "fusion",
    "on_vertices": "vertices",
    "over_views": "vertices",
    "centre_distance": "centres",
    "subtractive_clusters": "subtractive",
    "read_attention": "files",
}
__all__ = list(_HOME)


def __getattr__(name):
    # torch takes seconds to import, and whoever reads only the schema does without it.
    if name in _HOME:
        return getattr(import_module(f".{_HOME[name]}", __name__), name)
    raise AttributeError(f"module {__name__!r} has no attribute {name!r}")

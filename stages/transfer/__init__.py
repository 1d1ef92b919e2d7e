"""Trains networks on the touches of a data set (T chapter 5)."""

from haptic_glance.base.lazy import lazy_names

_MODULES = {
    "Touches": "touches",
    "press_touches": "touches",
    "stratified_split": "split",
}
__all__ = list(_MODULES)  # pyright: ignore[reportUnsupportedDunderAll]
__getattr__ = lazy_names(__name__, _MODULES)

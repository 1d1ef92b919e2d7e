"""From vision to touch: networks trained on photographs classify imprints (T chapter 5)."""

from stages.kit.lazy import lazy_names

_MODULES = {  # public name -> its module
    "HybridNet": "hybrid",
    "Touches": "touches",
    "press_touches": "touches",
    "stratified_split": "split",
}
__all__ = list(_MODULES)  # pyright: ignore[reportUnsupportedDunderAll]
__getattr__ = lazy_names(__name__, _MODULES)

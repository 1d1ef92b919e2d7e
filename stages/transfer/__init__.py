"""From vision to touch: a network that learned on photographs recognises imprints (T chapter 5)."""

from importlib import import_module

_HOME = {
    "HybridNet": "hybrid",
    "Touches": "touches",
    "press_touches": "touches",
    "stratified_split": "split",
}
__all__ = list(_HOME)


def __getattr__(name):
    # torch takes seconds to import, and whoever reads only the schema does without it.
    if name in _HOME:
        return getattr(import_module(f".{_HOME[name]}", __name__), name)
    raise AttributeError(f"module {__name__!r} has no attribute {name!r}")

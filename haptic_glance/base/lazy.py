"""Public names of a package whose modules are imported only when a name is asked for."""

from collections.abc import Callable
from importlib import import_module
from typing import Any


def lazy_names(package: str, modules: dict[str, str]) -> Callable[[str], Any]:
    """The `__getattr__` of a package. modules: public name -> the package's module that defines it.

    For packages that need torch, which takes seconds to import: a reader of their settings does without it.
    """

    def attribute(name: str) -> Any:
        if name in modules:
            return getattr(import_module(f".{modules[name]}", package), name)
        raise AttributeError(f"module {package!r} has no attribute {name!r}")

    return attribute

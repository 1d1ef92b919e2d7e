"""OpenCV, pandas and trimesh, imported with their first use: all are large, and much of the work does without.

In a file that uses them, `from __future__ import annotations` keeps the types of arguments from being a use.
"""

from importlib import import_module
from typing import TYPE_CHECKING, Any

from .errors import interrupts_wait
from .extras import from_extra


class _Lazy:
    def __init__(self, name: str, need: str = "") -> None:
        self._name, self._need = name, need

    def __getattr__(self, name: str) -> Any:
        with from_extra(self._need), interrupts_wait():
            value = getattr(import_module(self._name), name)
        setattr(self, name, value)  # later uses cost no more than those of a module
        return value

    def __reduce__(self) -> tuple:
        return type(self), (self._name, self._need)


if TYPE_CHECKING:
    import cv2 as cv2
    import pandas as pandas
    import trimesh
    import trimesh.exchange.obj
    import trimesh.exchange.ply
    import trimesh.resolvers
    import trimesh.visual.material
else:
    cv2 = _Lazy("cv2", "pictures are filtered and compared by OpenCV (cv2), which ")
    pandas = _Lazy("pandas")
    trimesh = _Lazy("trimesh")

"""OpenCV, imported with its first use: it is large, and one look, simplification or touch does without."""

from importlib import import_module
from typing import TYPE_CHECKING, Any

from .extras import from_extra


class _OpenCV:
    def __getattr__(self, name: str) -> Any:
        with from_extra("pictures are filtered and compared by OpenCV (cv2), which "):
            value = getattr(import_module("cv2"), name)
        setattr(self, name, value)  # later uses cost no more than those of a module
        return value


if TYPE_CHECKING:
    import cv2 as cv2
else:
    cv2 = _OpenCV()

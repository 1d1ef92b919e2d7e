"""Depth images: what a camera that measures distances saw of an object, as a point cloud."""

import json
from collections.abc import Callable

import cv2
import numpy as np

from ..headers import MeshError
from .cloud import Cloud

FORMAT = ".depth"
KEYS = ("image", "fx", "fy", "cx", "cy", "scale")
EXAMPLE = '{"image": "scan.png", "fx": 615.0, "fy": 615.0, "cx": 319.5, "cy": 239.5, "scale": 0.001}'
JUMP = 0.02  # of the distance, between neighbours: more is an edge, where cameras mix near and far


def cloud_of_depth(depth: np.ndarray, fx: float, fy: float, cx: float, cy: float, scale: float = 1.0) -> Cloud:
    """The Cloud of a depth image (h, w), its sensor at the origin; x points right, y away from the camera, z up.

    depth: distances along the optical axis, times `scale` in the units that the points get; 0, NaN and infinity are no
    reading. fx, fy, cx, cy: focal lengths and centre of a pinhole camera, in pixels. Pixels next to a jump of the depth
    are left out. Raises MeshError for an image without a reading, or intrinsics that cannot be its own.
    """
    depth = np.asarray(depth, np.float64) * scale
    if depth.ndim != 2:
        raise MeshError(f"a depth image has one channel, this one has shape {depth.shape}")
    rows, columns = depth.shape
    if not (min(fx, fy, scale) > 0 and 0 <= cx <= columns and 0 <= cy <= rows):
        raise MeshError(f"fx={fx}, fy={fy}, cx={cx}, cy={cy}, scale={scale} cannot be of {columns} x {rows} pixels: "
                        "focal lengths and scale are above 0 and the centre lies in the image")  # fmt: skip
    read = np.isfinite(depth) & (depth > 0)
    if not read.any():
        raise MeshError("the depth image holds no reading: all is 0 or not finite")
    known = np.where(read, depth, np.inf)
    solid = read.copy()
    for axis in (0, 1):
        with np.errstate(invalid="ignore"):
            jump = ~(np.abs(np.diff(known, axis=axis)) <= JUMP * np.minimum.reduce(_pairs(known, axis)))
        for part in _pairs(solid, axis):
            part &= ~jump
    v, u = np.nonzero(solid)
    away = depth[v, u]
    return Cloud(np.stack([(u - cx) / fx * away, away, (cy - v) / fy * away], axis=1), sensor=np.zeros(3))


def read_depth(content: bytes, read: Callable[[str], bytes] | None) -> Cloud:
    """The Cloud of a .depth file, a JSON text as in EXAMPLE; read(name) gives the bytes of the image beside it."""
    try:
        said = json.loads(content)
        name, numbers = str(said["image"]), [float(said[key]) for key in KEYS[1:]]
    except (ValueError, KeyError, TypeError, RecursionError) as error:
        raise MeshError(f"{type(error).__name__}: {error}; a .depth file is like {EXAMPLE}") from None
    try:
        found = b"" if read is None else read(name)
    except (OSError, ValueError, KeyError):
        found = b""
    if not found:
        raise MeshError(f"the depth image {name} is not there: put it next to the .depth file")
    try:
        image = cv2.imdecode(np.frombuffer(found, np.uint8), cv2.IMREAD_UNCHANGED)
    except cv2.error:
        image = None
    if image is None:
        raise MeshError(f"the depth image {name} cannot be read: PNG and TIFF can, with 16 bits or as floats")
    return cloud_of_depth(image, *numbers)


def _pairs(values, axis):
    """(all but the last, all but the first) along an axis, as views."""
    return (values[:-1], values[1:]) if axis == 0 else (values[:, :-1], values[:, 1:])

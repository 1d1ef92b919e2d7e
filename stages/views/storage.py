"""A view as a small file: the object's bounding box as second differences, which compress well."""

from pathlib import Path

import numpy as np

from haptic_glance.base.files import read_arrays, write_arrays
from haptic_glance.look.camera import DISTANCE, Viewpoint
from haptic_glance.look.views.kernels import background_colour, fold_depth, unfold_depth
from haptic_glance.look.views.view import DEPTH_STEP, View


def write_view(path: str | Path, view: View) -> None:
    """Writes a view to a compressed .npz; equal views give equal bytes.

    Lossless, except that depths are rounded to multiples of DEPTH_STEP; rendered depths are multiples already. Raises
    ValueError when the background has more than one colour.
    """
    mask = view.mask
    background, uniform = background_colour(view.rgb, mask)
    if not uniform:
        raise ValueError("the background of a view must have one colour to be stored")
    top, left, bottom, right = _box(mask)
    box = slice(top, bottom), slice(left, right)
    inside, rgb = mask[box], view.rgb[box]
    if all(np.array_equal(rgb[..., 0], rgb[..., k]) for k in (1, 2)):
        rgb = rgb[..., :1]
    faces = view.face[box][inside]
    starts = np.flatnonzero(np.diff(faces, prepend=-1))
    write_arrays(
        path,
        size=np.array(mask.shape),
        origin=np.array([top, left]),
        viewpoint=np.array([view.viewpoint.azimuth, view.viewpoint.elevation, view.viewpoint.roll]),
        background=background,
        mask=np.packbits(inside),
        rgb=_differences(rgb),
        depth=fold_depth(view.depth[box], inside, DISTANCE, DEPTH_STEP),
        run_face=_to_bytes(np.diff(faces[starts], prepend=0)),
        run_length=_to_bytes(np.diff(starts, append=len(faces))),
    )


def read_view(path: str | Path) -> View:
    """Reads a view written by write_view."""
    arrays = read_arrays(path)
    h, w = arrays["rgb"].shape[:2]
    size = tuple(int(side) for side in arrays["size"])
    inside = np.unpackbits(arrays["mask"], count=h * w).reshape(h, w).astype(bool)
    rgb = np.broadcast_to(arrays["background"], (*size, 3)).copy()
    depth = np.full(size, np.inf, dtype=np.float32)
    face = np.full(size, -1, dtype=np.int32)
    top, left = arrays["origin"]
    box = slice(top, top + h), slice(left, left + w)
    rgb[box] = _summed(arrays["rgb"])
    unfold_depth(arrays["depth"], inside, DISTANCE, DEPTH_STEP, depth[box])
    face[box][inside] = np.repeat(np.cumsum(_from_bytes(arrays["run_face"])), _from_bytes(arrays["run_length"]))
    return View(rgb, depth, face, Viewpoint(*(float(angle) for angle in arrays["viewpoint"])))


def _box(mask):
    """(top, left, bottom, right) of the true pixels; zeros where there are none."""
    rows, columns = np.flatnonzero(mask.any(axis=1)), np.flatnonzero(mask.any(axis=0))
    if not len(rows):
        return 0, 0, 0, 0
    return rows[0], columns[0], rows[-1] + 1, columns[-1] + 1


def _differences(image):
    """The mixed second differences of an image, near zero on a smooth surface."""
    zero = image.dtype.type(0)
    return np.diff(np.diff(image, axis=0, prepend=zero), axis=1, prepend=zero)


def _summed(bends):
    """The inverse of _differences; u1 wraps around in both."""
    return np.cumsum(np.cumsum(bends, axis=1, dtype=bends.dtype), axis=0, dtype=bends.dtype)


def _to_bytes(numbers):
    """(4, k) u1 of k integers, folded as the depths are: see fold_depth."""
    folded = (np.abs(numbers) * 2 - (numbers < 0)).astype("<u4").ravel()
    return np.ascontiguousarray(folded.view(np.uint8).reshape(-1, 4).T)


def _from_bytes(planes):
    """(k,) i8: the inverse of _to_bytes."""
    folded = np.ascontiguousarray(planes.T).view("<u4").ravel().astype(np.int64)
    return np.where(folded % 2, -(folded + 1) // 2, folded // 2)

"""Readers of point clouds: text by numpy, PCD by pypcd4, LAS by laspy, PLY from what trimesh found."""

import io

import numpy as np
import trimesh

from stages.kit.extras import from_extra

from ..headers import MeshError
from .cloud import Cloud

TEXT = (".xyz", ".pts", ".asc")
FORMATS = (*TEXT, ".pcd", ".las")
UNIT = 0.05  # how far the length of a normal may be from 1
LARGEST_ORIGIN = 1e-9  # a viewpoint nearer to zero than this was not set by who wrote the file


def read_cloud(content: bytes, suffix: str) -> Cloud:
    """The Cloud of the bytes of a file of FORMATS; its points may be unusable (see stages.meshes.clouds.cloud).

    Text has a point a line: x y z, then three numbers that are a normal if their length is 1 on most lines, and
    else a colour of 0..255, then the other of the two; what follows is ignored, so are lines that hold no numbers.
    """
    if suffix in TEXT:
        return _text(content)
    return _pcd(content) if suffix == ".pcd" else _las(content)


def cloud_of(loaded: trimesh.PointCloud) -> Cloud:
    """The Cloud of a PLY without faces, as trimesh reads it."""
    found = loaded.metadata.get("_ply_raw", {}).get("vertex", {}).get("data")
    normals = _columns(found, ("nx", "ny", "nz")) if found is not None else None
    colors = np.asarray(loaded.colors)
    named = colors[:, :3].astype(np.uint8) if colors.shape == (len(loaded.vertices), 4) else None
    return Cloud(np.asarray(loaded.vertices, np.float64), _units(normals), named)


def _text(content):
    lines = content.decode("latin-1").replace(",", " ").replace(";", " ").splitlines()
    rows = [line for line in lines if len(line.split()) >= 3 and _is_number(line.split()[0])]
    if not rows:
        raise MeshError("no line of the point cloud holds three numbers")
    width = min(len(row.split()) for row in rows)
    values = np.loadtxt(io.StringIO("\n".join(rows)), usecols=range(width), ndmin=2)
    normals = colors = None
    for start in range(3, min(width, 9) - 2, 3):
        three = values[:, start : start + 3]
        if normals is None and _units(three) is not None:
            normals = _units(three)
        elif colors is None and three.min() >= 0 and three.max() <= 255 and three.max() > 1:
            colors = three.astype(np.uint8)
    return Cloud(values[:, :3], normals, colors)


def _pcd(content):
    with from_extra():
        from pypcd4.pypcd4 import PointCloud

    read = PointCloud.from_fileobj(io.BufferedReader(io.BytesIO(content)))
    data, fields = read.pc_data, read.fields
    if np.size(data) < read.metadata.points:
        raise MeshError(f"truncated: its header states {read.metadata.points} points, {np.size(data)} follow")
    points = _columns(data, ("x", "y", "z"))
    if points is None:
        raise MeshError(f"a point cloud without x, y and z: its fields are {', '.join(fields)}")
    normals = _columns(data, ("normal_x", "normal_y", "normal_z")) if "normal_x" in fields else None
    colors = read.decode_rgb(np.ascontiguousarray(data["rgb"])) if "rgb" in fields else None
    return Cloud(points, _units(normals), colors, _sensor(points, np.array(read.metadata.viewpoint[:3])))


def _las(content):
    with from_extra():
        import laspy

    read = laspy.read(io.BytesIO(content))
    points = np.stack([np.asarray(one, np.float64) for one in (read.x, read.y, read.z)], axis=1)
    if "red" not in set(read.point_format.dimension_names):
        return Cloud(points)
    colors = np.stack([np.asarray(one) for one in (read.red, read.green, read.blue)], axis=1)
    wide = colors.max(initial=0) > 255  # sixteen bits as the format says, which many writers fill with eight
    return Cloud(points, colors=(colors >> 8 if wide else colors).astype(np.uint8))


def _columns(data, names):
    try:
        return np.stack([np.asarray(data[name], np.float64).ravel() for name in names], axis=1)
    except (KeyError, ValueError):  # some of the three alone
        return None


def _units(vectors):
    """Unit normals of vectors (n, 3), or None where some are no normals."""
    if vectors is None or not len(vectors):
        return None
    with np.errstate(invalid="ignore", over="ignore"):
        length = np.linalg.norm(vectors, axis=1, keepdims=True)
    return None if (np.abs(length - 1) > UNIT).any() else vectors / length  # without a reading, they are NaN


def _sensor(points, viewpoint):
    """Where the points were seen from: a PCD's viewpoint is zero where its writer knew none, and in a camera's frame.

    It is a camera's where no point lies around it.
    """
    finite = points[np.isfinite(points).all(axis=1)]
    if not len(finite) or np.abs(viewpoint).max() > LARGEST_ORIGIN:
        return viewpoint
    low, high = finite.min(axis=0), finite.max(axis=0)
    return None if ((low <= 0) & (high >= 0)).all() else viewpoint


def _is_number(word):
    try:
        float(word)
    except ValueError:
        return False
    return True

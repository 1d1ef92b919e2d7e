"""Point clouds and depth images, and the surface through their points.

Normals are lines from the neighbours, with the sides from which the points can be seen. The surface has holes where
nothing was seen. Clouds are read from text by numpy, from PCD by pypcd4, from LAS by laspy, from PLY by trimesh.
"""

from __future__ import annotations

import io
import json
from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np
from scipy.spatial import ConvexHull, KDTree

from haptic_glance.base.extras import from_extra
from haptic_glance.base.lazy import cv2, trimesh
from haptic_glance.base.text import NUMBER, lines_of, text_of
from haptic_glance.base.warner import warn_caller

from .axes import directions
from .headers import MeshError
from .mesh import Mesh, unit, whole

LEAST = 50  # points; fewer hold no shape
MOST = 300_000  # points that a surface is made of; of more, as many are drawn
NEIGHBOURS = 8
STRAY = 8.0  # times the median distance to the neighbours: farther points are outliers
FLAT = 1e-3  # of the largest extent: less than this across, all points lie on a plane or a line


@dataclass(frozen=True, eq=False)
class Cloud:
    """A point cloud: points, and optionally their normals, colours and the place of the sensor.

    Parameters
    ----------
    points : (n, 3) array of float
        Coordinates.
    normals : (n, 3) array of float, optional
        Unit normals that point outwards.
    colors : (n, 3) array of uint8, optional
        Colours.
    sensor : (3,) array of float, optional
        Place from which all points were seen.
    up : str
        The axis that points up, such as "z"; empty: the shape of the surface decides.

    Raises
    ------
    ValueError
        For arrays of other shapes, and for colors that are not whole numbers of 0..255.
    """

    points: np.ndarray
    normals: np.ndarray | None = None
    colors: np.ndarray | None = None
    sensor: np.ndarray | None = None
    up: str = ""

    def __post_init__(self) -> None:
        points = np.asarray(self.points, np.float64)
        if points.ndim != 2 or points.shape[1] != 3:
            raise ValueError(f"points must have shape (n, 3), got {points.shape}")
        object.__setattr__(self, "points", points)
        for name, shape in (("normals", points.shape), ("colors", points.shape), ("sensor", (3,))):
            array = getattr(self, name)
            if array is None:
                continue
            values = whole(name, array, np.uint8) if name == "colors" else np.asarray(array, np.float64)
            if values.shape != shape:
                raise ValueError(f"{name} must have shape {shape}, got {values.shape}")
            object.__setattr__(self, name, values)

    def part(self, chosen: np.ndarray) -> Cloud:
        """The Cloud of some points: their ids, or (n,) boolean."""
        normals, colors = (None if values is None else values[chosen] for values in (self.normals, self.colors))
        return Cloud(self.points[chosen], normals, colors, self.sensor, self.up)


def usable(cloud: Cloud) -> Cloud:
    """The points that a surface can be made of: finite, no two at one place, none far from all others.

    Cameras mark pixels without a reading by NaN or by zeros, and many points at one place are that. Of more than MOST
    points as many are drawn evenly from the file's order. Raises MeshError with the reason where no shape is left.
    """
    total = len(cloud.points)
    finite = [np.isfinite(values).all(axis=1) for values in (cloud.points, cloud.normals) if values is not None]
    cloud = cloud.part(np.logical_and.reduce(finite))
    _, first = np.unique(cloud.points, axis=0, return_index=True)
    cloud = cloud.part(np.sort(first))
    if len(cloud.points) > MOST:
        cloud = cloud.part(np.linspace(0, len(cloud.points) - 1, MOST).astype(int))
    if len(cloud.points) >= LEAST:
        distances = KDTree(cloud.points).query(cloud.points, NEIGHBOURS + 1)[0][:, -1]
        cloud = cloud.part(distances <= STRAY * np.median(distances))
    if len(cloud.points) < LEAST:
        raise MeshError(f"a point cloud of {total} points, {len(cloud.points)} of them usable: a surface needs {LEAST}")
    extents = np.linalg.svd(cloud.points - cloud.points.mean(axis=0), compute_uv=False)
    if extents[2] < FLAT * extents[0]:
        shape = "line" if extents[1] < FLAT * extents[0] else "plane"
        raise MeshError(f"all points of the cloud lie on one {shape}: there is no shape to look at or to touch")
    return cloud


NORMAL_NEIGHBOURS = 12
LEVEL, ALIKE = 0.3, 0.5  # sines and cosine: neighbours on one piece of surface, whose normals lie on one side of it
BORDER = 1.0  # times the spacing over the extent: so many neighbours disagree along a line across a cloud
ASKED = 50_000  # points whose neighbours are compared: of more, every second or third one
TURNED = 0.25  # of the normals: more that look to the wrong side harm the surface
OPEN = 0.2  # of the area: a cloud with more of it missing may show the inside of an object
VIEWS = 32  # directions from which points are looked at
DISTANCE = 3.0  # of the eye, in radii of the cloud
FLIP = 1.3  # exponent of the sphere that points are mirrored on: larger sees more, and through gaps
VOTERS = 20_000  # points that vote; the others follow the nearest of them
ROUNDS, PULL = 30, 2.0  # of the neighbours' influence on each other


def normals_of(points: np.ndarray, sensor: np.ndarray | None = None) -> np.ndarray:
    """(n, 3) unit normals of points (n, 3), towards the sensor (3,), or outwards where it is not known.

    A normal is the direction of least variance of the twelve nearest points. Without a sensor its side is that from
    which the point is seen: from 32 directions the visible points are found without any surface (Katz, Tal, Basri,
    Direct visibility of point sets, SIGGRAPH 2007), each votes for the eye's side, and neighbours pull each other.
    """
    tree = KDTree(points)
    near = tree.query(points, min(NORMAL_NEIGHBOURS, len(points)))[1]
    spread = points[near] - points[near].mean(axis=1, keepdims=True)
    normals = np.linalg.eigh(np.einsum("nki,nkj->nij", spread, spread))[1][:, :, 0]
    if sensor is not None:
        return normals * _sign(np.einsum("ij,ij->i", normals, sensor - points))[:, None]
    voters = np.linspace(0, len(points) - 1, min(VOTERS, len(points))).astype(int)
    votes = _votes(points[voters], normals[voters])
    if len(voters) < len(points):
        nearest = KDTree(points[voters]).query(points)[1]
        votes = votes[nearest] * _sign(np.einsum("ij,ij->i", normals, normals[voters][nearest]))
    cosines, side = np.einsum("ni,nki->nk", normals, normals[near]), np.tanh(votes)
    for _ in range(ROUNDS):
        side = np.tanh(votes + PULL * (cosines * side[near]).mean(axis=1))
    return normals * _sign(side)[:, None]


def checked_normals(cloud: Cloud) -> tuple[Cloud, str]:
    """The Cloud, without its normals where they have the wrong sides, and a sentence on the reason; else an empty text.

    Where neighbours disagree, or all normals look into a closed object or away from the sensor, `normals_of` gives the
    sides. It decides only if more than TURNED of the normals disagree with it, and its own neighbours agree better.
    """
    if cloud.normals is None:
        return cloud, ""
    part = usable(cloud)
    points, normals = part.points, unit(np.asarray(part.normals))
    apart = _disagreement(points, normals)
    outwards = points - points.mean(axis=0) if cloud.sensor is None else cloud.sensor - points
    into = (normals * outwards).sum() < 0
    is_whole = cloud.sensor is not None or np.linalg.norm(normals.mean(axis=0)) < OPEN
    if apart * np.sqrt(len(points)) < BORDER and not (into and is_whole):
        return cloud, ""
    sides = normals_of(points, cloud.sensor)
    turned = np.mean((normals * sides).sum(axis=1) < 0)
    mended = turned > 1 - TURNED and is_whole or turned > TURNED and _disagreement(points, sides) < apart
    note = f"{100 * turned:.0f} % of its normals look to the wrong side, so normals are estimated from the points"
    return (replace(cloud, normals=None), note) if mended else (cloud, "")


def _disagreement(points, normals):
    """The share of neighbours on one piece of surface whose normals lie on opposite sides of it."""
    some = slice(None, None, 1 + len(points) // ASKED)
    near = np.asarray(KDTree(points).query(points[some], NEIGHBOURS + 1)[1])[:, 1:]
    ways, others = unit(points[near] - points[some, None]), normals[near]
    normals = normals[some]
    cosines = np.einsum("ni,nki->nk", normals, others)
    level = np.abs(cosines) > ALIKE
    for sines in (np.einsum("nki,ni->nk", ways, normals), np.einsum("nki,nki->nk", ways, others)):
        level &= np.abs(sines) < LEVEL
    return ((cosines < 0) & level).sum() / max(level.sum(), 1)


def visible(points: np.ndarray, eye: np.ndarray) -> np.ndarray:
    """Ids of the points (n, 3) seen from the eye (3,): those on the hull of all points mirrored on a sphere."""
    ray = points - eye
    length = np.linalg.norm(ray, axis=1, keepdims=True)
    mirrored = ray * (2 * length.max() * 10**FLIP / length - 1)
    hull = ConvexHull(np.vstack([mirrored, np.zeros(3)])).vertices
    return hull[hull < len(points)]


def _votes(points, normals):
    """(n,) how often the side of its normal is seen of each point, less how often the other is."""
    centre = (points.max(axis=0) + points.min(axis=0)) / 2
    radius = np.linalg.norm(points - centre, axis=1).max()
    votes = np.zeros(len(points))
    for direction in directions(VIEWS):
        eye = centre + DISTANCE * radius * direction
        is_visible = visible(points, eye)
        ray = eye - points[is_visible]
        along = np.einsum("ij,ij->i", normals[is_visible], ray) / np.linalg.norm(ray, axis=1)
        votes[is_visible] += along * np.abs(along)  # a point seen at a slant says little
    return votes


def _sign(values):
    return np.where(values < 0, -1.0, 1.0)


DEPTH = ".depth"
KEYS = ("image", "fx", "fy", "cx", "cy", "scale")
EXAMPLE = '{"image": "scan.png", "fx": 615.0, "fy": 615.0, "cx": 319.5, "cy": 239.5, "scale": 0.001}'
JUMP = 0.02  # of the distance, between neighbours: more is an edge, where cameras mix near and far


def cloud_of_depth(depth: np.ndarray, fx: float, fy: float, cx: float, cy: float, scale: float = 1.0) -> Cloud:
    """The Cloud of a depth image, its sensor at the origin; x points right, y away from the camera, z up.

    Parameters
    ----------
    depth : (h, w) array
        Distances along the optical axis. 0, NaN, infinity and the mask of a masked array mean no reading.
    fx, fy : float
        Focal lengths of a pinhole camera, in pixels.
    cx, cy : float
        Centre of the picture, in pixels.
    scale : float
        Units of the points per unit of `depth`, for example 0.001 from millimetres to metres.

    Returns
    -------
    Cloud
        Points with normals. Pixels next to a jump of the depth are left out.

    Raises
    ------
    MeshError
        For an image without a reading, and for intrinsics that do not fit the image.

    Examples
    --------
    >>> import numpy as np
    >>> from haptic_glance import cloud_of_depth
    >>> rows, columns = np.mgrid[:40, :40] - 20
    >>> bump = 1 - 0.01 * np.exp(-(rows**2 + columns**2) / 100)
    >>> cloud_of_depth(bump, fx=60, fy=60, cx=20, cy=20).points.shape[1]
    3
    """
    depth = np.ma.filled(np.ma.asarray(depth, np.float64), np.nan) * scale
    if depth.ndim != 2:
        raise MeshError(f"a depth image has one channel, this one has shape {depth.shape}")
    rows, columns = depth.shape
    if not (all(0 < value < np.inf for value in (fx, fy, scale)) and 0 <= cx <= columns and 0 <= cy <= rows):
        raise MeshError(f"fx={fx}, fy={fy}, cx={cx}, cy={cy}, scale={scale} cannot be of {columns} x {rows} pixels: "
                        "focal lengths and scale are above 0, finite, and the centre lies in the image")  # fmt: skip
    has_depth = np.isfinite(depth) & (depth > 0)
    if not has_depth.any():
        raise MeshError("the depth image holds no reading: all is 0 or not finite")
    filled_depth = np.where(has_depth, depth, np.inf)
    solid = has_depth.copy()
    for axis in (0, 1):
        with np.errstate(invalid="ignore"):
            jump = ~(np.abs(np.diff(filled_depth, axis=axis)) <= JUMP * np.minimum.reduce(_pairs(filled_depth, axis)))
        for part in _pairs(solid, axis):
            part &= ~jump
    v, u = np.nonzero(solid)
    distance = depth[v, u]
    points = np.stack([(u - cx) / fx * distance, distance, (cy - v) / fy * distance], axis=1)
    return Cloud(points, sensor=np.zeros(3), up="z")


def names_in(content: bytes) -> list[str]:
    """The name of the image of a .depth file; none of a file that is not valid."""
    try:
        return [str(json.loads(content)["image"])]
    except (ValueError, KeyError, TypeError, RecursionError):
        return []


def read_depth(content: bytes, read: Callable[[str], bytes] | None) -> Cloud:
    """The Cloud of a .depth file, a JSON text as in EXAMPLE; read(name) gives the bytes of the image beside it."""
    try:
        header = json.loads(content)
        name, numbers = str(header["image"]), [float(header[key]) for key in KEYS[1:]]
    except (ValueError, KeyError, TypeError, RecursionError) as error:
        raise MeshError(f"{type(error).__name__}: {error}; a .depth file is like {EXAMPLE}") from None
    try:
        picture = b"" if read is None else read(name)
    except (OSError, ValueError, KeyError):
        picture = b""
    if not picture:
        raise MeshError(f"the depth image {name} is not there: put it next to the .depth file")
    try:
        image = cv2.imdecode(np.frombuffer(picture, np.uint8), cv2.IMREAD_UNCHANGED)
    except cv2.error:
        image = None
    if image is None:
        raise MeshError(f"the depth image {name} cannot be read: PNG and TIFF can, with 16 bits or as floats")
    return cloud_of_depth(image, *numbers)


def _pairs(values, axis):
    """(all but the last, all but the first) along an axis, as views."""
    return (values[:-1], values[1:]) if axis == 0 else (values[:, :-1], values[:, 1:])


# pymeshlab comes without types:
# pyright: reportAttributeAccessIssue=false


DEPTHS = 5, 9  # of the octree: 32 to 512 cells a side
SIDE = 1.1  # of the octree, in the largest extent of the points
COARSER = 4.0  # times as wide as the points are apart: wider cells of the octree may lose the object
APART = "cut off stray points, or give distant objects one by one"
GAP = 1.5  # times the distance to the neighbours that points have there: surface farther from them was never seen


def surface_of(cloud: Cloud) -> Mesh:
    """Reconstructs the surface of a point cloud: closed where points lie all round, open where none were seen.

    Parameters
    ----------
    cloud : Cloud
        Points; normals are estimated where it has none.

    Returns
    -------
    Mesh
        The surface in the units of the cloud, with the colours of the nearest points.

    Raises
    ------
    MeshError
        For a cloud without a shape.
    TypeError
        For anything but a Cloud.

    Notes
    -----
    Cells are as wide as the points are apart. The reconstruction closes every hole. Surface that is farther from the
    points than the points are from each other is then cut away. Needs the extra `pipeline` (pymeshlab).

    References
    ----------
    Kazhdan and Hoppe, Screened Poisson surface reconstruction, ACM Transactions on Graphics 32(3), 2013.
    """
    if not isinstance(cloud, Cloud):
        raise TypeError(f"no point cloud: a {type(cloud).__name__}; give a Cloud, such as Cloud(points)")
    cloud = usable(cloud)
    with from_extra("a point cloud is made a surface by pymeshlab, which "):
        import pymeshlab

    centre, extent = cloud.points.mean(axis=0), np.ptp(cloud.points, axis=0).max()
    points = (cloud.points - centre) / extent  # far from the origin, digits would be lost
    sensor = None if cloud.sensor is None else (cloud.sensor - centre) / extent
    tree = KDTree(points)
    spacing = tree.query(points, NEIGHBOURS + 1)[0][:, -1]
    normals = normals_of(points, sensor) if cloud.normals is None else cloud.normals
    cells = _cells(spacing)
    if (wider := cells / 2 ** DEPTHS[1]) > COARSER:
        warn_caller(f"the surface is {wider:.0f} times coarser than the points of the cloud: {APART}")
    work = pymeshlab.MeshSet()
    work.add_mesh(pymeshlab.Mesh(vertex_matrix=points, v_normals_matrix=normals))
    depth = int(np.clip(np.ceil(np.log2(cells)), *DEPTHS))
    work.generate_surface_reconstruction_screened_poisson(depth=depth, preclean=True, threads=1)
    solid = work.current_mesh()
    vertices, faces = solid.vertex_matrix(), solid.face_matrix().astype(np.int64)
    distance, nearest = tree.query(vertices)
    is_near = np.asarray(distance <= GAP * spacing[nearest])
    faces = faces[is_near[faces].all(axis=1)]
    if not len(faces):
        raise MeshError(f"no surface passes near the points of the cloud: {APART}")
    vertex_ids, ids = np.unique(faces, return_inverse=True)
    colors = None if cloud.colors is None else cloud.colors[np.asarray(nearest)[vertex_ids]]
    return Mesh(vertices[vertex_ids] * extent + centre, ids.reshape(-1, 3), colors)


def _cells(away):
    """The cells a side of an octree that are as wide as points are apart; away: distance to the eighth neighbour."""
    return SIDE / (np.median(away) * np.sqrt(np.pi / NEIGHBOURS))  # on a surface, eight points share a disc


TEXT = (".xyz", ".pts", ".asc")
INTENSE = (7, 10)  # numbers a line with an intensity and a colour, and with a normal, too
NORMALS = (("normal_x", "normal_y", "normal_z"), ("nx", "ny", "nz"))  # names of their columns
RED = ("r", "red")
FIRST = (*(names[0] for names in NORMALS), *RED)  # names of the first column of a normal or a colour
FORMATS = (*TEXT, ".pcd", ".las")
UNIT = 0.05  # how far the length of a normal may be from 1
LARGEST_ORIGIN = 1e-9  # a viewpoint nearer to zero than this was not set by who wrote the file
SAMPLE = 2000  # points that show whether they are the view of one camera
CONE, OUTSIDE = 50.0, 0.02  # degrees between a camera's axis and what it sees, and the share of points farther off
BEHIND = 3.0  # times the distance to the neighbours: farther points in the same direction lie behind or before
COVERED = 0.4  # of the points, with others behind or before: one view has 0 to 0.4, a whole object 0.44 to 0.9


def read_cloud(content: bytes, suffix: str) -> Cloud:
    """The Cloud of the bytes of a file of FORMATS; its points may be unusable (see haptic_glance.mesh.clouds).

    Text has a point a line: x y z, then three numbers that are a normal if their length is 1 on all lines, and
    else a colour of 0..255, then the other of the two; what follows is ignored, so are lines that hold no numbers.
    Between the place and the colour may be an intensity, which scanners write; a normal comes before it. A header with
    the names of all columns (x y z nx ny nz r g b) goes before this order; its colours may be fractions or shares of 1.
    """
    if suffix in TEXT:
        return _text(content, suffix)
    return _pcd(content) if suffix == ".pcd" else _las(content)


def cloud_of(loaded: trimesh.PointCloud) -> Cloud:
    """The Cloud of a PLY without faces, as trimesh reads it."""
    table = loaded.metadata.get("_ply_raw", {}).get("vertex", {}).get("data")
    normals = _columns(table, NORMALS[1]) if table is not None else None
    colors = np.asarray(loaded.colors)
    rgb = colors[:, :3].astype(np.uint8) if colors.shape == (len(loaded.vertices), 4) else None
    return Cloud(np.asarray(loaded.vertices, np.float64), _units(normals), rgb)


def _text(content, suffix):
    lines, _, header = lines_of(text_of(content))
    sizes = [len(line.split()) if NUMBER.match(line) else 0 for line in lines]
    rows = [line for line, size in zip(lines, sizes, strict=True) if size >= 3]
    if not rows:
        raise MeshError("no line of the point cloud holds three numbers")
    width = min(size for size in sizes if size >= 3)
    values = np.loadtxt(rows, usecols=range(width), ndmin=2)
    normals = colors = None
    header = [word.strip("/#").lower() for word in header if word.strip("/#")]
    named = len(header) == width and header[0] == "x"
    for start in _starts(values, header if named else [], suffix):
        three, is_red = values[:, start : start + 3], named and header[start] in RED
        if normals is None and not is_red and _units(three) is not None:
            normals = _units(three)
        elif colors is None and not named and _are_bytes(three):
            colors = three.astype(np.uint8)
        elif colors is None and is_red and three.min() >= 0 and three.max() <= 255:
            colors = np.rint(three * (255 if three.max() <= 1 else 1)).astype(np.uint8)
    return Cloud(values[:, :3], normals, colors)


def _starts(values, header, suffix):
    """The columns with which normals and colours may begin: by the names in the header, else by the numbers."""
    width = values.shape[1]
    if header:
        return [start for start, name in enumerate(header[: width - 2]) if name in FIRST]
    three = values[:, 3:6]
    is_plain = _units(three) is not None or suffix != ".pts" and _are_bytes(three)
    first = 4 if width in INTENSE and not is_plain else 3
    return range(first, min(width, first + 6) - 2, 3)


def _are_bytes(values):
    return values.min(initial=0) >= 0 and 1 < values.max(initial=0) <= 255 and bool((values % 1 == 0).all())


def _pcd(content):
    with from_extra():
        from pypcd4.pypcd4 import PointCloud

    pcd = PointCloud.from_fileobj(io.BufferedReader(io.BytesIO(content)))
    data, fields = pcd.pc_data, pcd.fields
    if np.size(data) < pcd.metadata.points:
        raise MeshError(f"truncated: its header states {pcd.metadata.points} points, {np.size(data)} follow")
    points = _columns(data, ("x", "y", "z"))
    if points is None:
        raise MeshError(f"a point cloud without x, y and z: its fields are {', '.join(fields)}")
    normals = next((_columns(data, names) for names in NORMALS if names[0] in fields), None)
    packed = next((name for name in ("rgb", "rgba") if name in fields), None)  # rgba has a clearness, which is left out
    colors = pcd.decode_rgb(np.ascontiguousarray(data[packed])) if packed else None
    return Cloud(points, _units(normals), colors, _sensor(points, np.array(pcd.metadata.viewpoint[:3])))


def _las(content):
    with from_extra():
        import laspy

    las = laspy.read(io.BytesIO(content))
    points = np.stack([np.asarray(column, np.float64) for column in (las.x, las.y, las.z)], axis=1)
    if "red" not in set(las.point_format.dimension_names):
        return Cloud(points)
    colors = np.stack([np.asarray(column) for column in (las.red, las.green, las.blue)], axis=1)
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
    """The sensor's place: a PCD's viewpoint is zero where its writer knew none, and in a camera's frame.

    It is a camera's where no point lies around it, and where the points are what one camera sees.
    """
    finite = points[np.isfinite(points).all(axis=1)]
    if not len(finite) or np.abs(viewpoint).max() > LARGEST_ORIGIN:
        return viewpoint
    low, high = finite.min(axis=0), finite.max(axis=0)
    return None if ((low <= 0) & (high >= 0)).all() or not _is_one_view(finite) else viewpoint


def _is_one_view(points):
    """Whether a camera at the origin may have seen all points (n, 3): in its cone, hardly any behind others.

    A point is behind another, or before it, where points that are near in direction are far in space. `visible` does
    not tell: of a close object it sees the far side between the points, and of noisy points it sees few.
    """
    try:
        points = usable(Cloud(points[np.linspace(0, len(points) - 1, min(SAMPLE, len(points))).astype(int)])).points
    except MeshError:  # which the whole cloud then raises
        return True
    rays = points / np.linalg.norm(points, axis=1, keepdims=True)
    axis = rays.mean(axis=0)
    if np.mean(rays @ axis < np.cos(np.radians(CONE)) * np.linalg.norm(axis)) > OUTSIDE:
        return False
    near = KDTree(rays).query(rays, NEIGHBOURS + 1)[1]
    spread = np.linalg.norm(points[near] - points[:, None], axis=2).max(axis=1)
    return np.mean(spread > BEHIND * KDTree(points).query(points, NEIGHBOURS + 1)[0][:, -1]) < COVERED

"""Reads files of meshes, one or a folder: STL, OBJ, PLY, glTF and DAE by trimesh, OFF by us, scans by `clouds`."""

from __future__ import annotations

import io
import warnings
from contextlib import suppress
from dataclasses import replace
from pathlib import Path
from typing import TypeAlias

import numpy as np
from numpy.typing import ArrayLike

from haptic_glance.base.extras import MissingExtra, about
from haptic_glance.base.lazy import trimesh
from haptic_glance.base.warner import warn_caller

from . import clouds, collada, gltf, obj, ply
from .axes import AUTO
from .clouds import Cloud
from .headers import MeshError, check_header, stated_faces
from .materials import (
    join_parts,
    merge_equal_rows,
    numbered,
    obj_vertices,
    scale_colors,
    set_apart,
    texture_of,
    vertex_colors,
)
from .mesh import Mesh
from .off import read_off
from .up import UP_OF_FORMAT, assumed, stated_up
from .upright import settled

MeshLike: TypeAlias = (
    "Mesh | str | Path | trimesh.Trimesh | trimesh.Scene | trimesh.PointCloud | Cloud | tuple[ArrayLike, ArrayLike]"
)
WITH_UP = "Mesh(vertices, faces, up={!r})"  # says which axis points up
CONVERT = "Blender, MeshLab and others convert most files: export it as .glb, .ply or .stl"
# These functions rewrite a file in a form that the parser reads.
PARSER_BYTES = {
    ".glb": gltf.parser_bytes, ".stl": stated_faces, ".obj": obj.plain, ".ply": ply.plain, ".dae": collada.parser_bytes,
}  # fmt: skip
LEFT_OUT = {".glb": gltf.left_out, ".obj": obj.left_out, ".ply": ply.left_out, ".dae": collada.left_out}
FORMATS = (".stl", ".obj", ".ply", ".off", ".glb", ".gltf", ".dae", *clouds.FORMATS, clouds.DEPTH)


def load(path: str | Path) -> Mesh:
    """Reads a mesh file: Mesh(vertices (n, 3) f8, faces (m, 3) i8, colors (n, 3) u1 or None), in the units of the file.

    Vertices keep the order of the file, since ground truth refers to them by index. STL and GLB repeat vertices at
    face corners: equal ones are merged in the order of first appearance. Polygons are triangulated. A .gltf file is
    read as the GLB of what it refers to. The parts of a GLB scene are transformed and joined. The materials of a GLB,
    and those of an OBJ whose material files lie next to it, become the texture of the mesh. A GLB with colours per
    vertex and without a picture of colour gives these colours instead, times those of its materials, unless two colours
    meet at one place: they would open the surface. Of a point cloud
    (PLY or OFF without faces, XYZ, PTS, PCD, LAS), with or without normals, the vertices are those of the surface that
    haptic_glance.mesh.clouds makes of it; so they are of a depth image, which a .depth file names together with its
    camera. A warning names a cloud whose normals have wrong sides, pictures that are unreadable, and what the mesh
    leaves out of the shape: lines and points beside faces, instances, further scenes and poses of skins, with counts.
    Morph targets show the shape of their weights. A GLB is y up, a .depth file z up, a .dae file as it states. The
    other formats do not say, but in a comment of ours: `up` is then y or z, whichever the shape suggests
    (haptic_glance.mesh.upright).
    Raises MeshError with the file and the reason when it holds no usable mesh.
    """
    return settled(load_as_stated(path))


def load_as_stated(path: str | Path) -> Mesh:
    """As `load`; `up` is `auto` where the file does not say which axis points up."""
    with about(path, MeshError):
        return load_unnamed(Path(path))


def load_unnamed(path: Path) -> Mesh:
    """As `load_as_stated`; the message of a MeshError is the reason alone, for a caller that names the file itself."""
    if not path.is_file():
        folder = "is a folder, not a mesh: `haptic-glance gallery` shows all meshes of a folder"
        raise MeshError(folder if path.is_dir() else "no such file")
    resolver = trimesh.resolvers.FilePathResolver(str(path))
    mesh = parse(path.read_bytes(), path.suffix.lower(), resolver, every_colour=True, name=path.name)
    if coarse := coarse_steps(path, mesh):
        warn_caller(f"{path.name}: {coarse}")
    return mesh


SINGLE = (".stl", ".ply", ".glb", ".gltf")  # the formats that usually hold single precision
COARSE = 1e-3  # of the diagonal: steps between coordinates that change normals, and so saliency and touch


def coarse_steps(path: Path, mesh: Mesh) -> str:
    """A sentence where an object lies so far from the origin that its file has coarse steps; else an empty text."""
    return _coarse_steps(mesh) if path.suffix.lower() in SINGLE else ""


def _coarse_steps(mesh, points=None):
    """As `coarse_steps`, of a mesh, or of the points (n, 3) it was made of, which may have single precision."""
    points = mesh.vertices if points is None else points[np.isfinite(points).all(axis=1)]
    with np.errstate(over="ignore"):
        is_single = np.array_equal(points.astype(np.float32), points)
        step = np.spacing(np.float32(np.abs(mesh.vertices).max(initial=0)))
    if is_single and 0 < COARSE * mesh.diagonal < step:
        remedy = "move the object to the origin before it is exported"
        share = 100 * step / mesh.diagonal
        return f"its coordinates have steps of {share:.2g} % of the diagonal: {remedy}"
    return ""


def as_mesh(source: MeshLike) -> Mesh:
    """Converts a path, an object of trimesh, a pair of arrays or a Cloud to a Mesh.

    Parameters
    ----------
    source : Mesh, path, Trimesh, Scene, PointCloud, Cloud, or pair of (n, 3) and (m, 3) arrays
        The mesh. The parts of a Scene are joined, as those of a GLB are.

    Returns
    -------
    Mesh
        The same object for a Mesh. Vertices keep their ids, except those of a Scene. Colours and textures of trimesh
        are taken over as sRGB. trimesh's own loader leaves the colours of a GLB linear, which shows them too dark: give
        the path of a GLB instead.

    Raises
    ------
    MeshError
        As `load` does.
    ValueError
        For arrays of another shape.
    TypeError
        For anything else.

    Notes
    -----
    Only a Mesh, the Cloud of a depth image and some files state which axis points up. For the others the shape chooses
    y or z, as in `load`, so that a file and its arrays have the same axis; `haptic_glance.as_mesh` warns of the choice.
    A Mesh is z up unless it is made with another `up`.

    Examples
    --------
    >>> import trimesh
    >>> from haptic_glance import as_mesh
    >>> len(as_mesh(trimesh.creation.box()).faces)
    12
    """
    return settled(as_stated(source))


def as_stated(source: MeshLike) -> Mesh:
    """As `as_mesh`; `up` is `auto` where nothing says which axis points up."""
    if isinstance(source, Mesh):
        return source
    if isinstance(source, str | Path):
        return load_as_stated(source)
    mesh = _converted(source)
    if isinstance(source, tuple) and np.asarray(source[0]).dtype == np.float32 and (coarse := _coarse_steps(mesh)):
        warn_caller(f"the mesh: {coarse}")
    return replace(mesh, up=(source.up if isinstance(source, Cloud) else "") or AUTO)


def with_known_up(source: MeshLike, remedy: str = WITH_UP, reason: str = "") -> Mesh:
    """As `as_mesh`; where nothing says which axis points up, a warning says which one is assumed.

    remedy: a format of how to name another axis. reason: why the shape decides; by default that nothing else says it.
    """
    mesh = as_stated(source)
    if mesh.up != AUTO:
        return mesh
    name = Path(source).name if isinstance(source, str | Path) else "the mesh"
    mesh, note = assumed(mesh, reason or f"{name} does not say which axis points up", remedy)
    warn_caller(note)
    return mesh


def _converted(source):
    if isinstance(source, tuple) and len(source) == 2:
        return Mesh(np.asarray(source[0], dtype=np.float64), np.asarray(source[1]))
    if isinstance(source, Cloud):
        return _surface(source, "the point cloud")
    if isinstance(source, trimesh.Scene):
        return join_parts(source, every_colour=True) or _to_mesh(None, False, False)
    if isinstance(source, trimesh.Trimesh | trimesh.PointCloud):
        return _to_mesh(source, False, every_colour=True)
    raise TypeError(f"no mesh: a {type(source).__name__}; give a path, a trimesh, (vertices, faces), a Cloud or a Mesh")


def parse(
    content: bytes,
    suffix: str,
    resolver: trimesh.resolvers.Resolver | None = None,
    every_colour: bool = False,
    name: str = "the file",
) -> Mesh:
    """As `load_as_stated`, from the bytes of a file and its suffix (`.stl`, ...). Without a resolver, reads no other.

    every_colour: also the colours of faces, as those of the vertices, and the picture of a PLY, as a texture. name: of
    the file, for warnings about its normals and pictures.
    """
    if suffix not in FORMATS:
        remedy = "save its points as .xyz" if suffix in (".csv", ".npy", ".txt") else CONVERT
        remedy = f"the formats are {', '.join(FORMATS)}; {remedy}"
        raise MeshError(f"cannot read {suffix or 'a file without suffix'}: {remedy}")
    if not content:
        raise MeshError("the file is empty")
    if suffix == ".gltf":
        content, suffix = gltf.packed(content, resolver), ".glb"
    elif suffix == ".glb":
        content = gltf.with_pictures(content, resolver)
    check_header(content, suffix)
    try:
        counts = LEFT_OUT[suffix](content) if suffix in LEFT_OUT else {}
        content = PARSER_BYTES[suffix](content) if suffix in PARSER_BYTES else content
        with warnings.catch_warnings():  # of NaN, which is refused below, and of vertices that no face has
            warnings.simplefilter("ignore", RuntimeWarning)
            mesh = _parsed(content, suffix, resolver, every_colour, name)
        if any(counts.values()):
            texts = (f"{kind} ({count:,})" for kind, count in counts.items() if count)
            warn_caller(f"{name}: left out: {', '.join(texts)}")
        stated = collada.up_of(content) if suffix == ".dae" else stated_up(content)
        return replace(mesh, up=UP_OF_FORMAT.get(suffix) or stated or AUTO)
    except (MeshError, MissingExtra):
        raise
    except MemoryError:
        raise MeshError("its header claims more data than fits in memory") from None
    except Exception as error:  # the parsers raise many types; each means that the file is unreadable
        if isinstance(error, IndexError) and "out of bounds" in str(error):
            raise MeshError(f"faces name vertices that do not exist ({_brief(error)}); {CONVERT}") from None
        reason = f"{type(error).__name__}: {_brief(error)}"
        raise MeshError(f"unreadable as {suffix[1:].upper()} ({reason}); {CONVERT}") from None


def _parsed(content, suffix, resolver, every_colour, name):
    if suffix == ".off":
        vertices, faces, colors = read_off(content, name)
        if len(faces):
            return _checked(vertices, faces, colors)
        with about("has no faces, so it is read as a point cloud", MeshError):
            return clouds.surface_of(Cloud(vertices, colors=colors))
    if suffix == clouds.DEPTH:
        return clouds.surface_of(clouds.read_depth(content, resolver and resolver.get))
    if suffix in clouds.FORMATS:
        return _surface(clouds.read_cloud(content, suffix), name)
    if suffix == ".dae":
        return collada.read_collada(content, resolver) or _to_mesh(None, False, every_colour)
    if suffix == ".glb" or (suffix == ".obj" and b"usemtl" in content):
        order = obj_vertices(content) if suffix == ".obj" else None
        beside = obj.SiblingFiles(resolver) if suffix == ".obj" and resolver else resolver
        opened = _open(numbered(content), suffix, beside)
        if unreadable := set_apart(opened, content):
            warn_caller(f"{name}: unreadable, so left out: the picture {', the picture '.join(unreadable)}")
        loaded = join_parts(opened, order, every_colour)
    else:
        skip = not (every_colour and suffix == ".ply")
        loaded = _open(content, suffix, resolver, maintain_order=True, skip_materials=skip)
        if isinstance(loaded, trimesh.Scene):
            loaded = loaded.to_geometry() if loaded.geometry else None
    if isinstance(loaded, Mesh):
        return loaded
    if isinstance(loaded, trimesh.PointCloud) and (suffix != ".ply" or "face" in loaded.metadata.get("_ply_raw", ())):
        with about("has no faces, so it is read as a point cloud", MeshError):
            return _to_mesh(loaded, False, every_colour, name)
    return _to_mesh(loaded, suffix == ".stl", every_colour, name)


def _surface(cloud, name):
    cloud, note = clouds.checked_normals(cloud)
    if note:
        warn_caller(f"{name}: {note}")
    mesh = clouds.surface_of(cloud)
    if coarse := _coarse_steps(mesh, cloud.points):
        warn_caller(f"{name}: {coarse}")
    return mesh


def _open(content, suffix, resolver, **options):
    stream = io.BytesIO(content)
    parsers = {".obj": trimesh.exchange.obj.load_obj, ".ply": trimesh.exchange.ply.load_ply}
    if suffix not in parsers:
        return trimesh.load(stream, file_type=suffix[1:], resolver=resolver, process=False, **options)
    # colours may be of any kind
    parser_output = parsers[suffix](stream, resolver=resolver, **options)
    parts = list(parser_output["geometry"].values()) if "geometry" in parser_output else [parser_output]
    for part in parts:
        part["process"] = False
    scale_colors(parts)
    scene = trimesh.load_scene(parser_output)
    return next(iter(scene.geometry.values())) if len(scene.geometry) == 1 else scene


def _to_mesh(loaded, merge, every_colour, name="the point cloud"):
    if loaded is None:
        raise MeshError("the file holds no geometry")
    if isinstance(loaded, trimesh.PointCloud) and (strips := _strips(loaded)) is not None:
        return _checked(np.asarray(loaded.vertices, dtype=np.float64), strips)
    if isinstance(loaded, trimesh.PointCloud):
        return _surface(clouds.cloud_of(loaded), name)
    if not isinstance(loaded, trimesh.Trimesh):
        raise MeshError(f"not a triangle mesh but a {type(loaded).__name__}")
    colors = None if merge else vertex_colors(loaded, of_faces=every_colour)
    mesh = _checked(np.asarray(loaded.vertices, dtype=np.float64), np.asarray(loaded.faces, dtype=np.int64), colors)
    if not merge:
        return Mesh(mesh.vertices, mesh.faces, mesh.colors, texture_of([loaded])) if every_colour else mesh
    first, ids = merge_equal_rows(mesh.vertices)
    return Mesh(mesh.vertices[first], ids[mesh.faces])


def _checked(vertices, faces, colors=None):
    """The Mesh of arrays that a file holds; MeshError with what is wrong with them."""
    if len(faces) == 0:
        raise MeshError(f"no faces ({len(vertices)} vertices)")
    bad = int((~np.isfinite(vertices).all(axis=1)).sum())
    if bad:
        raise MeshError(f"{bad} of {len(vertices)} vertices have NaN or infinite coordinates")
    if faces.min() < 0 or faces.max() >= len(vertices):
        raise MeshError(f"faces name vertices that do not exist (0..{len(vertices) - 1})")
    return Mesh(vertices, faces, colors)


def _strips(loaded):
    """(m, 3) faces of the triangle strips of a PLY, whose parser takes it for a cloud; None where it has none.

    -1 ends a strip; every other triangle of one is wound the other way.
    """
    element = loaded.metadata.get("_ply_raw", {}).get("tristrips")
    if not element:
        return None
    data = element["data"]
    if isinstance(data, dict):
        ids = np.concatenate([np.ravel(values) for values in data.values()])
    else:  # a structured array: of each row the list in its last field
        ids = np.concatenate([np.ravel(row[-1][1] if len(row[-1]) == 2 else row[-1]) for row in data])
    faces = []
    for strip in np.split(ids.astype(np.int64), np.flatnonzero(ids == -1)):
        strip = strip[strip >= 0]
        triangles = np.stack([strip[:-2], strip[1:-1], strip[2:]], axis=1) if len(strip) > 2 else np.zeros((0, 3), int)
        triangles[1::2] = triangles[1::2][:, ::-1]
        faces.append(triangles)
    faces = np.concatenate(faces)
    a, b, c = faces.T
    return faces[(a != b) & (b != c) & (c != a)]


def _brief(error):
    lines = str(error).strip().splitlines()
    return lines[0][:120] if lines else "no details"


def mesh_files(place: Path) -> list[Path]:
    """The file itself, or the files of a folder that `load` reads by their suffix, in alphabetical order.

    Folders in the folder and names that begin with a dot are left out. Raises MeshError for a folder without a mesh,
    and where there is nothing.
    """
    if not place.exists():
        raise MeshError(f"{place}: no such file or folder")
    if not place.is_dir():
        return [place]
    names = sorted(path for path in place.iterdir() if not path.name.startswith("."))
    files = [path for path in names if path.suffix.lower() in FORMATS and path.is_file()]
    if not files:
        raise MeshError(f"{place}: no mesh in this folder; the formats are {', '.join(FORMATS)}")
    return files


NAMES_IN = {  # of the formats that refer to other files
    ".obj": obj.names_in,
    ".gltf": gltf.names_in,
    ".glb": gltf.names_in,
    ".ply": ply.names_in,
    ".dae": collada.names_in,
    clouds.DEPTH: clouds.names_in,
}


def files_of(path: Path) -> list[Path]:
    """The other files that a file and its materials refer to, as far as they exist."""
    names_in = NAMES_IN.get(path.suffix.lower())
    found = _named_in(path, names_in) if names_in else []
    return found + [picture for file in found if names_in is obj.names_in for picture in _named_in(file, obj.names_in)]


def _named_in(path, names_in):
    """The files that exist of those that a file names, beside it."""
    found = []
    with suppress(OSError):
        for name in dict.fromkeys(names_in(path.read_bytes())):
            with suppress(OSError, ValueError):  # a name that no file can have
                found += [path.parent / name] if (path.parent / name).is_file() else []
    return found


def names_of(files: list[Path]) -> list[str]:
    """A name per file: its own without the suffix, or with it, or with the path, where another file has that name."""
    stems, names = [path.stem for path in files], [path.name for path in files]
    return [
        path.stem if stems.count(path.stem) == 1 and path.stem not in names
        else path.name if names.count(path.name) == 1 else str(path)
        for path in files
    ]  # fmt: skip

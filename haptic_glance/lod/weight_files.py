"""Files that carry the saliency of each vertex to other tools, which take it as weights of simplification."""

import io
from collections.abc import Callable
from pathlib import Path

import numpy as np

from haptic_glance.base.extras import about
from haptic_glance.base.files import whole_file
from haptic_glance.base.lazy import trimesh
from haptic_glance.mesh.mesh import Mesh
from haptic_glance.mesh.repair import rotate_to_z_up
from haptic_glance.mesh.up import with_stated_up

from .export import check_precision, for_glb, write_glb
from .simplify import check_weights
from .topology import Parts

NAME = "saliency"


def write_weights(path: str | Path, mesh: Mesh, weights: np.ndarray, parts: Parts | None = None) -> None:
    """Write a mesh with a weight per vertex, in the format of the path's suffix.

    Parameters
    ----------
    path : str or Path
        `.ply`: a vertex property `saliency`, which Blender imports as an attribute. `.glb`: a vertex attribute
        `_SALIENCY`; textures and texture coordinates are kept. `.usda`: a primvar `saliency` per vertex, OpenUSD, which
        knows y up and z up: other meshes are turned z up.
        `.npz`: arrays `vertices` (n, 3) f4, `indices` (3 m,) u4 and `saliency` (n,) f4 for meshoptimizer.
    mesh : Mesh
        The mesh of n vertices, in the coordinates that the file gets.
    weights : (n,) array
        Weights in 0..1.
    parts : mapping of str to (k,) array of int, optional
        In a glb the nodes, by name: the ids of their faces.

    Raises
    ------
    ValueError
        For another suffix, another number of weights, and weights outside 0..1 or NaN.

    Examples
    --------
    >>> import numpy as np
    >>> from haptic_glance.mesh import Mesh
    >>> triangle = Mesh(np.eye(3), np.array([[0, 1, 2]]))
    >>> write_weights("triangle.obj", triangle, np.ones(3))
    Traceback (most recent call last):
    ...
    ValueError: triangle.obj: weights are written as .glb, .npz, .ply or .usda
    """
    path = Path(path)
    check_suffix(path)
    with about(path.name):
        weights = check_weights(mesh, weights).astype(np.float32)
    check_precision(path, mesh, text="")
    suffix = path.suffix.lower()
    nodes = {"parts": parts} if suffix == ".glb" else {}
    with whole_file(path) as part:
        part.write_bytes(WRITERS[suffix](mesh, weights, **nodes))


def check_suffix(path: Path) -> None:
    """Raises ValueError for a file in which no weights can be written."""
    if path.suffix.lower() not in WRITERS:
        *suffixes, last = sorted(WRITERS)
        raise ValueError(f"{path.name}: weights are written as {', '.join(suffixes)} or {last}")


def _ply(mesh: Mesh, weights: np.ndarray) -> bytes:
    plain = trimesh.Trimesh(mesh.vertices, mesh.faces, vertex_colors=mesh.colors, process=False)
    plain.vertex_attributes[NAME] = weights
    return with_stated_up(plain.export(file_type="ply"), ".ply", mesh.up)  # type: ignore[arg-type]


def _glb(mesh: Mesh, weights: np.ndarray, parts: Parts | None = None) -> bytes:
    return write_glb(for_glb(mesh, parts=parts, attributes={f"_{NAME.upper()}": weights}))


def _npz(mesh: Mesh, weights: np.ndarray) -> bytes:
    stream = io.BytesIO()
    indices = mesh.faces.astype(np.uint32).ravel()
    np.savez_compressed(stream, vertices=mesh.vertices.astype(np.float32), indices=indices, saliency=weights)
    return stream.getvalue()


def _usda(mesh: Mesh, weights: np.ndarray) -> bytes:
    if mesh.up not in ("y", "z"):
        mesh = rotate_to_z_up(mesh)
    points = ", ".join(f"({x:.9g}, {y:.9g}, {z:.9g})" for x, y, z in mesh.vertices.tolist())
    return f"""#usda 1.0
(
    defaultPrim = "mesh"
    metersPerUnit = 1
    upAxis = "{mesh.up.upper()}"
)

def Mesh "mesh"
{{
    uniform token subdivisionScheme = "none"
    int[] faceVertexCounts = [{", ".join(["3"] * len(mesh.faces))}]
    int[] faceVertexIndices = [{", ".join(map(str, mesh.faces.ravel().tolist()))}]
    point3f[] points = [{points}]
    float[] primvars:{NAME} = [{", ".join(f"{weight:.9g}" for weight in weights.tolist())}] (
        interpolation = "vertex"
    )
}}
""".encode()


WRITERS: dict[str, Callable[..., bytes]] = {".glb": _glb, ".npz": _npz, ".ply": _ply, ".usda": _usda}

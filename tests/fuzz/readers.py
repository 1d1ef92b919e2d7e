"""Every reader of files that somebody else may have written, each with small valid files to be damaged."""

import io
import json
import tarfile
import zipfile
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import trimesh
from PIL import Image

from stages.kit import Mesh
from stages.kit.fetch import debian_files, read_members, read_tar_members
from stages.kit.files import read_arrays, read_json, read_mesh, write_mesh
from stages.lod import write_any
from stages.meshes import clean, load, normalise

BALL = trimesh.creation.icosphere(subdivisions=1)
COLORS = np.arange(126).reshape(42, 3)


@dataclass(frozen=True)
class Reader:
    """file: its name; seeds(folder): valid contents, and all that lies beside the file; read(path): reads and checks it.

    names: a refusal names the file.
    """

    file: str
    seeds: Callable[[Path], list[bytes]]
    read: Callable[[Path], object]
    names: bool = True


def mesh_seeds(*kinds):
    """The ball as trimesh writes it in these formats, and as stages.lod does with colours."""

    def seeds(folder):
        found = [BALL.export(file_type=kind) for kind in kinds]
        colored = folder / f"colored.{kinds[0].partition('_')[0]}"
        write_any(colored, Mesh(BALL.vertices, BALL.faces, COLORS))
        return [one.encode() if isinstance(one, str) else one for one in found] + [colored.read_bytes()]

    return seeds


def other_plys():
    head = (
        "ply\nformat binary_big_endian 1.0\nelement vertex 42\nproperty float x\nproperty float y\nproperty float z\n"
    )
    head += "element face 80\nproperty list int int vertex_indices\nend_header\n"
    faces = np.column_stack([np.full(80, 3), BALL.faces])
    content = BALL.vertices.astype(">f4").tobytes() + faces.astype(">i4").tobytes()
    return [head.encode() + content, BALL.export(file_type="ply", encoding="ascii")]


def off_seeds(folder):
    rows = np.column_stack([BALL.vertices, COLORS, np.full(42, 255)])
    colored = [" ".join(f"{value:g}" for value in row) for row in rows]
    faces = [f"3 {a} {b} {c}" for a, b, c in BALL.faces]
    head = b"OFF BINARY\n" + np.array([42, 80, 0], dtype=">i4").tobytes() + BALL.vertices.astype(">f4").tobytes()
    binary = head + np.pad(BALL.faces, ((0, 0), (1, 1)), constant_values=((0, 0), (3, 0))).astype(">i4").tobytes()
    return [BALL.export(file_type="off").encode(), "\n".join(["COFF", "42 80 0", *colored, *faces]).encode(), binary]


def textured(folder):
    """A textured square as an OBJ with its material and picture beside it, and as a GLB."""
    picture = Image.fromarray(np.arange(192, dtype=np.uint8).reshape(8, 8, 3))
    visual = trimesh.visual.TextureVisuals(uv=[[0, 0], [1, 0], [1, 1], [0, 1]], image=picture)
    square = trimesh.Trimesh([[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]], [[0, 1, 2], [0, 2, 3]], visual=visual)
    obj, extra = trimesh.exchange.obj.export_obj(square, return_texture=True)
    for name, content in extra.items():
        (folder / name).write_bytes(content)
    (folder / "square.obj").write_text(obj)
    return square


def obj_seeds(folder):
    textured(folder)
    return [*mesh_seeds("obj")(folder), (folder / "square.obj").read_bytes()]


def read_mesh_file(path):
    mesh = load(path)
    try:
        return normalise(clean(mesh)[0])
    except ValueError as error:  # these two have no name to give
        raise ValueError(f"{path}: {error}") from None


def beside(name):
    """seeds of a file beside square.obj; reading reads the OBJ, and refuses in its name."""

    def seeds(folder):
        textured(folder)
        return [next(folder.glob(name)).read_bytes()]

    return seeds


def npz_seeds(folder):
    write_mesh(folder / "seed.npz", Mesh(BALL.vertices, BALL.faces, COLORS))
    stored = io.BytesIO()
    np.savez(stored, vertices=BALL.vertices, faces=BALL.faces)
    return [(folder / "seed.npz").read_bytes(), stored.getvalue()]


def npy_seeds(folder):
    stored = io.BytesIO()
    np.save(stored, BALL.vertices)
    return [stored.getvalue()]


def in_npz(read):
    """Reads the damaged array inside a sound archive, whose checksum would else reveal the damage."""

    def wrapped(path):
        content = path.read_bytes()
        with zipfile.ZipFile(path, "w") as archive:
            archive.writestr("vertices.npy", content)
        return read(path)

    return wrapped


def zip_seeds(folder):
    stored = io.BytesIO()
    with zipfile.ZipFile(stored, "w", zipfile.ZIP_DEFLATED) as archive:
        for name in ("one", "two"):
            archive.writestr(name, b"some bytes " * 20)
    return [stored.getvalue()]


def tar_bytes(mode):
    stored = io.BytesIO()
    with tarfile.open(fileobj=stored, mode=mode) as archive:
        for name in ("one", "two"):
            member = tarfile.TarInfo(name)
            member.size = 220
            archive.addfile(member, io.BytesIO(b"some bytes " * 20))
    return stored.getvalue()


def deb_seeds(folder):
    data = tar_bytes("w:xz")
    header = b"data.tar.xz".ljust(16) + b"0".ljust(12) + b"0".ljust(6) * 2 + b"100644".ljust(8)
    small = b"debian-binary".ljust(16) + b"0".ljust(12) + b"0".ljust(6) * 2 + b"100644".ljust(8) + b"4".ljust(10)
    return [b"!<arch>\n" + small + b"`\n2.0\n" + header + str(len(data)).encode().ljust(10) + b"`\n" + data]


READERS = {
    "stl": Reader("a.stl", mesh_seeds("stl", "stl_ascii"), read_mesh_file),
    "obj": Reader("a.obj", obj_seeds, read_mesh_file),
    "material": Reader("material.mtl", beside("*.mtl"), lambda path: load(path.parent / "square.obj"), False),
    "texture": Reader("material_0.png", beside("*.png"), lambda path: load(path.parent / "square.obj"), False),
    "ply": Reader("a.ply", lambda folder: [*mesh_seeds("ply")(folder), *other_plys()], read_mesh_file),
    "off": Reader("a.off", off_seeds, read_mesh_file),
    "glb": Reader("a.glb", lambda folder: [*mesh_seeds("glb")(folder), textured(folder).export(file_type="glb")],
                  read_mesh_file),
    "mesh": Reader("a.npz", npz_seeds, read_mesh),
    "array": Reader("a.npz", npy_seeds, in_npz(read_arrays)),
    "json": Reader("a.json", lambda folder: [json.dumps({"a": [1, 2, {"b": None}], "c": "d"}).encode()], read_json),
    "zip": Reader("a.zip", zip_seeds, lambda path: dict(read_members(path, ["one", "two"]))),
    "tar": Reader("a.tgz", lambda folder: [tar_bytes("w:gz"), tar_bytes("w")],
                  lambda path: dict(read_tar_members(path, ["one", "two"]))),
    "deb": Reader("a.deb", deb_seeds, lambda path: [name for name, _ in debian_files(path)]),
}  # fmt: skip

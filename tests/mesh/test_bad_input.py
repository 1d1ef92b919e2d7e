"""Every file that a person may hand in gets a right result or the right reason; tests/fuzz has a thousand a format."""

import struct
import zlib

import numpy as np
import pytest
import trimesh

from haptic_glance.mesh import MeshError, clean, load
from haptic_glance.mesh.files import load_as_stated, parse
from haptic_glance.mesh.gltf import joined
from haptic_glance.mesh.obj import not_read as obj_not_read

CUBE = trimesh.creation.box()


def off(vertices, faces):
    rows = [f"{x} {y} {z}" for x, y, z in vertices] + [f"3 {a} {b} {c}" for a, b, c in faces]
    return "\n".join(["OFF", f"{len(vertices)} {len(faces)} 0", *rows, ""]).encode()


def ply(vertices, faces, count=None):
    head = ["ply", "format ascii 1.0", f"element vertex {count or len(vertices)}"]
    head += [f"property float {axis}" for axis in "xyz"]
    head += [f"element face {len(faces)}", "property list uchar int vertex_indices", "end_header"]
    rows = [f"{x} {y} {z}" for x, y, z in vertices] + [" ".join(map(str, (len(face), *face))) for face in faces]
    return "\n".join([*head, *rows, ""]).encode()


def binary_ply(vertices, faces):
    head = ply(vertices, faces).partition(b"end_header\n")[0].replace(b"ascii", b"binary_little_endian")
    rows = [struct.pack(f"<B{len(face)}i", len(face), *face) for face in faces]
    return b"".join([head, b"end_header\n", np.array(vertices, "<f4").tobytes(), *rows])


TRIANGLE = [(0, 0, 0), (1, 0, 0), (0, 1, 0)]
FLAT = "v 0 0 0\nv 1 0 0\nv 0 1 0\n"
STL, GLB, PLY = (CUBE.export(file_type=kind) for kind in ("stl", "glb", "ply"))
REFUSED = {
    "empty.stl": (b"", "empty"),
    "empty.obj": (b"# nothing\n", "no geometry|no faces|unreadable"),
    "truncated.stl": (STL[: len(STL) // 2], "truncated"),
    "truncated.glb": (GLB[: len(GLB) // 2], "truncated"),
    "truncated.ply": (PLY[: len(PLY) - 20], "unreadable|faces name|truncated"),
    "short.ply": (trimesh.PointCloud(CUBE.vertices).export(file_type="ply")[:-8], "truncated: .* 8 vertices"),
    "truncated.off": (off(CUBE.vertices, CUBE.faces)[:-40], "truncated"),
    "truncated_ascii.stl": (CUBE.export(file_type="stl_ascii").encode()[:900], "truncated"),
    "nan.off": (off([(0, 0, 0), (1, 0, 0), ("nan", 1, 0)], [(0, 1, 2)]), "NaN"),
    "infinite.off": (off([(0, 0, 0), (1, 0, 0), ("inf", 1, 0)], [(0, 1, 2)]), "NaN or infinite"),
    "no_area.off": (off([(0, 0, 0), (1, 0, 0), (2, 0, 0)], [(0, 1, 2)]), "no area"),
    "one_point.off": (off([(1, 1, 1)] * 3, [(0, 1, 2)]), "no area"),
    "degenerate.off": (off(TRIANGLE, [(0, 1, 1)]), "three different"),
    "cloud.ply": (ply(TRIANGLE, []), "a point cloud of 3 points, 3 of them usable: a surface needs 50"),
    "cloud.off": (off(TRIANGLE, []), "no faces, so it is read as a point cloud: a point cloud of 3 points"),
    "missing_vertex.off": (off(TRIANGLE, [(0, 1, 7)]), "do not exist"),
    "missing_vertex.obj": ((FLAT + "f 1 2 12\n").encode(), "do not exist .*export it as .glb"),
    "scene.fbx": (b"<x/>", "cannot read .fbx: .*export it as .glb"),
    "broken.dae": (b"<x", "scene"),
    "empty.gltf": (b"{}", "no geometry"),
    "negative_vertex.off": (off(TRIANGLE, [(0, 1, -2)]), "do not exist"),
    "claims_too_much.ply": (ply(TRIANGLE, [(0, 1, 2)], count=10**13), "truncated: its header states"),
    "huge.off": (off(np.array(TRIANGLE) * 1e300, [(0, 1, 2)]), "overflow|NaN"),
    "wrong.abc": (b"0 0 0\n", "cannot read .abc"),
    "points.csv": (b"x,y,z\n0,0,0\n", "cannot read .csv: .*save its points as .xyz"),
    "header_only.stl": (b"\0" * 80 + struct.pack("<I", 0), "no faces|no geometry|unreadable"),
}


REFUSED["draco.glb"] = (
    joined({"extensionsRequired": ["KHR_draco_mesh_compression"]}, bytearray()),
    "needs KHR_draco_mesh_compress",
)


@pytest.mark.filterwarnings("ignore")
@pytest.mark.parametrize("name", REFUSED)
def test_bad_file_is_refused_with_its_reason(tmp_path, name):
    content, reason = REFUSED[name]
    path = tmp_path / name
    path.write_bytes(content)
    with pytest.raises(MeshError, match=reason):
        clean(load(path))
    with pytest.raises(MeshError, match="absent.stl"):
        load(tmp_path / "absent.stl")


@pytest.mark.filterwarnings("error")
def test_no_warning_of_numpy_comes_with_a_foreign_file(tmp_path):
    (tmp_path / "spare.obj").write_text(FLAT + "v 2 2 2\nv 0 0 1\nvt 0 0\nvt 1 0\nf 1/1 2/2 5/1\nf 1/1 5/1 3/2\n")
    assert load_as_stated(tmp_path / "spare.obj").faces.tolist() == [[0, 1, 4], [0, 4, 2]]
    shape = trimesh.Scene(trimesh.creation.box())
    shape.graph.update(
        frame_to="turned", matrix=trimesh.transformations.rotation_matrix(1, [1, 1, 0]), geometry="geometry_0"
    )
    content = shape.export(file_type="glb").replace(struct.pack("<f", 0.5), struct.pack("<f", np.inf))
    (tmp_path / "infinite.glb").write_bytes(content)
    with pytest.raises(MeshError, match="infinite.glb: .*NaN or infinite"):
        load_as_stated(tmp_path / "infinite.glb")


def test_a_glb_of_too_many_primitives_is_refused_at_once(tmp_path):
    tree = {"asset": {"version": "2.0"}, "meshes": [{"primitives": [{"attributes": {}}] * 100}]}
    path = tmp_path / "many.glb"
    path.write_bytes(joined(tree | {"nodes": [{"mesh": 0}] * 201}, bytearray()))
    with pytest.raises(MeshError, match="20,100 primitives are more than 20,000: join its parts"):
        load(path)


def png_of(side):
    """A square picture, black, one bit a pixel."""
    rows = zlib.compress(b"\0" * (side * (side // 8 + 1)), 9)
    parts = (b"IHDR", struct.pack(">IIBBBBB", side, side, 1, 0, 0, 0, 0)), (b"IDAT", rows), (b"IEND", b"")
    return b"\x89PNG\r\n\x1a\n" + b"".join(
        struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data)) for kind, data in parts
    )


@pytest.mark.parametrize("side, message", [(13_000, "of 13,000 x 13,000 pixels is larger"), (14_000, "is larger")])
def test_a_glb_with_a_texture_that_would_fill_the_memory_is_refused_before_it_is_parsed(
    tmp_path, monkeypatch, side, message
):
    """Pillow refuses 14,000 x 14,000 pixels itself, and trimesh then reads the mesh without its texture."""
    png, path = png_of(side), tmp_path / "big.glb"
    tree = {
        "asset": {"version": "2.0"},
        "materials": [{"pbrMetallicRoughness": {"baseColorTexture": {"index": 0}}}],
        "textures": [{"source": 0}],
        "images": [{"mimeType": "image/png", "bufferView": 0}],
        "bufferViews": [{"buffer": 0, "byteLength": len(png)}],
    }
    path.write_bytes(joined(tree, bytearray(png)))
    monkeypatch.setattr(trimesh, "load", None)
    with pytest.raises(MeshError, match=f"a texture {message} than 8,192 x 8,192"):
        load(path)


def test_a_texture_that_would_fill_the_memory_is_refused_by_its_header(tmp_path):
    side = 13_000
    png = png_of(side)
    folder = tmp_path / "big"
    folder.mkdir()
    (folder / "big.png").write_bytes(png)
    (folder / "big.mtl").write_text("newmtl a\nmap_Kd big.png\n")
    lines = ["mtllib big.mtl", "v 0 0 0", "v 1 0 0", "v 0 1 0", "v 0 0 1", "vt 0 0", "usemtl a"]
    lines += [f"f {a}/1 {b}/1 {c}/1" for a, b, c in ((1, 3, 2), (1, 2, 4), (1, 4, 3), (2, 3, 4))]
    (folder / "big.obj").write_text("\n".join(lines) + "\n")
    with pytest.raises(
        MeshError, match="a texture of 13,000 x 13,000 pixels is larger than 8,192 x 8,192: scale it down"
    ):
        load(folder / "big.obj")


def test_obj_with_texture_seams_keeps_one_vertex_a_line_and_polygons_become_triangles(tmp_path):
    # A vertex with two texture coordinates must not become two: ground truth counts the `v` lines.
    path = tmp_path / "seam.obj"
    path.write_text(
        "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nvt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\nvt .5 .5\n"
        "vn 0 0 1\nvn 1 0 0\nf 1/1/1 2/2/1 3/3/1\nf 1/5/2 3/3/2 4/4/2\n"
    )
    mesh = load(path)
    assert len(mesh.vertices) == 4 and len(mesh.faces) == 2
    path.write_text("v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf 1 2 3 4\n")
    assert load(path).face_areas.sum() == pytest.approx(1)


@pytest.mark.parametrize(
    "old, new",
    [
        ("", "\ufeff"),
        (" ", "\t"),
        ("2 3\n", "2 3 # top\n"),
        ("0\n", "0 # a vertex\n"),
        ("f ", "# v\nf "),
        ("f ", "  f "),
        ("v ", " v "),
        ("2 3\n", "2\\\n 3\n"),
    ],
)
def test_an_obj_of_other_editors_has_the_faces_of_a_plain_one(tmp_path, old, new):
    text = FLAT + "v 0 0 1\nf 1 2 3\nf 1 3 4\n"
    path = tmp_path / "edited.obj"
    path.write_text(text.replace(old, new) if old else new + text, encoding="utf-8")
    mesh = load_as_stated(path)
    assert mesh.vertices.tolist() == [[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]]
    assert mesh.faces.tolist() == [[0, 1, 2], [0, 2, 3]]


@pytest.mark.parametrize(
    ("name", "content", "text"),
    [
        ("a.obj", FLAT.encode() + b"f 1 2 3\nl 1 2\n\tl 2 3\np 1\n", "lines (2), points (1)"),
        ("a.obj", FLAT.encode() + b"f 1 2 3\n#l 1 2\ng l 1\n", ""),
        ("a.obj", FLAT.encode() + b"f 1 2 3\nf 1 2 # edge\r\n f 3//\n", "faces of fewer than three corners (2)"),
        ("a.obj", FLAT.encode() + b"f 1 2 \\\n 3\n", ""),
        ("a.off", b"OFF\n3 3 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n2 0 1\n1 2\n", "faces of fewer than three corners (2)"),
        ("a.ply", ply(TRIANGLE, [(0, 1, 2)]).replace(b"end_header", b"element edge 0\nproperty int a\nend_header"), ""),
        ("a.ply", ply(TRIANGLE, [(0, 1, 2)]).replace(b"end_header", b"element edge 2\nproperty int a\nend_header")
         + b"0\n1\n", "edges (2)"),
        ("a.ply", ply(TRIANGLE, [(0, 1, 2), (0, 1), (2,)]), "faces of fewer than three corners (2)"),
        ("a.ply", binary_ply(TRIANGLE, [(0, 1), (0, 1, 2), (2,)]), "faces of fewer than three corners (2)"),
        ("a.ply", binary_ply(TRIANGLE, [(0, 1, 2)]), ""),
    ],
)  # fmt: skip
def test_a_warning_counts_the_lines_and_points_beside_faces(tmp_path, recwarn, name, content, text):
    (tmp_path / name).write_bytes(content)
    assert len(load_as_stated(tmp_path / name).faces) == 1
    assert [str(warning.message) for warning in recwarn] == [f"{name}: left out: {text}"] * bool(text)


@pytest.mark.parametrize("corners", ["0 1 2", "1 2 0", "-1 -2 -4", "1/1 0/1 2/1"])
def test_an_obj_that_counts_from_zero_or_beyond_its_vertices_is_refused(corners):
    with pytest.raises(MeshError, match="faces name (a|the) vertex .* which does not exist"):
        parse(f"v 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nf 1 2 3\nf {corners}\n".encode(), ".obj")


@pytest.mark.parametrize("lines", ["mtllib a.mtl\nmtllib b c.mtl\n", "mtllib a.mtl d.mtl\n"])
def test_all_material_libraries_of_an_obj_are_read(tmp_path, lines):
    (tmp_path / "a.mtl").write_text("newmtl red\nKd 1 0 0\n")
    for name in ("b c.mtl", "d.mtl"):
        (tmp_path / name).write_text("newmtl blue\nKd 0 0 1\n")
    faces = "usemtl red\nf 1 2 3\nusemtl blue\nf 2 1 4\n"
    (tmp_path / "two.obj").write_text(f"{lines}v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 -1 0\n{faces}")
    mesh = load(tmp_path / "two.obj")
    assert sorted(tuple(image[0, 0, :3]) for image in mesh.texture.images) == [(0, 0, 255), (255, 0, 0)]
    assert obj_not_read(tmp_path / "two.obj") == ["names of materials"]


def test_a_binary_stl_whose_header_speaks_of_a_facet_is_binary():
    content = trimesh.creation.box().export(file_type="stl")
    assert len(parse(b"solid facet part".ljust(80) + content[80:], ".stl").faces) == 12


def test_a_binary_stl_that_states_no_faces_has_those_that_follow(tmp_path):
    content = trimesh.creation.box().export(file_type="stl")
    path = tmp_path / "unfinished.stl"
    path.write_bytes(content[:80] + bytes(4) + content[84:] + b"end")
    assert len(load_as_stated(path).faces) == 12


def test_non_manifold_faces_stay_and_duplicate_and_degenerate_ones_go_with_a_note(tmp_path):
    vertices = [(0, 0, 0), (0, 0, 1), (1, 0, 0), (0, 1, 0), (-1, 0, 0)]
    path = tmp_path / "fan.off"
    path.write_bytes(off(vertices, [(0, 1, 2), (0, 1, 3), (0, 1, 4)]))
    mesh, notes = clean(load(path))
    assert len(mesh.faces) == 3 and not mesh.watertight and not notes and mesh.edge_counts[1].max() == 3
    path.write_bytes(off(TRIANGLE, [(0, 1, 2), (1, 2, 0), (0, 0, 1), (2, 1, 0)]))
    mesh, notes = clean(load(path))
    assert len(mesh.faces) == 1  # the face seen from the back goes: all of the surface was doubled
    assert notes == [f"1 {flaw} faces removed" for flaw in ("degenerate", "duplicate", "back-to-back")]


@pytest.mark.parametrize(("suffix", "place", "warned"), [
    ("stl", 2e5, True), ("ply", 2e5, True), ("glb", 2e5, True), ("obj", 2e5, False), ("stl", 1e3, False),
    ("double.ply", 2e5, False),
])  # fmt: skip
def test_single_precision_far_from_the_origin_is_named(tmp_path, recwarn, suffix, place, warned):
    far = trimesh.creation.icosphere(subdivisions=2)
    far.apply_translation([place, 0, 0])
    if suffix == "double.ply":
        content = ply(far.vertices.tolist(), far.faces.tolist()).replace(b"property float", b"property double")
        (tmp_path / "far.double.ply").write_bytes(content)
    else:
        far.export(tmp_path / f"far.{suffix}")
    load_as_stated(tmp_path / f"far.{suffix}")
    message = f"far.{suffix}: its coordinates have steps of 0.45 % of the diagonal: move the object to the origin"
    assert [message in str(warning.message) for warning in recwarn] == [True] * warned

"""Meshes as people find them: doubled faces, strips, files without faces, long triangles, flat places."""

import struct

import numpy as np
import pytest
import trimesh
from PIL import Image
from trimesh.visual import TextureVisuals
from trimesh.visual.material import PBRMaterial

from haptic_glance import Mesh, MeshError, as_mesh, clean, load
from haptic_glance.__main__ import run
from haptic_glance.cli.saliency import finely
from haptic_glance.cli.simplify import dropped_from
from haptic_glance.lod import colour_error
from haptic_glance.mesh.files import files_of, parse
from haptic_glance.mesh.materials import bake_texture
from haptic_glance.mesh.obj import not_read
from haptic_glance.mesh.polygons import refined
from tests.shapes import ball_mesh


@pytest.fixture
def ball():
    """A ball of 320 faces."""
    return ball_mesh(2)


def doubled(mesh):
    return Mesh(mesh.vertices, np.concatenate([mesh.faces, mesh.faces[:, ::-1]]))


def test_a_surface_that_was_doubled_loses_one_of_its_sides(ball):
    cleaned, notes = clean(doubled(ball))
    assert len(cleaned.faces) == len(ball.faces) and "320 back-to-back faces removed" in notes[0]
    assert cleaned.face_crosses.sum(axis=0) == pytest.approx(0, abs=1e-9)
    assert (np.einsum("ij,ij->i", cleaned.face_normals, cleaned.vertices[cleaned.faces].mean(axis=1)) > 0).all()


def test_a_thin_sheet_on_a_body_keeps_both_sides(ball):
    faces = np.concatenate([ball.faces, ball.faces[:5, ::-1]])
    assert len(clean(Mesh(ball.vertices, faces))[0].faces) == 325


@pytest.mark.parametrize("binary", [False, True])
def test_strips_of_a_ply_are_faces(tmp_path, binary):
    points = [(0, 0, 0), (1, 0, 0), (0, 1, 0), (1, 1, 0), (0, 2, 1)]
    strip = [0, 1, 2, 3, -1, 2, 3, 4]
    head = f"ply\nformat {'binary_little_endian' if binary else 'ascii'} 1.0\nelement vertex 5\n"
    head += "".join(f"property float {axis}\n" for axis in "xyz")
    head += "element tristrips 1\nproperty list int int vertex_indices\nend_header\n"
    if binary:
        body = b"".join(struct.pack("<3f", *point) for point in points) + struct.pack("<9i", 8, *strip)
    else:
        body = "".join(f"{x} {y} {z}\n" for x, y, z in points).encode() + f"8 {' '.join(map(str, strip))}\n".encode()
    (tmp_path / "strips.ply").write_bytes(head.encode() + body)
    assert load(tmp_path / "strips.ply", up="z").faces.tolist() == [[0, 1, 2], [3, 2, 1], [2, 3, 4]]


COLOURS = {  # the kind of a property: (its prefix, what stands for a colour)
    "uchar": ("", [200, 128, 1]),
    "float": ("", [200.0, 128.0, 1.0]),
    "double": ("", [200 / 255, 128 / 255, 1 / 255]),
    "ushort": ("", [200 * 257, 128 * 257, 257]),
    "uint8": ("diffuse_", [200, 128, 1]),
}


@pytest.mark.parametrize("kind", COLOURS)
def test_colours_of_a_ply_are_bytes_however_it_states_them(tmp_path, kind):
    prefix, colour = COLOURS[kind]
    head = "ply\nformat ascii 1.0\nelement vertex 3\n" + "".join(f"property float {axis}\n" for axis in "xyz")
    head += "".join(f"property {kind} {prefix}{name}\n" for name in ("red", "green", "blue"))
    head += "element face 1\nproperty list uchar int vertex_indices\nend_header\n"
    rows = "".join(f"{x} {y} 0 {' '.join(map(str, colour))}\n" for x, y in ((0, 0), (1, 0), (0, 1)))
    (tmp_path / "a.ply").write_text(head + rows + "3 0 1 2\n")
    assert load(tmp_path / "a.ply", up="z").colors.tolist() == [[200, 128, 1]] * 3


@pytest.mark.parametrize("colour", ["200 128 0", "0.7843 0.50196 0"])
@pytest.mark.parametrize("material", ["", "usemtl a\n"])
def test_colours_of_an_obj_are_bytes_however_it_states_them(tmp_path, colour, material):
    rows = "".join(f"v {x} {y} 0 {colour}\n" for x, y in ((0, 0), (1, 0), (0, 1)))
    (tmp_path / "a.obj").write_text(rows + material + "f 1 2 3\n")
    assert load(tmp_path / "a.obj", up="z").colors.tolist() == [[200, 128, 0]] * 3


@pytest.mark.parametrize("order", "<>")
def test_a_binary_ply_of_mixed_polygons_has_the_triangles_of_each(tmp_path, order):
    corners = [(0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0), (0, 2, 1)]
    polygons = [(0, 1, 2, 3), (2, 4, 3), (0, 1, 2, 4, 3), (1, 0)]
    head = f"ply\nformat binary_{'little' if order == '<' else 'big'}_endian 1.0\ncomment Blender\nelement vertex 5\n"
    head += "".join(f"property float {name}\n" for name in ("x", "y", "z", "nx", "ny", "nz"))
    head += "".join(f"property uchar {name}\n" for name in ("red", "green", "blue"))
    head += "element face 4\nproperty short material\nproperty list ushort uint vertex_indices\nproperty uchar flag\n"
    body = b"".join(struct.pack(f"{order}6f3B", *corner, 0, 0, 1, 9, 8, i) for i, corner in enumerate(corners))
    body += b"".join(struct.pack(f"{order}hH{len(ids)}IB", 7, len(ids), *ids, 1) for ids in polygons)
    tail = b"element more 1\nproperty int a\nend_header\n"
    (tmp_path / "mixed.ply").write_bytes(head.encode() + tail + body + struct.pack(f"{order}i", 5))
    mesh = load(tmp_path / "mixed.ply", up="z")
    assert mesh.vertices.tolist() == np.array(corners).tolist() and mesh.colors.tolist() == [
        [9, 8, i] for i in range(5)
    ]
    assert mesh.faces.tolist() == [[0, 1, 2], [0, 2, 3], [2, 4, 3], [0, 1, 2], [0, 2, 4], [0, 4, 3]]
    (tmp_path / "mixed.ply").write_bytes(head.encode() + b"end_header\n" + body[:-2])
    with pytest.raises(MeshError, match="truncated: it ends in a face"):
        load(tmp_path / "mixed.ply")


ARROW = [(0, 0), (4, 0), (4, 4), (3, 1)]  # an area of 4
COMB = [(0, 0), (5, 0), (5, 3), (4, 3), (4, 1), (3, 1), (3, 3), (2, 3), (2, 1), (1, 1), (1, 3), (0, 3)]  # of 11


def polygon_file(kind, points, rings):
    """The bytes of a file of flat polygons: obj, off, or ply with values before and behind the list of each face."""
    rows = [f"{x} {y} 0" for x, y in points]
    listed = [" ".join(map(str, (len(ring), *ring))) for ring in rings]
    if kind == "obj":
        faces = ["f " + " ".join(f"{corner + 1}/{corner + 1}" for corner in ring) for ring in rings]
        return "\n".join([f"v {row}" for row in rows] + [f"vt {x} {y}" for x, y in points] + faces).encode()
    if kind == "off":
        return "\n".join(["OFF", f"{len(rows)} {len(rings)} 0", *rows, *listed]).encode()
    header = f"ply\nformat {kind} 1.0\nelement vertex {len(rows)}\n"
    header += "".join(f"property float {axis}\n" for axis in "xyz") + f"element face {len(rings)}\n"
    header += "property uchar before\nproperty list uchar int vertex_indices\nproperty uchar behind\nend_header\n"
    if kind == "ascii":
        return header.encode() + "\n".join([*rows, *(f"7 {text} 8" for text in listed)]).encode()
    order = ">" if "big" in kind else "<"
    vertices = np.array([(*point, 0) for point in points], dtype=order + "f4").tobytes()
    faces = (bytes([7, len(ring)]) + np.array(ring, dtype=order + "i4").tobytes() + b"\x08" for ring in rings)
    return header.encode() + vertices + b"".join(faces)


@pytest.mark.parametrize("beside", [False, True])
@pytest.mark.parametrize("shape", [ARROW, COMB])
@pytest.mark.parametrize("kind", ["obj", "off", "ascii", "binary_little_endian", "binary_big_endian"])
def test_a_concave_polygon_is_not_folded(kind, shape, beside):
    points = [*shape, (10, 0), (11, 0), (11, 1), (10, 1)]
    others = [range(len(shape), len(points)), range(len(shape), len(points) - 1)] if beside else []
    for turn in range(len(shape)):
        ring = np.roll(np.arange(len(shape)), turn)
        content = polygon_file(kind, points, [ring, *others])
        mesh = parse(content, f".{kind if kind in ('obj', 'off') else 'ply'}")
        assert len(mesh.faces) == len(shape) - 2 + 3 * beside and (mesh.face_normals[:, 2] > 0).all()
        assert mesh.face_areas.sum() == pytest.approx((4 if shape is ARROW else 11) + 1.5 * beside)


@pytest.mark.parametrize("beside", ["", "/{0}", "//{0}", "/{0}/{0}"])
def test_numbers_that_count_back_count_from_the_line_of_the_face(beside):
    """A square and an arrow, each behind its own corners, as exporters of several objects write them."""
    face = "f " + " ".join(str(number) + beside.format(number) for number in (-4, -3, -2, -1))
    lines = []
    for shape in ([(0, 0), (1, 0), (1, 1), (0, 1)], [(x + 5, y) for x, y in ARROW]):
        lines += [f"v {x} {y} 0" for x, y in shape] + [f"vt {x} {y}" for x, y in shape] + ["vn 0 0 1"] * 4 + [face]
    mesh = parse("\n".join([*lines, ""]).encode(), ".obj")
    assert len(mesh.faces) == 4 and mesh.face_areas.sum() == pytest.approx(1 + 4) and mesh.used.size == 8
    assert (mesh.face_normals[:, 2] > 0).all()


BENT = [(0, 0, 0), (4, 0, 0), (4, 4, 3), (3, 1, 0)]
CROSSED = [(0, 0, 0), (4, 1, 0), (4, 0, 0), (0, 2, 0)]
CONVEX = [(0, 0, 0), (2, 0, 0), (4, 0, 0), (4, 4, 0), (0, 4, 0)]


@pytest.mark.parametrize("points", [BENT, CROSSED, CONVEX, [(0, 0, 0)] * 4, [(np.nan, 0, 0)] * 4])
def test_other_polygons_keep_their_fan(points):
    assert refined(np.arange(len(points)), np.array([len(points)]), np.array(points, dtype=float)) == {}


@pytest.mark.slow
def test_the_saliency_of_long_triangles_is_drawn_on_a_finer_copy(tmp_path):
    box = trimesh.creation.box((1.0, 2.0, 0.5))
    mesh = Mesh(box.vertices, box.faces)
    shown, values = finely(mesh, np.zeros(8))
    assert len(shown.faces) > 2000 and values.shape == (len(shown.vertices),) and values.max() == 1
    assert shown.face_areas.sum() == pytest.approx(mesh.face_areas.sum())
    fine = Mesh(shown.vertices, shown.faces)
    assert finely(fine, values)[0] is fine
    box.export(tmp_path / "box.stl")
    run(
        "saliency",
        [str(tmp_path / "box.stl"), "--out", str(tmp_path / "look.ply"), "--picture", str(tmp_path / "a.png")],
    )
    assert len(load(tmp_path / "look.ply", up="z").faces) == len(shown.faces)
    assert np.asarray(Image.open(tmp_path / "a.png")).std() > 10


@pytest.mark.parametrize("named", ["maps/wood 1.png", "maps\\wood 1.png", "-o 0 -s 1 1.5 1 -clamp on maps/wood 1.png"])
def test_the_picture_of_an_obj_is_found_however_its_material_names_it(tmp_path, named):
    (tmp_path / "maps").mkdir()
    Image.new("RGB", (2, 2), "red").save(tmp_path / "maps" / "wood 1.png")
    (tmp_path / "a.mtl").write_text(f"newmtl m\nKd 1 1 1\nmap_Kd {named}\n")
    path = tmp_path / "a.obj"
    path.write_text("mtllib a.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nusemtl m\nf 1/1 2/1 3/1\n")
    assert [image[0, 0].tolist() for image in load(path, up="z").texture.images] == [[255, 0, 0, 255]]
    dropped = dropped_from(path, load(path))
    assert dropped.endswith(": map_Kd -o, map_Kd -s") if "-s" in named else not dropped
    (tmp_path / "maps" / "wood 1.png").unlink()
    assert ": picture maps/wood 1.png, not beside it" in dropped_from(path, load(path))
    (tmp_path / "a.mtl").unlink()
    assert dropped_from(path, load(path)).endswith(": materials a.mtl, not beside it")


@pytest.mark.parametrize("encoding", ["utf-8", "utf-8-sig", "latin-1"])
def test_an_obj_and_its_materials_may_have_umlauts_in_any_encoding(tmp_path, encoding):
    Image.new("RGB", (2, 2), "red").save(tmp_path / "grün.png")
    (tmp_path / "ä.mtl").write_text("newmtl ö\nmap_Kd grün.png\n", encoding)
    path = tmp_path / "a.obj"
    lines = "mtllib ä.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nusemtl ö\nf 1/1 2/1 3/1\n"
    path.write_text("#" * 1000 + "\n" + lines, encoding)  # the parser judges by so many characters
    assert [image[0, 0].tolist() for image in load(path, up="z").texture.images] == [[255, 0, 0, 255]]
    assert not dropped_from(path, load(path)) and len(files_of(path)) == 2


@pytest.mark.parametrize(
    ("material", "lines", "named"),
    [
        ("d 0.5", "", ["d"]), ("d 1.0", "", []), ("Tr 0.5", "", ["Tr"]), ("Ks 0 0.2 0", "", ["Ks"]),
        ("Ks 0 0 0", "", []), ("Ke 1 1 0", "", ["Ke"]), ("map_Ks a.png", "", ["map_Ks"]),
        ("Kd 1 0 0\nmap_Kd a.png", "", ["Kd beside map_Kd"]),
        ("Kd 1 0 0\nnewmtl n\nmap_Kd a.png", "", ["names of materials"]),
        ("Kd 0.8 0.8 0.8\nmap_Kd a.png", "", []), ("Kd 1 1 1\nmap_Kd a.png", "", []),
        ("", "l 1 2", ["lines"]), ("", "p 1", ["points"]), ("", "v 0 0 1 1 0 0", ["colours of vertices"]),
    ],
)  # fmt: skip
def test_all_of_an_obj_and_its_materials_that_a_mesh_cannot_hold_is_named(tmp_path, material, lines, named):
    Image.new("RGB", (2, 2), (200, 100, 50)).save(tmp_path / "a.png")
    (tmp_path / "a.mtl").write_text(f"newmtl m\n{material}\n")
    rows = "v 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nusemtl m\nf 1/1 2/1 3/1\n"
    (tmp_path / "a.obj").write_text(f"mtllib a.mtl\n{lines}\n{rows}")
    assert not_read(tmp_path / "a.obj") == named


@pytest.mark.slow
@pytest.mark.parametrize("kind", ["faces", "picture"])
def test_a_ply_keeps_the_colours_of_its_faces_and_its_picture_through_a_command(ball, tmp_path, kind):
    red = ball.vertices[ball.faces].mean(axis=1)[:, 0] > 0
    shown = trimesh.Trimesh(ball.vertices, ball.faces, process=False)
    colors = np.where(red[:, None], [200, 0, 0, 255], [0, 0, 200, 255]).astype(np.uint8)
    shown.visual = trimesh.visual.ColorVisuals(shown, face_colors=colors)
    content = shown.export(file_type="ply", encoding="ascii")
    if kind == "picture":
        u = np.where(ball.vertices[:, 0] > 0, 0.75, 0.25)
        Image.fromarray(np.array([[[0, 0, 200], [200, 0, 0]]], np.uint8)).save(tmp_path / "paint.png")
        head = ["ply", "format ascii 1.0", "comment TextureFile paint.png", f"element vertex {len(u)}"]
        head += [f"property float {name}" for name in ("x", "y", "z", "s", "t")]
        head += [f"element face {len(ball.faces)}", "property list uchar int vertex_indices", "end_header"]
        rows = [*np.column_stack([ball.vertices, u, u * 0]).tolist(), *([3, *face] for face in ball.faces)]
        content = "\n".join([*head, *(" ".join(map(str, row)) for row in rows), ""]).encode()
    (tmp_path / "ball.ply").write_bytes(content)
    run("simplify", [str(tmp_path / "ball.ply"), "--faces", "200", "--out", str(tmp_path / "less.glb")])
    less = bake_texture(load(tmp_path / "less.glb"))
    x = less.vertices[:, 0]
    clear = np.abs(x) > 0.3
    assert (np.ptp(less.colors[clear], axis=0) == [200, 0, 200]).all()
    assert ((less.colors[:, 0] > 100) == (x > 0))[clear].all()


def test_a_baked_picture_is_multiplied_by_the_factor_beside_it(ball):
    material = PBRMaterial(baseColorTexture=Image.new("RGB", (2, 2), (200, 100, 50)), baseColorFactor=[51, 255, 0, 255])
    visual = TextureVisuals(ball.vertices[:, :2], material=material)
    mesh = as_mesh(trimesh.Scene(trimesh.Trimesh(ball.vertices, ball.faces, visual=visual, process=False)))
    assert (bake_texture(mesh).colors == [38, 100, 0]).all()  # multiplied without the encoding of sRGB
    assert colour_error(mesh, bake_texture(mesh)) < 1e-9

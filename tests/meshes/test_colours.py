"""The colours that a file brings, in every way a format has for them, are those of the vertices; or a palette's."""

import io
import pickle
from functools import partial

import numpy as np
import pytest
import trimesh
from PIL import Image
from trimesh.visual import TextureVisuals
from trimesh.visual.material import PBRMaterial

from haptic_glance.base.files import read_mesh, read_table
from haptic_glance.mesh import MeshError
from haptic_glance.mesh.gltf import with_linear_colours
from haptic_glance.mesh.materials import PALETTE, coloured
from haptic_glance.mesh.mesh import Mesh
from stages.meshes import __main__ as stage
from stages.meshes.collect import prepare_mesh
from stages.meshes.furniture import files_beside
from stages.meshes.sources import HOUSEHOLD, Content, MeshFile

RED, GREEN, BLUE, GOLD = (255, 0, 0), (0, 255, 0), (0, 0, 255), (200, 160, 20)
BRICK = (175, 54, 60)
# A tetrahedron: four corners, four faces; its corner 0 is at the origin.
CORNERS = np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]], dtype=float)
FACES = np.array([[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]])
# The middles of the four pixels of PICTURE, one for each corner: lower left, lower right, upper left, upper right.
UV = np.array([[0.25, 0.25], [0.75, 0.25], [0.25, 0.75], [0.75, 0.75]])
PICTURE = np.array([[BLUE, GOLD], [RED, GREEN]], dtype=np.uint8)
PAINTED = np.array([RED, GREEN, BLUE, GOLD])  # what the corners see of it
MEANS = np.array([[RED, GREEN, BLUE], [RED, GREEN, GOLD], [RED, BLUE, GOLD], [GREEN, BLUE, GOLD]]).mean(axis=1)


def png():
    stream = io.BytesIO()
    Image.fromarray(PICTURE).save(stream, "PNG")
    return stream.getvalue()


def obj(materials, *rows, library="paint.mtl"):
    """An OBJ with a texture coordinate a corner; rows: what stands before each face."""
    lines = [f"mtllib {library}", *(f"v {x} {y} {z}" for x, y, z in CORNERS), *(f"vt {u} {v}" for u, v in UV)]
    for row, face in zip(rows, FACES + 1, strict=True):
        lines += [row, "f " + " ".join(f"{corner}/{corner}" for corner in face)]
    return {"it.obj": "\n".join([*lines, ""]).encode(), "paint.mtl": materials.encode(), "paint.png": png()}


def coloured_obj(*head):
    """An OBJ with a colour behind each place, as scanners write it."""
    rows = np.column_stack([CORNERS, PAINTED / 255])
    lines = [*head, *("v " + " ".join(map(str, row)) for row in rows)]
    return "\n".join([*lines, *("f " + " ".join(map(str, face)) for face in FACES + 1), ""]).encode()


def linear_glb(loaded):
    """The bytes of a GLB as other programs write it: its colours are linear."""
    return with_linear_colours(loaded.export(file_type="glb"))


def glb(visual, corners=CORNERS, faces=FACES):
    return {"it.glb": linear_glb(trimesh.Trimesh(corners, faces, process=False, visual=visual))}


def pictured(uv):
    return TextureVisuals(uv, material=PBRMaterial(baseColorTexture=Image.fromarray(PICTURE)))


def ply(header, corners, faces, places=CORNERS, triangles=FACES):
    """A PLY. header: a comment, properties of vertices, properties of faces; corners, faces: their values."""
    head = ["ply", "format ascii 1.0", header[0], "element vertex 4", *(f"property float {a}" for a in "xyz")]
    head += [*header[1], f"element face {len(triangles)}", "property list uchar int vertex_indices", *header[2]]
    rows = [" ".join(map(str, [*place, *more])) for place, more in zip(places, corners, strict=True)]
    rows += [" ".join(map(str, [3, *face, *more])) for face, more in zip(triangles, faces, strict=True)]
    return {"it.ply": "\n".join([*head, "end_header", *rows, ""]).encode(), "paint.png": png()}


RGB = [f"property uchar {name}" for name in ("red", "green", "blue")]
NAMED, NOTHING = "comment TextureFile paint.png", [()] * 4
ALL_RED = [RED] * 4
OF_FACES = [RED, GREEN, BLUE, GOLD]
CARRIERS = {  # name: (files, colours of the corners)
    "obj, a picture": (obj("newmtl a\nKd 1 1 1\nmap_Kd paint.png\n", "usemtl a", "", "", ""), PAINTED),
    "obj, a plain colour": (obj("newmtl a\nKd 1 0 0\n", "usemtl a", "", "", ""), ALL_RED),
    "obj, a colour a face": (
        obj("newmtl a\nKd 1 0 0\nnewmtl b\nKd 0 1 0\n", "usemtl a", "usemtl b", "usemtl b", "usemtl b"),
        [(85, 170, 0), (85, 170, 0), (85, 170, 0), GREEN],
    ),
    "obj, a picture of Windows": (obj("newmtl a\nmap_Kd .\\paint.png\n", "usemtl a", "", "", ""), PAINTED),
    "obj, colours of vertices": ({"it.obj": coloured_obj()}, PAINTED),
    "glb, a picture": (glb(pictured(UV)), PAINTED),
    "glb, a coloured part beside one with a material": (
        {"it.glb": linear_glb(trimesh.Scene([
            trimesh.Trimesh(CORNERS, FACES[:2], process=False, vertex_colors=PAINTED),
            trimesh.Trimesh(CORNERS, FACES[2:], process=False, visual=pictured(UV)),
        ]))}, PAINTED),
    "obj, colours of vertices and a plain material": (
        {"it.obj": coloured_obj("mtllib paint.mtl", "usemtl a"), "paint.mtl": b"newmtl a\nKd .7 .7 .7\n"}, PAINTED),
    "glb, a picture on loose faces": (
        glb(pictured(UV[FACES.ravel()]), CORNERS[FACES.ravel()], np.arange(12).reshape(4, 3)), PAINTED),
    "glb, a plain colour": (glb(TextureVisuals(UV, material=PBRMaterial(baseColorFactor=[*RED, 255]))), ALL_RED),
    "glb, colours of vertices": (glb(trimesh.visual.ColorVisuals(vertex_colors=PAINTED)), PAINTED),
    "ply, colours of vertices": (ply(["comment none", RGB, []], PAINTED, NOTHING), PAINTED),
    "ply, colours of faces": (ply(["comment none", [], RGB], NOTHING, OF_FACES), MEANS),
    "ply, a picture": (
        ply([NAMED, ["property float s", "property float t"], []], UV, NOTHING), PAINTED),
    "ply, a picture by face": (
        ply([NAMED, [], ["property list uchar float texcoord"]], NOTHING,
            [(6, *UV[face].ravel()) for face in FACES]), PAINTED),
    "off, colours of vertices": (
        {"it.off": "\n".join(["COFF", "4 4 0", *(" ".join(map(str, [*place, *colour, 255])) for place, colour in
                                                zip(CORNERS, PAINTED, strict=True)),
                              *(f"3 {a} {b} {c}" for a, b, c in FACES)]).encode()}, PAINTED),
}  # fmt: skip
NONE = {
    "obj without its materials": {"it.obj": obj("", "usemtl a", "", "", "")["it.obj"]},
    "obj without use of its materials": obj("newmtl a\nKd 1 0 0\n", "", "", "", ""),
    "glb": {"it.glb": trimesh.Trimesh(CORNERS, FACES).export(file_type="glb")},
    "glb with a material without colour": glb(TextureVisuals(UV, material=PBRMaterial(metallicFactor=0.5))),
    "stl": {"it.stl": trimesh.Trimesh(CORNERS, FACES).export(file_type="stl")},
    "ply without its picture": {
        "it.ply": ply([NAMED, ["property float s", "property float t"], []], UV, NOTHING)["it.ply"]
    },
}


@pytest.fixture
def item(tmp_path):
    """A function from files, the mesh the first, to the MeshFile of a folder, up as in the file."""

    def write(files):
        for name, content in files.items():
            (tmp_path / name).write_bytes(content)
        path = tmp_path / next(iter(files))
        beside = Content(partial(files_beside, path))
        return MeshFile("it", path.name, path.suffix, Content(path.read_bytes), "z", "m", "none", beside=beside)

    return write


def colours_at_corners(mesh):
    """(4, 3): the colours at CORNERS of the normalised tetrahedron, whatever the order of its vertices."""
    places = (CORNERS - 0.5) / np.sqrt(3)
    near = np.linalg.norm(mesh.vertices[None] - places[:, None], axis=2)
    assert near.min(axis=1).max() < 1e-6
    return mesh.colors[near.argmin(axis=1)].astype(int)


@pytest.mark.parametrize("name", CARRIERS)
def test_every_way_to_colour_a_mesh_gives_the_vertices_their_colours(item, name):
    files, expected = CARRIERS[name]
    mesh, known = prepare_mesh(item(files), colours="own")
    assert len(mesh.vertices) == 4 and len(mesh.faces) == 4 and mesh.watertight and known["colors"]
    assert np.abs(colours_at_corners(mesh) - expected).max() <= 1
    mesh, known = prepare_mesh(item(files))  # by default colours per vertex alone count
    assert (mesh.colors is not None) == known["colors"] == ("of vertices" in name)
    if name == "ply, colours of faces":
        mesh, _ = prepare_mesh(item(files), colours="palette")
        assert np.abs(colours_at_corners(mesh) - expected).max() <= 1


@pytest.mark.parametrize("name", NONE)
def test_a_mesh_without_colours_is_refused_or_painted(item, name):
    file = item(NONE[name])
    with pytest.raises(MeshError, match="no colours of its own: set meshes.colours=palette"):
        prepare_mesh(file, colours="own")
    mesh, _ = prepare_mesh(file, colours="palette")
    assert len(np.unique(mesh.colors, axis=0)) == 1 and (mesh.colors[0] == PALETTE).all(axis=1).any()


def test_the_palette_goes_by_the_name_and_tells_objects_apart():
    colours = {name: tuple(coloured(Mesh(CORNERS, FACES), name, "palette").colors[0]) for name in HOUSEHOLD}
    assert colours["hammer"] == BRICK  # the same on every machine
    assert len(set(colours.values())) > 15


def test_colours_survive_repair_and_any_order_of_vertices_and_faces(item):
    old = np.array([2, 0, 3, 1])
    faces = np.argsort(old)[FACES][::-1]
    faces = np.concatenate([faces[:1, ::-1], faces[1:], faces[1:2], [[0, 0, 1]]])  # turned, doubled, degenerate
    mesh, known = prepare_mesh(item(ply(["comment none", RGB, []], PAINTED[old], [()] * 6, CORNERS[old], faces)))
    assert known["repairs"].count(";") == 3 and mesh.watertight
    assert (colours_at_corners(mesh) == PAINTED).all()


def test_a_file_that_is_named_and_absent_is_noted(item):
    files = dict(CARRIERS["obj, a picture"][0])
    files["paint.mtl"] = b"newmtl a\nKd 1 0 0\nmap_Kd gone.png\n"
    mesh, known = prepare_mesh(item(files), colours="own")
    assert (
        known["repairs"].startswith("gone.png, which it names, is not there; only 4 faces")
        and (mesh.colors == RED).all()
    )


def test_the_files_of_the_materials_travel_with_the_mesh(item, tmp_path):
    file = item(CARRIERS["obj, a picture"][0])
    sent = pickle.dumps(file)
    for path in tmp_path.iterdir():
        path.unlink()
    mesh, _ = prepare_mesh(pickle.loads(sent), colours="own")
    assert (colours_at_corners(mesh) == PAINTED).all()


def test_files_outside_the_folder_of_the_mesh_are_not_read(item, tmp_path):
    (tmp_path.parent / "secret.mtl").write_text("newmtl a\nKd 1 0 0\n")
    file = item({"it.obj": obj("", "usemtl a", "", "", "", library="../secret.mtl")["it.obj"]})
    assert file.beside() == {"../secret.mtl": b""}


@pytest.fixture
def run(tmp_path, make_workspace):
    """A function that runs the stage on a folder with a painted tetrahedron, a grey one, and other settings."""
    folder = tmp_path / "mine"
    folder.mkdir()
    files = CARRIERS["obj, a picture"][0] | {"grey.stl": NONE["stl"]["it.stl"]}
    for name, content in files.items():
        (folder / name).write_bytes(content)

    def run(**settings):
        section = {"source": "folder", "folder": str(folder), "up": "z", "unit": "mm", "objects": [], "classes": {}}
        workspace = make_workspace({"meshes": section | {"strict": False} | settings})
        stage.run(workspace)
        return workspace.data / "meshes"

    return run


def test_the_stage_names_the_mesh_without_colours_and_goes_on(run, capsys):
    folder = run(colours="own")
    assert "refused grey.stl: has no colours of its own: set meshes.colours=palette" in capsys.readouterr().err
    assert (colours_at_corners(read_mesh(folder / "it.npz")) == PAINTED).all()
    assert list(read_table(folder / "refused.csv").object) == ["grey"]
    folder = run(colours="palette")
    assert read_mesh(folder / "grey.npz").colors is not None and not len(read_table(folder / "refused.csv"))


def test_another_picture_is_another_mesh(run, tmp_path):
    run(colours="own")
    Image.fromarray(PICTURE[:, ::-1]).save(tmp_path / "mine" / "paint.png")
    corners = colours_at_corners(read_mesh(run(colours="own") / "it.npz"))
    assert (corners == [GREEN, RED, GOLD, BLUE]).all()

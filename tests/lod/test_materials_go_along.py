"""A glTF material on the way through `haptic-glance simplify`: factors, names and undecoded pictures."""

import io
from dataclasses import replace

import numpy as np
import pytest
import trimesh
from PIL import Image
from PIL.ImageFile import ImageFile
from scipy.ndimage import map_coordinates
from trimesh.visual import TextureVisuals
from trimesh.visual.material import PBRMaterial

from haptic_glance import as_mesh, simplify, to_trimesh
from haptic_glance.cli.simplify import dropped_from, run
from haptic_glance.lod.errors import colour_error
from haptic_glance.lod.export import _in_pictures, write_any
from haptic_glance.lod.task import repaired
from haptic_glance.mesh import load
from haptic_glance.mesh.gltf import as_glb, joined, opened, with_linear_colours
from haptic_glance.mesh.materials import bake_texture, corner_colours, not_read
from haptic_glance.mesh.mesh import Mesh, Texture
from haptic_glance.mesh.srgb import decoded, encoded


def picture(colour, kind="PNG"):
    """A picture of a file, not decoded yet."""
    packed = io.BytesIO()
    Image.new("RGB", (8, 8), colour).save(packed, kind)
    return Image.open(packed)


def ball(place, **material):
    part = trimesh.creation.icosphere(subdivisions=2)
    part.apply_translation([place, 0, 0])
    part.visual = TextureVisuals(part.vertices[:, :2] / 4 + 0.5, material=PBRMaterial(**material))
    return part


def art():
    """Two balls: one of varnish with three pictures, and one of metal with a plain colour."""
    maps = {
        "normalTexture": picture((128, 128, 255), "JPEG"),
        "metallicRoughnessTexture": picture((0, 90, 200), "JPEG"),
    }
    varnish = ball(
        0, name="varnish", baseColorTexture=picture((200, 40, 40)), roughnessFactor=0.4, metallicFactor=0.9,
        emissiveFactor=[0.1, 0.2, 0.3], alphaMode="BLEND", doubleSided=False, **maps,
    )  # fmt: skip
    metal = ball(3, name="metal", baseColorFactor=[0, 0, 255, 255], roughnessFactor=0.2, alphaMode="MASK",
                 alphaCutoff=0.7, doubleSided=True)  # fmt: skip
    return trimesh.Scene({"varnish": varnish, "metal": metal})


def materials_of(path):
    return opened(path.read_bytes())[0]["materials"]


def pictures(path, material):
    """{name: bytes} of the pictures that a material of a GLB uses."""
    tree, binary = opened(path.read_bytes())
    contents = {}
    for name, use in (material | material["pbrMetallicRoughness"]).items():
        if isinstance(use, dict) and "index" in use:
            view = tree["bufferViews"][tree["images"][tree["textures"][use["index"]]["source"]]["bufferView"]]
            start = view.get("byteOffset", 0)
            contents[name] = binary[start : start + view["byteLength"]]
    return contents


def rewritten(path, change):
    """Changes the JSON part of a GLB."""
    tree, binary = opened(path.read_bytes())
    change(tree)
    path.write_bytes(joined(tree, binary))


@pytest.fixture
def simplified(tmp_path, capsys):
    """Function: writes the scene, simplifies it and returns (the path written, what was reported)."""

    def work(out, change=None):
        (tmp_path / "art.glb").write_bytes(art().export(file_type="glb"))
        if change:
            rewritten(tmp_path / "art.glb", change)
        run([str(tmp_path / "art.glb"), "--faces", "30%", "--method", "height", "--out", str(tmp_path / out)])
        return tmp_path / out, capsys.readouterr().err

    return work


def test_materials_and_their_pictures_go_from_glb_to_glb(simplified, tmp_path):
    out, messages = simplified("out.glb")
    assert int.from_bytes(out.read_bytes()[8:12], "little") == out.stat().st_size  # as its header says
    paths = tmp_path / "art.glb", out
    before, after = ({entry["name"]: entry for entry in materials_of(path)} for path in paths)
    assert set(after) == {"varnish", "metal"} and "dropped" not in messages
    for name in after:
        plain = {key for key, value in before[name].items() if not isinstance(value, dict)}
        assert {key: after[name][key] for key in plain} == {key: before[name][key] for key in plain}
    ours = after["varnish"]["pbrMetallicRoughness"]
    assert (ours["roughnessFactor"], ours["metallicFactor"]) == (0.4, 0.9)
    assert after["metal"]["pbrMetallicRoughness"]["baseColorFactor"] == [0, 0, 1, 1]
    old, new = (pictures(path, entry["varnish"]) for path, entry in zip(paths, (before, after), strict=True))
    assert set(new) == {"normalTexture", "metallicRoughnessTexture", "baseColorTexture"}
    assert all(new[name] == old[name] for name in ("normalTexture", "metallicRoughnessTexture"))


def named(materials, name):
    """The one of the materials with this name."""
    (material,) = (entry for entry in materials if entry["name"] == name)
    return material


def test_what_cannot_be_carried_is_said_and_a_picture_on_other_coordinates_is_left_out(simplified):
    def change(tree):
        varnish = named(tree["materials"], "varnish")
        varnish["occlusionTexture"] = {**varnish["normalTexture"], "texCoord": 1}
        varnish["extensions"] = {"KHR_materials_clearcoat": {"clearcoatFactor": 1}}
        varnish["normalTexture"]["scale"] = 0.5
        tree["animations"] = [{"channels": [], "samplers": []}]
        tree["samplers"] = [{"magFilter": 9728, "wrapS": 33071}]  # the nearest pixel, and no repetition
        tree["textures"][varnish["normalTexture"]["index"]]["sampler"] = 0

    out, messages = simplified("out.glb", change)
    assert "dropped from art.glb" in messages
    lost = ("KHR_materials_clearcoat", "normalTexture.scale", "animations", "occlusionTexture.texCoord")
    lost += ("normalTexture.wrapS", "normalTexture.magFilter")
    assert all(name in messages for name in lost)
    varnish = named(materials_of(out), "varnish")
    assert "occlusionTexture" not in varnish and "normalTexture" in varnish


@pytest.mark.parametrize("name", ["paint", None])
def test_a_picture_on_other_coordinates_is_left_out_of_its_own_material_alone(tmp_path, name):
    def change(tree):
        for material in tree["materials"]:
            material["normalTexture"]["texCoord"] = int(material.pop("name") == "3")
            material |= {"name": name} if name else {}

    parts = {f"{place}": ball(place, name=f"{place}", normalTexture=picture((place, 128, 255)),
                              baseColorFactor=[place, 0, 0, 255]) for place in (0, 3)}  # fmt: skip
    (tmp_path / "art.glb").write_bytes(with_linear_colours(trimesh.Scene(parts).export(file_type="glb")))
    rewritten(tmp_path / "art.glb", change)
    mesh = load(tmp_path / "art.glb")
    reds = [image[0, 0, 0] for image in mesh.texture.images]
    kept = {red: material for red, material in zip(reds, mesh.texture.materials, strict=True)}
    assert "normalTexture" in kept[0] and "normalTexture" not in kept[3]
    assert [material.get("name") for material in kept.values()] == [name, name]
    assert not_read(as_glb(tmp_path / "art.glb")) == ["normalTexture.texCoord"]


@pytest.mark.slow
def test_a_node_of_two_primitives_keeps_its_name_and_each_run_writes_the_same_bytes(simplified):
    def change(tree):
        tree["meshes"][0]["primitives"] += tree["meshes"][1]["primitives"]
        tree["nodes"], tree["scenes"] = [{"name": "art", "mesh": 0}], [{"nodes": [0]}]

    first, second = (simplified(out, change)[0] for out in ("first.glb", "second.glb"))
    assert {node["name"] for node in opened(first.read_bytes())[0]["nodes"] if "mesh" in node} == {"art", "art_1"}
    assert first.read_bytes() == second.read_bytes()


COLOURS = np.random.default_rng(0).integers(256, size=(42, 4), dtype=np.uint8)
OTHERS = {  # a part beside one with colours: its colour, and what is dropped
    "no material": ({}, 255, []),
    "a plain material": ({"baseColorFactor": [102, 51, 0, 255], "roughnessFactor": 0.4}, [102, 51, 0],
                         ["roughnessFactor"]),
    "a picture": ({"baseColorTexture": Image.new("RGB", (2, 2), (9, 9, 9))}, None, []),
}  # fmt: skip


@pytest.mark.parametrize("name", OTHERS)
def test_colours_per_vertex_are_kept_where_no_part_has_a_picture(tmp_path, name):
    material, expected, dropped = OTHERS[name]
    coloured, other = trimesh.creation.icosphere(1), ball(0, **material) if material else trimesh.creation.box()
    other.apply_translation([3, 0, 0])
    coloured.visual.vertex_colors = COLOURS
    (tmp_path / "two.glb").write_bytes(with_linear_colours(trimesh.Scene([coloured, other]).export(file_type="glb")))
    mesh = load(tmp_path / "two.glb")
    content, has_colors = (tmp_path / "two.glb").read_bytes(), mesh.colors is not None
    assert set(not_read(content, has_colors)) - {"metallicFactor", "name", "doubleSided"} == set(dropped)
    assert (mesh.colors is None) == (expected is None) and (mesh.texture is None) == (expected is not None)
    if mesh.colors is not None:
        is_coloured = mesh.vertices[:, 0] < 1.5
        assert {*map(tuple, mesh.colors[is_coloured])} == {*map(tuple, COLOURS[:, :3])}
        assert (mesh.colors[~is_coloured] == expected).all()


def test_white_beside_materials_leaves_them_and_the_surface_whole(tmp_path):
    ball = trimesh.creation.icosphere(2)
    halves = [ball.submesh([np.arange(start, start + 160)], append=True) for start in (0, 160)]
    for half, colour in zip(halves, ([255, 0, 0, 255], [0, 0, 255, 255]), strict=True):
        half.visual = TextureVisuals(material=PBRMaterial(baseColorFactor=colour, roughnessFactor=0.4))
        half.visual.vertex_attributes["color"] = np.full((len(half.vertices), 4), 255, np.uint8)
    (tmp_path / "halves.glb").write_bytes(trimesh.Scene(halves).export(file_type="glb"))
    mesh = load(tmp_path / "halves.glb")
    assert mesh.watertight and mesh.colors is None
    for content in ((tmp_path / "halves.glb").read_bytes(), as_glb(tmp_path / "halves.glb")):
        assert "COLOR_0" not in not_read(content)
    assert {tuple(image[0, 0]) for image in mesh.texture.images} == {(255, 0, 0, 255), (0, 0, 255, 255)}


def test_colours_that_meet_at_an_edge_do_not_open_the_surface(tmp_path):
    box = trimesh.creation.box()
    corners = trimesh.Trimesh(box.vertices[box.faces].reshape(-1, 3), np.arange(36).reshape(12, 3), process=False)
    corners.visual = TextureVisuals(material=PBRMaterial(baseColorFactor=[255, 255, 255, 255], roughnessFactor=0.4))
    corners.visual.vertex_attributes["color"] = np.repeat(COLOURS[:12], 3, axis=0)
    (tmp_path / "box.glb").write_bytes(trimesh.Scene(corners).export(file_type="glb"))
    mesh = load(tmp_path / "box.glb")
    assert mesh.watertight and len(mesh.vertices) == 8 and mesh.colors is None
    assert "COLOR_0" in not_read((tmp_path / "box.glb").read_bytes(), mesh.colors is not None)


def test_a_part_without_a_colour_is_white_as_gltf_says(tmp_path):
    bare = trimesh.creation.icosphere(subdivisions=2).apply_translation([6, 0, 0])
    scene = trimesh.Scene({"red": ball(0, baseColorFactor=[255, 0, 0, 255]), "steel": ball(3, metallicFactor=0.5)})
    scene.add_geometry(bare, "bare", "bare")
    (tmp_path / "three.glb").write_bytes(scene.export(file_type="glb"))
    mesh = load(tmp_path / "three.glb")
    parts = np.rint(mesh.vertices[:, 0] / 3).astype(int)
    expected = np.array([[255, 0, 0], [255, 255, 255], [255, 255, 255]])
    assert (bake_texture(mesh).colors == expected[parts]).all()
    write_any(tmp_path / "again.glb", mesh)
    materials = materials_of(tmp_path / "again.glb")
    assert [material.get("doubleSided", False) for material in materials] == [False] * 3
    assert ["baseColorFactor" in material["pbrMetallicRoughness"] for material in materials].count(True) == 1


@pytest.mark.parametrize("flat", [True, False])
def test_colours_of_faces_stay_apart_and_others_that_meet_are_blended(flat):
    box = trimesh.creation.box()
    colors = np.repeat(COLOURS[:12, :3], 3, axis=0) if flat else np.tile(COLOURS[:3, :3], (12, 1))
    soup = Mesh(box.vertices[box.faces].reshape(-1, 3), np.arange(36).reshape(12, 3), colors)
    mesh, notes = repaired(soup)
    assert mesh.watertight and "28 coincident vertices merged" in notes[0]
    assert any("blended" in note for note in notes) != flat
    if flat:
        shown = mesh.texture.sample(np.arange(12), mesh.texture.uv[:, 0])
        assert np.array_equal(shown, COLOURS[:12, :3])
    else:
        at_first = (soup.vertices == soup.vertices[0]).all(axis=1)
        assert np.array_equal(mesh.colors[0], np.rint(colors[at_first].mean(axis=0)))


def test_an_obj_gets_the_colour_of_a_material_in_its_picture(tmp_path):
    mesh = as_mesh(ball(0, baseColorTexture=picture((200, 40, 40)), baseColorFactor=[128, 255, 255, 255]))
    write_any(tmp_path / "ball.obj", mesh)
    red = np.rint(255 * encoded(decoded(np.array(200 / 255)) * decoded(np.array(128 / 255))))
    assert np.abs(bake_texture(load(tmp_path / "ball.obj")).colors - [red, 40, 40]).max() <= 1


def test_a_picture_without_coordinates_does_not_hide_the_colours(tmp_path):
    part = ball(0, baseColorTexture=picture((9, 9, 9)))
    part.visual.vertex_attributes["color"] = np.full((len(part.vertices), 4), 100, np.uint8)
    (tmp_path / "bare.glb").write_bytes(with_linear_colours(trimesh.Scene(part).export(file_type="glb")))
    rewritten(tmp_path / "bare.glb", lambda tree: tree["meshes"][0]["primitives"][0]["attributes"].pop("TEXCOORD_0"))
    assert (load(tmp_path / "bare.glb").colors == 100).all()


def test_a_material_without_a_picture_multiplies_the_colours_beside_it(tmp_path):
    part = ball(0, name="paint", baseColorFactor=[255, 51, 0, 255])
    part.visual.vertex_attributes["color"] = np.full((len(part.vertices), 4), 100, np.uint8)
    (tmp_path / "paint.glb").write_bytes(trimesh.Scene(part).export(file_type="glb"))
    expected = np.rint(255 * encoded(np.array([100 / 255, 100 / 255 * 0.2, 0])))  # both are linear
    assert (load(tmp_path / "paint.glb").colors == expected).all()


def test_the_picture_of_colour_keeps_its_file_until_its_pixels_change(tmp_path):
    part = ball(0, baseColorTexture=picture((200, 40, 40), "JPEG"))
    (tmp_path / "art.glb").write_bytes(trimesh.Scene(part).export(file_type="glb"))
    content = pictures(tmp_path / "art.glb", materials_of(tmp_path / "art.glb")[0])["baseColorTexture"]
    assert content.startswith(b"\xff\xd8")
    mesh = load(tmp_path / "art.glb")
    write_any(tmp_path / "same.glb", mesh)
    painted = replace(mesh.texture, images=(255 - mesh.texture.images[0],))
    write_any(tmp_path / "painted.glb", replace(mesh, texture=painted))
    for name, kept in (("same.glb", True), ("painted.glb", False)):
        (material,) = materials_of(tmp_path / name)
        assert (pictures(tmp_path / name, material)["baseColorTexture"] == content) == kept
    again = load(tmp_path / "painted.glb").texture.images[0]
    assert (again[..., :3] == painted.images[0][..., :3]).all()


def test_a_material_file_does_not_darken_the_picture_and_names_the_maps_that_are_lost(tmp_path):
    write_any(tmp_path / "ball.obj", as_mesh(ball(0, baseColorTexture=picture((200, 40, 40)))))
    lines = (tmp_path / "ball.mtl").read_text().splitlines()
    assert [line.split()[1:] for line in lines if line.startswith("Kd ")] == [["1.00000000"] * 3]
    with (tmp_path / "ball.mtl").open("a") as file:
        file.write("\nmap_Bump -bm 1 bumps.png\nNs 20\n")
    assert dropped_from(tmp_path / "ball.obj", load(tmp_path / "ball.obj")).endswith(": map_Bump, Ks")


def test_no_picture_beside_that_of_colour_is_decoded_for_reading_and_writing(tmp_path, monkeypatch):
    (tmp_path / "art.glb").write_bytes(art().export(file_type="glb"))
    decoded = []

    def load_pixels(image, real=ImageFile.load):
        decoded.append(image.format)
        return real(image)

    monkeypatch.setattr(ImageFile, "load", load_pixels)
    mesh = load(tmp_path / "art.glb")
    write_any(tmp_path / "again.glb", mesh)
    assert set(decoded) == {"PNG"}
    again = {material["name"]: material for material in load(tmp_path / "again.glb").texture.materials}
    assert all(set(material) <= set(again[material["name"]]) for material in mesh.texture.materials)


def test_materials_of_a_scene_of_trimesh_go_to_trimesh():
    back = to_trimesh(as_mesh(art()))
    materials = {part.visual.material.name: part.visual.material for part in back.geometry.values()}
    assert materials["varnish"].roughnessFactor == 0.4 and materials["varnish"].alphaMode == "BLEND"
    assert np.asarray(materials["varnish"].normalTexture)[0, 0] == pytest.approx([128, 128, 255], abs=2)


def test_a_material_without_a_colour_keeps_the_rest_and_gives_no_colours(tmp_path):
    part = ball(0, name="bare", roughnessFactor=0.4, normalTexture=picture((128, 128, 255)))
    (tmp_path / "bare.glb").write_bytes(trimesh.Scene({"bare": part}).export(file_type="glb"))
    mesh = load(tmp_path / "bare.glb")
    assert bake_texture(mesh).colors is None
    write_any(tmp_path / "again.glb", mesh)
    (material,) = materials_of(tmp_path / "again.glb")
    factors = {"roughnessFactor", "metallicFactor"}
    assert "normalTexture" in material and set(material["pbrMetallicRoughness"]) == factors


def test_meshes_with_other_materials_differ():
    first, other = art(), art()
    other.geometry["metal"].visual.material.roughnessFactor = 0.3
    assert as_mesh(first) == as_mesh(art()) and as_mesh(first) != as_mesh(other)


LINEAR = [0.2, 0.02, 0.001, 0.3217]


def test_a_linear_factor_is_shown_as_viewers_show_it_and_goes_to_the_next_glb_unchanged(tmp_path):
    (tmp_path / "ball.glb").write_bytes(trimesh.Scene(ball(0, baseColorFactor=[9, 9, 9, 9])).export(file_type="glb"))
    rewritten(
        tmp_path / "ball.glb", lambda tree: tree["materials"][0]["pbrMetallicRoughness"].update(baseColorFactor=LINEAR)
    )
    mesh = load(tmp_path / "ball.glb")
    assert mesh.texture.images[0][0, 0].tolist() == [124, 39, 3, 82]
    write_any(tmp_path / "again.glb", mesh)
    (material,) = materials_of(tmp_path / "again.glb")
    np.testing.assert_allclose(material["pbrMetallicRoughness"]["baseColorFactor"], LINEAR, rtol=1e-6)


def test_colours_of_vertices_are_linear_in_a_glb_and_come_back(tmp_path):
    shape = trimesh.creation.icosphere(subdivisions=1)
    colors = np.random.default_rng(0).integers(256, size=(42, 3), dtype=np.uint8)
    write_any(tmp_path / "ball.glb", Mesh(shape.vertices, shape.faces, colors))
    (stored,) = trimesh.load(tmp_path / "ball.glb", process=False).geometry.values()
    seen = {tuple(row) for row in stored.visual.vertex_colors[:, :3]}
    assert seen == {tuple(row) for row in np.rint(255 * decoded(colors / 255)).astype(int)}
    assert {tuple(row) for row in load(tmp_path / "ball.glb").colors} == {tuple(row) for row in colors}


@pytest.mark.parametrize(("factor", "expected"), [(1.0, 188), (0.5, 137)])
def test_a_picture_times_a_factor_is_multiplied_without_the_encoding(factor, expected):
    pixels, uv = np.full((8, 8, 4), 188, np.uint8), np.zeros((1, 3, 2))
    material = {"baseColorTexture": True, "baseColorFactor": np.array([factor, factor, factor, 1])}
    texture = Texture(uv, [0], (pixels,), (material,))
    assert (texture.sample(np.zeros(1, int), uv[:, 0]) == expected).all()
    assert (_in_pictures(texture).images[0] == [expected] * 3 + [188]).all()


def test_colours_that_become_a_picture_keep_their_side_and_their_shade(tmp_path):
    coloured = trimesh.creation.icosphere(1)
    coloured.visual.vertex_colors = np.tile(np.uint8([200, 40, 9, 255]), (42, 1))
    scene = trimesh.Scene([coloured, ball(3, baseColorTexture=picture((9, 9, 9)))])
    (tmp_path / "two.glb").write_bytes(with_linear_colours(scene.export(file_type="glb")))
    texture = load(tmp_path / "two.glb").texture
    (number,) = (number for number, image in enumerate(texture.images) if image[0, 0, 0] == 200)
    assert (texture.images[number][..., :3] == [200, 40, 9]).all()
    assert texture.materials[number] == {"doubleSided": False, "baseColorTexture": True}


def shades(places):
    """Colours that change evenly over a ball of radius 1."""
    return 127.5 * (1 + places / np.linalg.norm(places, axis=1, keepdims=True))


def painted_beside_a_picture():
    """A Mesh of a ball whose vertices, in any order, have their `shades`, beside a ball with a picture."""
    shape = trimesh.creation.icosphere(4)
    order = np.random.default_rng(0).permutation(len(shape.vertices))
    painted = trimesh.Trimesh(shape.vertices[order], np.argsort(order)[shape.faces], process=False)
    painted.visual.vertex_colors = np.rint(shades(painted.vertices)).astype(np.uint8)
    return as_mesh(trimesh.Scene([painted, ball(3, baseColorTexture=picture((9, 9, 9)))]))


def shown_amiss(mesh):
    """The mean error, of 255, of the colours that a viewer interpolates at the centres of the painted ball's faces."""
    faces = np.flatnonzero((mesh.vertices[mesh.faces][..., 0] < 1.5).all(axis=1))
    (number,) = np.unique(mesh.texture.image[faces])
    image = mesh.texture.images[number]
    column, row = ([0, 1] + [1, -1] * mesh.texture.uv[faces].mean(axis=1)).T * [
        [image.shape[1]],
        [image.shape[0]],
    ] - 0.5
    seen = np.stack([map_coordinates(image[..., k].astype(float), [row, column], order=1) for k in range(3)], axis=1)
    return np.abs(seen - shades(mesh.vertices[mesh.faces[faces]].mean(axis=1))).mean()


def test_colours_of_vertices_beside_a_picture_look_as_they_did_also_once_simplified(tmp_path):
    mesh = painted_beside_a_picture()
    assert shown_amiss(mesh) < 1
    for attributes in ({}, {"uv": 1.0}):
        small = simplify(mesh, "20%", attributes=attributes)
        assert shown_amiss(small) < 2 and colour_error(mesh, small) < 2
    assert len(np.unique(small.texture.image)) == 2
    for suffix in ("glb", "obj"):
        write_any(tmp_path / f"two.{suffix}", small)
        assert shown_amiss(load(tmp_path / f"two.{suffix}")) < 2
    parts = trimesh.load(tmp_path / "two.glb").geometry.values()
    assert sorted(part.visual.kind for part in parts) == ["texture", "vertex"]


def test_a_hard_edge_between_colours_of_vertices_stays_hard():
    shape = trimesh.creation.icosphere(3)
    north = shape.triangles_center[:, 2] > 0
    painted = trimesh.Trimesh(np.tile(shape.vertices, (2, 1)), shape.faces + 642 * north[:, None], process=False)
    painted.visual.vertex_colors = np.repeat([[200, 0, 0], [0, 0, 200]], 642, axis=0).astype(np.uint8)
    small = simplify(as_mesh(trimesh.Scene([painted, ball(3, baseColorTexture=picture((9, 9, 9)))])), "20%")
    colors = corner_colours(small.texture, np.arange(len(small.faces)))
    assert {(200, 0, 0), (0, 0, 200)} < set(map(tuple, colors[:, 0].tolist()))
    assert (colors == colors[:, :1]).all()


def test_a_weight_of_texture_coordinates_spends_no_faces_on_colours_of_vertices():
    mesh = painted_beside_a_picture()
    counts = [
        int((small.vertices[small.faces][..., 0] < 1.5).all(axis=1).sum())
        for small in (simplify(mesh, "20%"), simplify(mesh, "20%", attributes={"uv": 1.0}))
    ]
    assert counts[1] <= counts[0]

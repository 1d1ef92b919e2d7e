"""A .gltf file, whose buffers and pictures lie beside it, is read as the GLB of the same scene."""

import base64
import io
import json
from urllib.parse import quote

import numpy as np
import pytest
import trimesh
from PIL import Image
from trimesh.visual import TextureVisuals
from trimesh.visual.material import PBRMaterial

from haptic_glance.cli.simplify import run
from haptic_glance.lod.topology import parts_of
from haptic_glance.mesh import MeshError, load
from haptic_glance.mesh.files import parse
from haptic_glance.mesh.gltf import as_glb, joined, opened, parser_bytes
from haptic_glance.mesh.materials import not_read
from haptic_glance.mesh.srgb import encoded
from stages.meshes.furniture import files_beside


@pytest.fixture(scope="module")
def glb():
    """The bytes of a GLB: two balls, one with a picture and one red, the second moved."""
    packed = io.BytesIO()
    Image.fromarray(np.arange(192, dtype=np.uint8).reshape(8, 8, 3)).save(packed, "PNG")
    ball, other = trimesh.creation.icosphere(2), trimesh.creation.icosphere(1)
    material = PBRMaterial(name="painted", baseColorTexture=Image.open(packed))
    ball.visual = TextureVisuals(ball.vertices[:, :2] / 4 + 0.5, material=material)
    other.visual = TextureVisuals(material=PBRMaterial(name="red", baseColorFactor=[255, 0, 0, 255]))
    scene = trimesh.Scene({"ball": ball})
    scene.add_geometry(other, "other", transform=trimesh.transformations.translation_matrix([3, 0, 0]))
    return scene.export(file_type="glb")


@pytest.fixture
def write(glb, tmp_path):
    """write(place) -> the path of the same scene as a .gltf; place(name, bytes) gives the URI of a part."""

    def written(place):
        tree, binary = opened(glb)
        image = tree["images"][0]
        view = tree["bufferViews"][image.pop("bufferView")]
        start = view.get("byteOffset", 0)
        image["uri"] = place("skin of it.png", binary[start : start + view["byteLength"]])
        # two buffers, so that offsets move: the last view lies in one of its own
        last = tree["bufferViews"][-1]
        end = last.get("byteOffset", 0)
        tree["bufferViews"][-1] = last | {"buffer": 1, "byteOffset": 0}
        sides = {"one part.bin": binary[: end + 1], "two.bin": binary[end : end + last["byteLength"]]}  # of odd length
        tree["buffers"] = [{"uri": place(*side), "byteLength": len(side[1])} for side in sides.items()]
        path = tmp_path / "scene.gltf"
        path.write_text(json.dumps(tree))
        return path

    return written


@pytest.fixture
def beside(tmp_path):
    """Writes a part beside the .gltf; its name has blanks, which a URI has not."""

    def place(name, content):
        (tmp_path / name).write_bytes(content)
        return name.replace(" ", "%20")

    return place


def embedded(_name, content):
    return "data:application/octet-stream;base64," + base64.b64encode(content).decode()


def quoted(_name, content):
    return "DATA:application/octet-stream," + quote(content)


PLACES = {"embedded": embedded, "quoted": quoted}


@pytest.mark.parametrize("where", ["beside", *PLACES])
def test_it_is_read_as_the_glb_of_the_same_scene(glb, write, beside, where):
    path = write(PLACES.get(where, beside))
    mesh, wanted = load(path), parse(glb, ".glb")
    assert np.array_equal(mesh.vertices, wanted.vertices) and np.array_equal(mesh.faces, wanted.faces)
    assert mesh.up == wanted.up == "y"
    for image, other in zip(mesh.texture.images, wanted.texture.images, strict=True):
        assert np.array_equal(np.asarray(image), np.asarray(other))
    made = as_glb(path)
    starts = [view["byteOffset"] % 4 for view in opened(made)[0]["bufferViews"]]
    assert not_read(made) == [] and len(made) % 4 == 0 and starts[-2:] == [0, 0]  # glTF 2.0, section 3.6.2.4


def test_its_nodes_and_pictures_go_through_simplify(write, beside, tmp_path, capsys):
    path = write(beside)
    names = set(parts_of(path))
    assert len(names) == 2
    run([str(path), "--levels", "50%", "--out", str(tmp_path / "levels")])
    [made] = (tmp_path / "levels").glob("*.glb")
    assert set(parts_of(made)) == names and load(made).texture is not None
    assert "dropped" not in capsys.readouterr().err


def test_what_is_not_beside_it_is_named(write, beside, tmp_path, capsys):
    path = write(beside)
    assert set(files_beside(path)) == {"skin of it.png", "one part.bin", "two.bin"}
    (tmp_path / "skin of it.png").unlink()
    assert len(load(path).faces) == 400
    assert not_read(as_glb(path)) == ["picture skin of it.png, not beside it"]
    (tmp_path / "two.bin").unlink()
    with pytest.raises(MeshError, match="scene.gltf: refers to two.bin, which is not beside it: keep both together"):
        load(path)
    with pytest.raises(MeshError, match="refers to one part.bin, which is not beside it"):
        parse(path.read_bytes(), ".gltf")


@pytest.mark.slow
@pytest.mark.parametrize(("first", "picture"), [(0, "number 0"), (60, "of the material painted")])
def test_a_damaged_picture_is_left_out_by_name(first, picture, glb, tmp_path):
    start = glb.index(b"\x89PNG") + first
    (tmp_path / "scene.glb").write_bytes(glb[:start] + bytes(20) + glb[start + 20 :])
    with pytest.warns(UserWarning, match=f"^scene.glb: unreadable, so left out: the picture {picture}$"):
        mesh = load(tmp_path / "scene.glb")
    assert len(mesh.faces) == 400
    run([str(tmp_path / "scene.glb"), "--faces", "300", "--out", str(tmp_path / "less.glb")])
    assert len(load(tmp_path / "less.glb").faces) == 300


def test_a_damaged_picture_beside_a_gltf_is_left_out_by_name(write, beside, tmp_path):
    path = write(beside)
    (tmp_path / "skin of it.png").write_bytes(b"no picture")
    with pytest.warns(UserWarning, match=r"^scene.gltf: unreadable, so left out: the picture skin of it.png$"):
        load(path)


@pytest.mark.slow
def test_sixteen_bits_of_grey_keep_their_shades_and_their_file(tmp_path):
    grey = np.linspace(0, 65535, 256).astype(np.uint16).reshape(16, 16)
    ball, packed = trimesh.creation.icosphere(2), io.BytesIO()
    Image.fromarray(grey).save(packed, "PNG")
    material = PBRMaterial(baseColorTexture=Image.open(packed))
    ball.visual = TextureVisuals(ball.vertices[:, :2] / 4 + 0.5, material=material)
    ball.export(tmp_path / "ball.glb")
    assert load(tmp_path / "ball.glb").texture.images[0][..., 0].tolist() == (grey // 257).tolist()
    run([str(tmp_path / "ball.glb"), "--faces", "200", "--out", str(tmp_path / "less.glb")])
    assert packed.getvalue() in (tmp_path / "less.glb").read_bytes()


def test_a_file_outside_of_its_folder_is_not_read(tmp_path, write, beside):
    folder = tmp_path / "inner"
    folder.mkdir()
    path = folder / "scene.gltf"
    path.write_text(write(beside).read_text().replace("one%20part.bin", "../one%20part.bin"))
    with pytest.raises(MeshError, match="refers to ../one part.bin, which is not beside it"):
        load(path)


SQUARE = np.array([[-1, -1, 0], [1, -1, 0], [1, 1, 0], [-1, 1, 0]])
UV = np.array([[0.2, 0.4], [1, 0], [0.6, 1], [0, 0.8]])
COLOURS = np.arange(12).reshape(4, 3) * 20 + [15]
COMPONENTS = {"i1": 5120, "u1": 5121, "i2": 5122, "u2": 5123, "f4": 5126}


def square(material, **attributes):
    """The bytes of a .gltf: two faces; attributes: arrays of four vertices, normalised where they are integers."""
    tree = {"asset": {"version": "2.0"}, "scenes": [{"nodes": [0]}], "nodes": [{"mesh": 0}], "materials": [material]}
    tree |= {"accessors": [], "bufferViews": [], "buffers": []}
    for array in (np.array([0, 1, 2, 0, 2, 3], "u2"), *attributes.values()):
        flat = array.ndim == 1
        kind = {"componentType": COMPONENTS[array.dtype.str[1:]], "type": "SCALAR" if flat else f"VEC{array.shape[1]}"}
        kind |= {"normalized": True} if not flat and array.dtype.kind in "iu" else {}
        tree["accessors"].append(kind | {"bufferView": len(tree["buffers"]), "count": len(array)})
        tree["bufferViews"].append({"buffer": len(tree["buffers"]), "byteLength": array.nbytes})
        tree["buffers"].append({"byteLength": array.nbytes, "uri": embedded("", array.tobytes())})
    primitive = {"indices": 0, "attributes": {name: 1 + place for place, name in enumerate(attributes)}}
    tree["meshes"] = [{"primitives": [primitive | ({"material": 0} if material else {})]}]
    return tree


def of_kind(values, kind):
    """Numbers of 0..1 as a glTF stores them in a kind of component."""
    return values.astype(kind) if kind == "f4" else np.rint(values * np.iinfo(kind).max).astype(kind)


@pytest.mark.parametrize("kind", COMPONENTS)
def test_normalised_integers_are_the_numbers_that_they_stand_for(kind):
    material = {"name": "m", "pbrMetallicRoughness": {"baseColorFactor": [1, 0, 0, 1]}}
    places = of_kind(SQUARE, kind) if kind[0] in "if" else SQUARE.astype("f4")
    tree = square(material, POSITION=places, TEXCOORD_0=of_kind(UV, kind)) | {
        "extensionsUsed": ["KHR_mesh_quantization"],
        "extensionsRequired": ["KHR_mesh_quantization"],
    }
    mesh = parse(json.dumps(tree).encode(), ".gltf")
    assert np.array_equal(mesh.vertices, SQUARE)
    np.testing.assert_allclose(
        mesh.texture.uv[0], [[u, 1 - v] for u, v in UV[:3]], atol=1 / 127 if "1" in kind else 1e-4
    )
    stored = of_kind(COLOURS / 255, kind)
    tree = square({}, POSITION=SQUARE.astype("f4"), COLOR_0=stored)
    linear = stored / (1 if kind == "f4" else np.iinfo(kind).max)
    assert (parse(json.dumps(tree).encode(), ".gltf").colors == np.rint(255 * encoded(linear))).all()


@pytest.mark.parametrize("name", ["KHR_materials_unlit", "KHR_texture_transform"])
def test_an_extension_that_changes_no_shape_is_left_out(name):
    tree = square({}, POSITION=SQUARE.astype("f4")) | {"extensionsUsed": [name], "extensionsRequired": [name]}
    assert len(parse(json.dumps(tree).encode(), ".gltf").faces) == 2


CUT = '{"buffers": [{"uri": "data:,abc", "byteLength": 9}]}'
PACKED = '{"extensionsRequired": ["EXT_meshopt_compression"], "buffers": [{"byteLength": 9}]}'

DRACO = '{"extensionsRequired": ["KHR_draco_mesh_compression"], "buffers": [{"uri": "data:,abc", "byteLength": 3}]}'


@pytest.mark.parametrize(
    ("text", "reason"),
    [
        (CUT, "data:,abc is truncated: 3 of 9 bytes"),
        (PACKED, "needs EXT_meshopt_compression"),
        (DRACO, "needs KHR_draco_mesh_compression, which is not read: export it without compression"),
    ],
)
def test_a_buffer_that_is_cut_or_packed_is_refused(text, reason):
    with pytest.raises(MeshError, match=reason):
        parse(text.encode(), ".gltf")


@pytest.mark.parametrize(("uri", "name"), [("p%20q.png", "p q.png"), ("%C3%A9.png", "é.png"), ("p.png", "p.png")])
def test_a_glb_shows_the_picture_beside_it_also_by_an_encoded_name(uri, name, glb, tmp_path):
    Image.new("RGB", (4, 4), (200, 40, 40)).save(tmp_path / name)
    (tmp_path / "out.glb").write_bytes(changed(glb, lambda tree, _: tree.update(images=[{"uri": uri}])))
    assert any((image == [200, 40, 40, 255]).all() for image in load(tmp_path / "out.glb").texture.images)
    (tmp_path / name).unlink()
    assert not_read(as_glb(tmp_path / "out.glb")) == [f"picture {name}, not beside it"]


def changed(content, change):
    """The bytes of a GLB whose tree a function has changed, which may return bytes for the end of the buffer."""
    tree, binary = opened(content)
    binary += change(tree, len(binary)) or b""
    tree["buffers"][0]["byteLength"] = len(binary)
    return joined(tree, binary)


def test_a_fan_is_read_as_its_triangles():
    corners = np.array([[0, 0, 0], [2, 0, 0], [2, 1, 0], [1, 2, 0], [0, 2, 0]], np.float32)
    plain = trimesh.Trimesh(corners, [[0, 1, 2], [0, 2, 3], [0, 3, 4]], process=False)

    def fan(tree, _):
        (primitive,) = tree["meshes"][0]["primitives"]
        del primitive["indices"]
        primitive["mode"] = 6

    content = changed(trimesh.Scene(plain).export(file_type="glb"), fan)
    mesh = parse(content, ".glb")
    assert len(mesh.faces) == 3 and mesh.face_areas.sum() == pytest.approx(plain.area) and not_read(content) == []


def test_a_mesh_with_a_skin_stands_where_its_joints_put_it():
    """As programs write it that convert centimetres: the armature has a hundredth, the inverse matrices a hundred."""
    inverse = np.diag([100, 100, 100, 1]).astype("<f4")

    def rig(tree, begin):
        node = next(number for number, node in enumerate(tree["nodes"]) if "mesh" in node)
        tree["nodes"][node] |= {"skin": 0, "translation": [5, 0, 0]}
        tree["nodes"] += [{"scale": [0.01] * 3, "children": [node, len(tree["nodes"]) + 1]}, {"name": "joint"}]
        tree["scenes"] = [{"nodes": [len(tree["nodes"]) - 2]}]
        tree["bufferViews"].append({"buffer": 0, "byteOffset": begin, "byteLength": 64})
        tree["accessors"].append({"bufferView": len(tree["bufferViews"]) - 1, "componentType": 5126, "type": "MAT4",
                                  "count": 1})  # fmt: skip
        tree["skins"] = [{"joints": [len(tree["nodes"]) - 1], "inverseBindMatrices": len(tree["accessors"]) - 1}]
        return inverse.T.tobytes()

    box = trimesh.creation.box([1, 2, 4])
    mesh = parse(changed(trimesh.Scene(box).export(file_type="glb"), rig), ".glb")
    assert np.ptp(mesh.vertices, axis=0) == pytest.approx([1, 2, 4]) and np.abs(mesh.vertices.mean(axis=0)).max() < 1e-6


@pytest.mark.parametrize(("scene", "faces", "extents"), [(0, 12, [1, 1, 1]), (1, 24, [7, 3, 3])])
def test_a_mesh_with_a_skin_leaves_its_children_and_its_scene_as_they_are(scene, faces, extents):
    def rig(tree, _):
        tree["nodes"] = [
            {"translation": [5, 0, 0], "children": [1]}, {"mesh": 0, "skin": 0, "scale": [3] * 3, "children": [2]},
            {"mesh": 0}, {}, {"mesh": 0},
        ]  # fmt: skip
        tree |= {"skins": [{"joints": [3]}], "scenes": [{"nodes": [4]}, {"nodes": [0, 3]}], "scene": scene}

    mesh = parse(changed(trimesh.creation.box().export(file_type="glb"), rig), ".glb")
    assert len(mesh.faces) == faces and np.ptp(mesh.vertices, axis=0) == pytest.approx(extents)


def test_joints_in_a_ring_end(glb):
    def ring(tree, _):
        node = next(number for number, node in enumerate(tree["nodes"]) if "mesh" in node)
        tree["nodes"][node] |= {"skin": 0}
        tree["nodes"] += [{"children": [len(tree["nodes"])], "scale": [0.5] * 3}]
        tree["skins"] = [{"joints": [len(tree["nodes"]) - 1]}]

    assert parser_bytes(changed(glb, ring))[:4] == b"glTF"


def test_a_file_without_a_scene_shows_all_nodes(glb):
    content = changed(glb, lambda tree, _: tree.pop("scenes") and tree.pop("scene") and None)
    assert len(parse(content, ".glb").faces) == len(parse(glb, ".glb").faces)


@pytest.mark.parametrize("second_set", [False, True])
def test_a_picture_stands_where_its_transform_puts_it(glb, second_set):
    """KHR_texture_transform, as compressors of GLB files write it, on the first set of coordinates and on another."""
    plain = parse(glb, ".glb").texture

    def move(tree, _):
        use = tree["materials"][0]["pbrMetallicRoughness"]["baseColorTexture"]
        (attributes,) = (
            primitive["attributes"]
            for mesh in tree["meshes"]
            for primitive in mesh["primitives"]
            if primitive["material"] == 0 and "TEXCOORD_0" in primitive["attributes"]
        )
        use["extensions"] = {"KHR_texture_transform": {"scale": [0.5, 0.25], "offset": [0.25, 0.125]}}
        tree["extensionsRequired"] = ["KHR_texture_transform"]
        if second_set:
            use["texCoord"] = 1
            attributes["TEXCOORD_1"] = attributes.pop("TEXCOORD_0")

    content = changed(glb, move)
    moved = parse(content, ".glb").texture
    of_ball = np.array([image.shape == (8, 8, 4) for image in plain.images])[plain.image]
    expected = plain.uv[of_ball].copy()
    expected[..., 0] = 0.5 * expected[..., 0] + 0.25
    expected[..., 1] = 1 - (0.25 * (1 - expected[..., 1]) + 0.125)  # v runs downwards in a glTF
    assert np.allclose(moved.uv[of_ball], expected, atol=1e-6) and not_read(parser_bytes(content)) == []


LOST = [  # a change of the tree, and the names of all that is not read since
    (lambda tree: None, []),
    (lambda tree: tree["meshes"][0]["primitives"].extend({"mode": mode, "attributes": {}} for mode in (0, 3)),
     ["points", "lines"]),
    (lambda tree: tree["meshes"][0]["primitives"][0].update(targets=[{"POSITION": 0}]), ["morph targets"]),
    (lambda tree: tree["materials"][0]["pbrMetallicRoughness"]["baseColorTexture"].update(
        extensions={"KHR_texture_transform": {"rotation": 0.5}}), ["baseColorTexture.KHR_texture_transform"]),
    (lambda tree: tree["scenes"].append({"nodes": [0]}), ["further scenes"]),
    (lambda tree: tree["nodes"][0].update(extras={"price": 3}), ["extras"]),
    (lambda tree: tree["asset"].update(copyright="CC BY"), ["asset.copyright"]),
    *((lambda tree, name=name: tree.update(extensionsUsed=[name]), [name]) for name in (
        "EXT_mesh_gpu_instancing", "KHR_lights_punctual", "KHR_materials_variants", "KHR_node_visibility")),
]  # fmt: skip


@pytest.mark.parametrize(("change", "names"), LOST)
def test_all_that_a_mesh_cannot_hold_is_named(glb, change, names):
    assert not_read(parser_bytes(changed(glb, lambda tree, _: change(tree)))) == names


def add_instances(tree):
    attributes = {"TRANSLATION": len(tree["accessors"])}
    tree["nodes"][1]["extensions"] = {"EXT_mesh_gpu_instancing": {"attributes": attributes}}
    tree["accessors"].append(next(entry for entry in tree["accessors"] if entry["type"] == "VEC3") | {"count": 5})


def add_skin(tree, *places):
    """Both balls share a skin; its joints stand at these places."""
    joints = [len(tree["nodes"]) + number for number in range(len(places))]
    tree["nodes"] += [{"translation": [place, 0, 0]} for place in places]
    tree["skins"] = [{"joints": joints}]
    for node in tree["nodes"]:
        node |= {"skin": 0} if "mesh" in node else {}


@pytest.mark.parametrize(
    ("change", "text"),
    [
        (lambda tree: None, ""),
        (lambda tree: tree["meshes"][0]["primitives"].extend(
            {"mode": mode, "attributes": tree["meshes"][0]["primitives"][0]["attributes"]} for mode in (0, 1, 3, 5)),
         "lines (2), points (1)"),
        (lambda tree: tree.update(scenes=[{"nodes": [0]}, {"nodes": [0, 1]}]), "meshes of further scenes (1)"),
        (lambda tree: tree.update(scenes=[{"nodes": [0]}, {"nodes": [0, 1]}], scene=1), ""),
        (add_instances, "instances (5)"),
        (lambda tree: add_skin(tree, 0.0, 1.0), "poses of skins (1)"),
        (lambda tree: add_skin(tree, 1.0, 1.0), ""),  # the first joint speaks for all
    ],
)  # fmt: skip
def test_a_warning_counts_the_parts_of_a_scene_that_change_its_shape(glb, change, text, recwarn):
    parse(changed(glb, lambda tree, _: change(tree)), ".glb", name="scene.glb")
    assert [str(warning.message) for warning in recwarn] == [f"scene.glb: left out: {text}"] * bool(text)


@pytest.mark.parametrize("wrong", [3, [3], [{"normalTexture": {"index": 99}}], [{"extensions": 7}]])
def test_malformed_materials_name_nothing(glb, wrong):
    assert not_read(changed(glb, lambda tree, _: tree.update(materials=wrong))) == []


def test_a_node_shows_the_shape_of_its_morph_weights_in_sparse_accessors():
    """As Blender writes shape keys: a target lists only the vertices that move."""

    def add_targets(tree, begin):
        (primitive,) = tree["meshes"][0]["primitives"]
        tree["bufferViews"] += [{"buffer": 0, "byteOffset": begin, "byteLength": 4},
                                {"buffer": 0, "byteOffset": begin + 4, "byteLength": 24}]  # fmt: skip
        ids, values = len(tree["bufferViews"]) - 2, len(tree["bufferViews"]) - 1
        sparse = {"count": 2, "indices": {"bufferView": ids, "componentType": 5123}, "values": {"bufferView": values}}
        tree["accessors"].append({"type": "VEC3", "componentType": 5126, "count": 3, "sparse": sparse})
        primitive["targets"] = [{"POSITION": len(tree["accessors"]) - 1}]
        tree["meshes"][0]["weights"] = [0.5]
        node = next(node for node in tree["nodes"] if "mesh" in node)
        tree["nodes"].append({"mesh": 0, "weights": [2.0], "translation": [10, 0, 0]})
        tree["nodes"].append({"mesh": 0, "weights": [0.0], "translation": [20, 0, 0]})
        tree["scenes"] = [{"nodes": [tree["nodes"].index(node), len(tree["nodes"]) - 2, len(tree["nodes"]) - 1]}]
        return np.array([1, 2], "<u2").tobytes() + np.array([[0, 0, 1], [0, 0, 2]], "<f4").tobytes()

    corners = np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0]], np.float32)
    content = trimesh.Scene(trimesh.Trimesh(corners, [[0, 1, 2]], process=False)).export(file_type="glb")
    mesh = parse(changed(content, add_targets), ".glb")
    expected = [corners + [place, 0, 0] + weight * np.array([[0, 0, 0], [0, 0, 1], [0, 0, 2]])
                for place, weight in ((0, 0.5), (10, 2), (20, 0))]  # fmt: skip
    assert sorted(mesh.vertices.tolist()) == sorted(np.concatenate(expected).tolist())

    def damage(tree, begin):
        end = add_targets(tree, begin)
        tree["accessors"][-1]["sparse"]["indices"]["componentType"] = 99
        return end

    with pytest.raises(MeshError, match="KeyError in its morph targets or sparse accessors"):
        parse(changed(content, damage), ".glb")


def test_a_sparse_accessor_of_an_attribute_is_full():
    def make_sparse(tree, begin):
        place = tree["meshes"][0]["primitives"][0]["attributes"]["POSITION"]
        tree["bufferViews"] += [{"buffer": 0, "byteOffset": begin, "byteLength": 4},
                                {"buffer": 0, "byteOffset": begin + 4, "byteLength": 12}]  # fmt: skip
        count = len(tree["bufferViews"])
        ids = {"bufferView": count - 2, "componentType": 5121}
        tree["accessors"][place]["sparse"] = {"count": 1, "indices": ids, "values": {"bufferView": count - 1}}
        return bytes([1, 0, 0, 0]) + np.array([[5, 0, 0]], "<f4").tobytes()

    corners = np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0]], np.float32)
    content = trimesh.Scene(trimesh.Trimesh(corners, [[0, 1, 2]], process=False)).export(file_type="glb")
    mesh = parse(changed(content, make_sparse), ".glb")
    assert mesh.vertices.tolist() == [[0, 0, 0], [5, 0, 0], [0, 1, 0]]


@pytest.mark.parametrize(
    "content", [b"{", b"[]", b"\xff\xfe", b'{"buffers": [{}]}', b'{"bufferViews": [{"buffer": 2}]}']
)
def test_what_is_no_gltf_is_refused(content):
    with pytest.raises(MeshError, match="unreadable as GLTF .* in its JSON"):
        parse(content, ".gltf")

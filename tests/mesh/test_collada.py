"""COLLADA files, written here as text."""

import numpy as np
import pytest
from PIL import Image

from haptic_glance.mesh import MeshError, load
from haptic_glance.mesh.files import files_of

DAE = """<COLLADA xmlns="http://www.collada.org/2005/11/COLLADASchema" version="1.4.1">
<asset><up_axis>Z_UP</up_axis></asset>
{looks}
<library_geometries><geometry id="box"><mesh>
<source id="p"><float_array id="pa" count="24">0 0 0 1 0 0 1 1 0 0 1 0 0 0 2 1 0 2 1 1 2 0 1 2</float_array>
<technique_common><accessor source="#pa" count="8" stride="3"><param name="X" type="float"/>
<param name="Y" type="float"/><param name="Z" type="float"/></accessor></technique_common></source>
<source id="t"><float_array id="ta" count="4">0.25 0.5 0.75 0.5</float_array>
<technique_common><accessor source="#ta" count="2" stride="2"><param name="S" type="float"/>
<param name="T" type="float"/></accessor></technique_common></source>
<vertices id="v"><input semantic="POSITION" source="#p"/></vertices>
<polylist material="m" count="6"><input semantic="VERTEX" source="#v" offset="0"/>
<input semantic="TEXCOORD" source="#t" offset="1"/><vcount>4 4 4 4 4 4</vcount>
<p>0 0 3 0 2 0 1 0 4 1 5 1 6 1 7 1 0 0 1 0 5 0 4 0 1 0 2 0 6 0 5 0 2 0 3 0 7 0 6 0 3 0 0 0 4 0 7 0</p>
</polylist></mesh></geometry></library_geometries>
<library_visual_scenes><visual_scene id="s">
<node id="left"><translate>10 0 0</translate><instance_geometry url="#box"><bind_material><technique_common>
<instance_material symbol="m" target="#paint"/></technique_common></bind_material></instance_geometry></node>
<node id="right"><translate>20 0 0</translate><scale>3 1 1</scale><instance_geometry url="#box"/></node>
</visual_scene></library_visual_scenes>
<scene><instance_visual_scene url="#s"/></scene></COLLADA>"""
PAINT = """<library_effects><effect id="e"><profile_COMMON>{images}<technique sid="common"><lambert><diffuse>{diffuse}
</diffuse></lambert></technique></profile_COMMON></effect></library_effects>
<library_materials><material id="paint"><instance_effect url="#e"/></material></library_materials>"""
ORANGE = PAINT.format(images="", diffuse="<color>1 0.5 0 1</color>")
IMAGES = """<newparam sid="f"><surface type="2D"><init_from>picture</init_from></surface></newparam>
<newparam sid="l"><sampler2D><source>f</source></sampler2D></newparam>"""
PICTURE = PAINT.format(images=IMAGES, diffuse='<texture texture="l" texcoord="UV"/>')
PICTURE = '<library_images><image id="picture"><init_from>two.png</init_from></image></library_images>' + PICTURE


def written(folder, looks=ORANGE, **changes):
    text = DAE.format(looks=looks)
    for old, new in changes.values():
        assert old in text
        text = text.replace(old, new)
    (folder / "robot.dae").write_text(text)
    return folder / "robot.dae"


def test_all_parts_of_a_scene_are_at_their_places_and_wound_outwards(tmp_path):
    mesh = load(written(tmp_path))
    assert (len(mesh.vertices), len(mesh.faces), mesh.up) == (16, 24, "z")
    corners = mesh.vertices[mesh.faces]
    assert np.einsum("ij,ij->", corners[:, 0], np.cross(corners[:, 1], corners[:, 2])) / 6 == pytest.approx(2 + 6)
    assert np.allclose([mesh.vertices.min(axis=0), mesh.vertices.max(axis=0)], [[10, 0, 0], [23, 1, 2]])


ARROW = "-2 -2 0 0 -1 0 2 -2 0 0 2 0 -2 -2 1 0 -1 1 2 -2 1 0 2 1"  # whose second corner turns inwards


SIX = "0 0 3 0 2 0 1 0 4 1 5 1 6 1 7 1 0 0 1 0 5 0 4 0 1 0 2 0 6 0 5 0 2 0 3 0 7 0 6 0 3 0 0 0 4 0 7 0"
POLYGONS = "".join(f"<p>{SIX[k : k + 15]}</p>" for k in range(0, len(SIX), 16))  # of single digits
AS_POLYGONS = {
    "start": ("<polylist", "<polygons"),
    "indices": (f"<vcount>4 4 4 4 4 4</vcount>\n<p>{SIX}</p>", POLYGONS),
    "end": ("</polylist", "</polygons"),
}


@pytest.mark.parametrize("element", [{}, AS_POLYGONS])
def test_a_concave_polygon_keeps_its_shape(tmp_path, element):
    mesh = load(written(tmp_path, **element, points=("0 0 0 1 0 0 1 1 0 0 1 0 0 0 2 1 0 2 1 1 2 0 1 2", ARROW)))
    corners = mesh.vertices[mesh.faces][:12]
    sides = 2 * (5**0.5 + 20**0.5)
    cross = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    assert np.linalg.norm(cross, axis=1).sum() / 2 == pytest.approx(2 * 6 + sides)


def test_a_colour_is_srgb_and_a_part_without_a_material_stays_beside_it(tmp_path):
    texture = load(written(tmp_path)).texture
    pixels = [tuple(image[0, 0, :3].tolist()) for image in texture.images]
    assert pixels[0] == (255, 128, 0)  # a linear half would be 188
    assert sorted(np.bincount(texture.image)) == [12, 12]


COLOURS = """<source id="c"><float_array id="ca" count="6">1 0 0 0 0 1</float_array>
<technique_common><accessor source="#ca" count="2" stride="3"><param name="R" type="float"/>
<param name="G" type="float"/><param name="B" type="float"/></accessor></technique_common></source>"""


def test_colours_of_corners_are_those_of_the_vertices(tmp_path):
    source, inputs = '<vertices id="v">', '<input semantic="TEXCOORD" source="#t" offset="1"/>'
    coloured = inputs.replace("TEXCOORD", "COLOR").replace("#t", "#c")
    mesh = load(written(tmp_path, source=(source, COLOURS + source), inputs=(inputs, coloured)))
    assert {tuple(colour) for colour in mesh.colors.tolist()} == {(255, 128, 0), (255, 0, 0), (0, 0, 255)}


def test_a_picture_beside_the_file_is_read_and_counted_to_it(tmp_path):
    picture = np.zeros((1, 2, 3), np.uint8)
    picture[0] = (255, 0, 0), (0, 0, 255)
    Image.fromarray(picture).save(tmp_path / "two.png")
    path = written(tmp_path, PICTURE)
    texture = load(path).texture
    assert any(np.array_equal(image[..., :3], picture) for image in texture.images)
    assert files_of(path) == [tmp_path / "two.png"]
    (tmp_path / "two.png").unlink()
    assert len(load(path).faces) == 24


@pytest.mark.parametrize("tag, up", [("X_UP", "x"), ("Y_UP", "y"), ("", "y")])
def test_the_file_states_its_up_axis_which_is_y_by_default(tmp_path, tag, up):
    new = f"<up_axis>{tag}</up_axis>" if tag else ""
    assert load(written(tmp_path, up=("<up_axis>Z_UP</up_axis>", new))).up == up


@pytest.mark.parametrize(
    "change, reason",
    [
        (("instance_geometry", "instance_controller"), "robot.dae: has skins alone.*rest pose"),
        (("1 1 2 0 1 2</float_array>", "1 1 2 NaN 1 2</float_array>"), "robot.dae: some numbers are NaN"),
        (('<scene><instance_visual_scene url="#s"/></scene>', ""), "holds no scene"),
        (("polylist", "linestrips"), "no geometry"),
        (("</COLLADA>", ""), "unreadable as DAE"),
    ],
)
def test_a_file_without_a_surface_is_refused_with_its_reason(tmp_path, change, reason):
    with pytest.raises(MeshError, match=reason):
        load(written(tmp_path, change=change))


def test_a_warning_counts_the_parts_that_the_mesh_does_not_get(tmp_path):
    skin = ('<instance_geometry url="#box"/>', '<instance_controller url="#box"/>')
    with pytest.warns(UserWarning, match=r"^robot.dae: left out: skins \(1\)$"):
        assert len(load(written(tmp_path, skin=skin)).faces) == 12


def test_a_polygon_with_a_hole_is_left_out_with_a_warning_and_concave_ones_beside_it_keep_their_shape(tmp_path):
    hole = POLYGONS.replace("<p>", "<ph><p>", 1).replace("</p>", "</p><h>0 0 1 0 2 0</h></ph>", 1)
    arrow = {**AS_POLYGONS, "points": ("0 0 0 1 0 0 1 1 0 0 1 0 0 0 2 1 0 2 1 1 2 0 1 2", ARROW)}
    whole = load(written(tmp_path, **arrow))
    with pytest.warns(UserWarning, match=r"^robot.dae: left out: polygons with holes \(1\)$"):
        mesh = load(written(tmp_path, **arrow, hole=(POLYGONS, hole)))
    assert len(mesh.faces) == 2 * 10
    assert mesh.face_areas.sum() == pytest.approx(whole.face_areas.sum() - (1 + 3) * 6)  # an arrow at each place

"""Taxels from a file: hexagons, fingertips, and files that are wrong."""

import numpy as np
import pytest
import trimesh

from haptic_glance.mesh.mesh import Mesh
from haptic_glance.mesh.rays import RayScene
from haptic_glance.touch import Layer, Layout, forces, layout_forces, press_forces, read_layout, sensor_axes

LAYER = Layer(thickness=0.002, modulus=2e5)
TIP = 0.008  # radius of the fingertip, in metres
HEAD = "x,y,z,nx,ny,nz,area\n"
ROW = "0,0,0,0,0,-1,1e-6\n"
FRAME = np.eye(3)[None]


@pytest.fixture
def table():
    """A slab of 4 cm whose top is z = 0."""
    box = trimesh.creation.box((0.04, 0.04, 0.01))
    return Mesh(box.vertices - [0, 0, 0.005], box.faces)


def written(path, text):
    path.write_text(text)
    return path


def hexagons():
    """(positions (n, 2), area of each) of a hexagonal array of four rings, 1 mm apart."""
    i, j = (part.ravel() for part in np.mgrid[-4:5, -4:5])
    inside = np.abs(i + j) <= 4
    return 0.001 * np.c_[i + j / 2, j * np.sqrt(0.75)][inside], 1e-6 * np.sqrt(0.75)


def fingertip(count=6000):
    """A Layout of equal areas on the cap of a ball (Fibonacci's spiral), its lowest point at the origin."""
    k = np.arange(count) + 0.5
    height, turn = 1 - np.cos(0.9), k * np.pi * (3 - np.sqrt(5))
    down = 1 - k / count * height
    side = np.sqrt(1 - down**2)
    normals = np.c_[side * np.cos(turn), side * np.sin(turn), -down]
    area = 2 * np.pi * TIP**2 * height / count
    return Layout(TIP * (normals + [0, 0, 1]), normals, np.full(count, area))


def test_a_rectangular_layout_is_the_rectangular_array(shapes):
    mesh, vertex = shapes.solid(shapes.sphere)
    mesh, pitch = Mesh(0.1 * mesh.vertices, mesh.faces), 0.0007
    x, y = (part.ravel() for part in shapes.cell_places((9, 13), pitch))
    layout = Layout(np.c_[x, y, 0 * x], [[0, 0, -3]] * len(x), np.full(len(x), pitch**2))
    place = mesh.vertices[[vertex]], FRAME
    for pressed in ({"load": 3.0}, {"depth": 0.0005}):
        grid = press_forces(mesh, *place, LAYER, (9, 13), pitch, **pressed)
        assert np.allclose(layout_forces(mesh, *place, LAYER, layout, **pressed), grid.reshape(1, -1), rtol=1e-4)


def test_a_layout_feels_the_same_on_a_mesh_in_millimetres(table):
    tip, ball = fingertip(200), trimesh.creation.icosphere(5, radius=0.02)
    small, large = Mesh(ball.vertices, ball.faces), Mesh(1000 * ball.vertices, ball.faces)
    for pressed in ({"load": 1.0}, {"depth": 0.001}):
        felt = layout_forces(small, [[0.001, 0, 0.02]], FRAME, LAYER, tip, **pressed)
        in_mm = layout_forces(large, [[1, 0, 20]], FRAME, LAYER, tip, unit=0.001, **pressed)
        assert felt.any() and np.allclose(in_mm, felt, rtol=1e-6, atol=1e-9)
    with pytest.raises(ValueError, match="unit must be a positive number of metres, got 0"):
        layout_forces(table, [[0, 0, 0]], FRAME, LAYER, tip, load=1.0, unit=0)


@pytest.mark.parametrize(("pressed", "flat"), [({"depth": 0.0015}, True), ({"load": 0.4}, False)])
def test_forces_are_those_of_a_ray_from_each_taxel(pressed, flat):
    """The reference casts rays along the approach, from as far above the highest taxel as the layout is wide."""
    knot, random = trimesh.creation.torus(0.03, 0.012, major_sections=60, minor_sections=30), np.random.default_rng(0)
    mesh, (x, y) = Mesh(knot.vertices, knot.faces), random.uniform(-0.01, 0.01, (2, 200))
    z = 0 * x if flat else 20 * (x**2 + y**2)
    normals = np.c_[0 * x, 0 * y, 0 * x - 1] if flat else np.c_[40 * x, 40 * y, 0 * x - 1]
    normals[:3, 2] = 1.0  # three face away
    layout = Layout(np.c_[x, y, z], normals, random.uniform(1e-7, 1e-6, 200))
    places = random.choice(len(knot.vertices), 20)
    centres, axes = knot.vertices[places], sensor_axes(knot.vertex_normals[places])
    start = z.max() + np.ptp(layout.positions, axis=0).max() + LAYER.thickness
    origins = centres[:, None] + (layout.positions * [1, 1, 0] + [0, 0, start]) @ axes
    rays = np.broadcast_to(-axes[:, None, 2], origins.shape).reshape(-1, 3)
    gaps = RayScene(mesh).cast(origins.reshape(-1, 3), rays).distance.reshape(20, 200) - start + z
    gaps[:, layout.cosines == 0] = np.inf
    known = forces(gaps, LAYER, layout.areas, cosines=layout.cosines, **pressed)
    felt = layout_forces(mesh, centres, axes, LAYER, layout, **pressed)
    assert (felt > 0).any(axis=1).all() and np.abs(felt - known).max() < 1e-12


def test_a_hexagonal_file_bears_a_flat_table_equally(tmp_path, table):
    places, area = hexagons()
    rows = "".join(f"0,{x},0,{y},0,-1,{area}\n" for x, y in places)
    layout = read_layout(written(tmp_path / "hex.csv", "nx, x,ny, y, z, nz, area\n".replace(" z,", "z,") + rows))
    assert len(layout.areas) == 61 and layout.positions[:, 2].tolist() == [0] * 61
    felt = layout_forces(table, [[0, 0, 0.001]], FRAME, LAYER, layout, load=6.1)
    assert np.allclose(felt, 0.1, rtol=1e-4)


def test_a_fingertip_on_a_table_is_a_sphere_on_a_foundation(table):
    tip, depth = fingertip(), 0.0004
    felt = layout_forces(table, [[0, 0, 0.003]], FRAME, LAYER, tip, depth=depth)[0]
    known = np.pi * LAYER.stiffness * TIP * depth**2
    assert (felt * tip.cosines).sum() == pytest.approx(known, rel=0.05)  # the cosines of the rim are below 1
    assert felt.argmax() == 0 and 0 < (felt > 0).mean() < 0.5
    loaded = layout_forces(table, [[0, 0, 0.003]], FRAME, LAYER, tip, load=2.0)[0]
    assert (loaded * tip.cosines).sum() == pytest.approx(2.0, rel=1e-9)


def test_layouts_turn_with_their_axes_and_taxels_that_face_away_feel_nothing(table):
    turn = trimesh.transformations.rotation_matrix(0.7, [1, 2, 3])[:3, :3]
    turned, tip = Mesh(table.vertices @ turn.T, table.faces), fingertip(500)
    felt = layout_forces(table, [[0.001, 0, 0.002]], FRAME, LAYER, tip, load=1.0)
    assert np.allclose(felt, layout_forces(turned, [turn @ [0.001, 0, 0.002]], turn.T[None], LAYER, tip, load=1.0))
    taxels = Layout([[0, 0, 0], [0, 0, -0.001]], [[0, 0, -1], [0, 0, 1]], [1e-6, 1e-6])
    assert np.allclose(layout_forces(table, [[0, 0, 0.1]], FRAME, LAYER, taxels, load=0.1), [[0.1, 0]])
    pressed = layout_forces(table, [[0, 0, 0.1]], FRAME, LAYER, taxels, depth=1e-4)
    assert np.allclose(pressed, [[LAYER.stiffness * 1e-10, 0]])


def test_a_layout_off_the_object_touches_nothing(table):
    with pytest.raises(ValueError, match="touch 0 touches nothing"):
        layout_forces(table, [[0.3, 0, 0]], FRAME, LAYER, fingertip(50), load=1.0)
    with pytest.raises(ValueError, match="axes must have shape"):
        layout_forces(table, [[0.3, 0, 0]], np.eye(3), LAYER, fingertip(50), load=1.0)


def test_a_layout_keeps_its_taxels_when_the_caller_s_arrays_change():
    positions = np.zeros((1, 3))
    layout = Layout(positions, [[0, 0, -1]], [1e-6])
    positions += 1
    assert not layout.positions.any()


@pytest.mark.parametrize("encoding", ["utf-8", "utf-8-sig", "utf-16", "latin-1"])
@pytest.mark.parametrize("separator", [";", "\t", ","])
def test_tables_of_spreadsheets_in_any_language_are_read(tmp_path, separator, encoding):
    header, row = "X, y,z,nx,ny,nz,area,Näme\r\n", "0.5,0,-2.5e-3,0,0,-1,1e-06,tip\r\n"
    text = (header + row).replace(".", "." if separator == "," else "\0").replace(",", separator).replace("\0", ",")
    (tmp_path / "tip.csv").write_bytes(text.encode(encoding))
    layout = read_layout(tmp_path / "tip.csv")
    assert layout.positions.tolist() == [[0.5, 0, -0.0025]] and layout.areas.tolist() == [1e-6]


@pytest.mark.parametrize(
    "text, words",
    [
        ("", "layout.csv: no column x, y, z, nx, ny, nz, area; a layout has x,y,z,nx,ny,nz,area"),
        ("x,y,z,nx,ny,area\n", "no column nz"),
        ("X," + HEAD + "5," + ROW, "layout.csv: column x occurs twice; remove one"),
        (HEAD, "layout.csv: layout: there are no taxels"),
        (HEAD + ROW + "1,0,0,0,0,-1,1e-6\n" + ROW, "taxels 1 and 3 are at one place; remove one"),
        (HEAD + ROW + "0,1,0,0,0,-1,\n", "layout.csv: line 3 has a taxel that is not seven numbers"),
        (HEAD + ROW.strip() + ",7\n", "line 2 has a taxel that is not seven numbers"),
        (HEAD + "0,1,0\n", "line 2 has a taxel that is not seven numbers"),
        (HEAD + "0,nan,0,0,0,-1,1\n", "line 2 has a taxel that is not seven numbers"),
        (HEAD + ROW + "0,1,0,0,0,-1,0\n", "taxel 2 has an area of 0"),
        (HEAD + "0,1,0,0,0,0,1\n", "taxel 1 has a normal without length"),
        (HEAD + "0,1,0,0,0,1,1\n", "no taxel faces the object; normals point out of the sensor"),
    ],
)
def test_files_that_are_wrong_are_named_with_the_remedy(tmp_path, text, words):
    with pytest.raises(ValueError, match=words):
        read_layout(written(tmp_path / "layout.csv", text))

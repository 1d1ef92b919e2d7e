"""Forces in newtons: punches and spheres on an elastic foundation, whose answers are known, and what is refused."""

import numpy as np
import pytest
import trimesh

from haptic_glance.mesh.mesh import Mesh
from haptic_glance.touch import (
    Layer,
    Surface,
    distances_at,
    forces,
    gaps_at,
    press_forces,
    sensor_axes,
    sensor_normals,
    shear,
)

LAYER = Layer(thickness=0.01, modulus=1e5, poisson=0.25, friction=0.5)
ABOVE = np.array([[0, 0, 0.005]]), np.eye(3)[None]  # the middle of a face of the punch
RADIUS = 0.3
RANDOM = np.random.default_rng(0).uniform(0, 0.004, (40, 12, 10))


@pytest.fixture
def punch():
    """A cube of 1 cm; ten by ten cells of 1 mm cover a face of it."""
    box = trimesh.creation.box((0.01, 0.01, 0.01))
    return Mesh(box.vertices, box.faces)


@pytest.fixture(scope="module")
def ball(shapes):
    """Function: forces of a fine array on the top of a sphere of radius 0.3 m."""
    mesh, vertex = shapes.solid(shapes.sphere, half=60, spacing=0.0015)

    def work(layer, cells=(101, 101), pitch=0.0015, **pressed):
        return press_forces(mesh, mesh.vertices[[vertex]], np.eye(3)[None], layer, cells, pitch, **pressed)[0]

    return work


STORED = [  # as felt by the first version, which made gaps, then forces: cells pressed, sum, largest, two cells
    ("ball", {"depth": 0.003}, 38, [6.503327391476855, 0.324, 0.2971172268433029, 0.23966123454436902]),
    ("ball", {"load": 2.0}, 24, [2.0, 0.17669420644530362, 0.14981143328860647, 0.09235544098967262]),
    ("box", {"depth": 0.003}, 3, [0.6727500000000026, 0.324, 0.0, 0.0]),
    ("box", {"load": 2.0}, 11, [1.9999999999999991, 0.5142045454545447, 0.0822045454545447, 0.0]),
]


@pytest.mark.parametrize("name, pressed, cells, known", STORED)
def test_forces_are_those_of_the_first_version(name, pressed, cells, known):
    solid = trimesh.creation.icosphere(3, 0.02) if name == "ball" else trimesh.creation.box((0.02, 0.02, 0.02))
    axes = np.array([[[0.6, 0.8, 0], [-0.48, 0.36, 0.8], [0.64, -0.48, 0.6]]])
    place = [[0.0123, -0.0096, 0.012]], axes
    felt = press_forces(Mesh(solid.vertices, solid.faces), *place, LAYER, (7, 6), 0.003, **pressed)[0]
    assert (felt > 0).sum() == cells
    np.testing.assert_allclose([felt.sum(), felt.max(), felt[2, 3], felt[4, 1]], known, rtol=1e-14)


@pytest.mark.parametrize("pressed", [{"depth": np.linspace(0.01, 0, 60)}, {"load": np.linspace(0.01, 1, 60)}])
def test_a_press_is_its_gaps_made_forces_bit_for_bit(pressed):
    knot, cells = trimesh.creation.torus(0.03, 0.012, major_sections=60, minor_sections=30), (7, 12)
    surface = Surface(Mesh(1000 * knot.vertices, knot.faces))  # in millimetres
    vertices = np.random.default_rng(0).choice(len(knot.vertices), 60)
    places = surface.mesh.vertices[vertices], sensor_axes(sensor_normals(surface.mesh, vertices))
    gaps = gaps_at(surface, *places, LAYER.thickness, cells, 1.0, 0.001)
    known = forces(gaps, LAYER, 0.001**2, **pressed)
    felt = press_forces(surface, *places, LAYER, cells, 1.0, unit=0.001, **pressed)
    assert known.any()
    np.testing.assert_array_equal(felt, known)


@pytest.mark.parametrize(
    "place, axes, pressed, words",
    [
        ([0, 0, np.nan], np.eye(3), {"load": 1.0}, "centres must be finite"),
        ([0, 0, 0], 1.00001 * np.eye(3), {"depth": 0.001}, "axes must be three perpendicular unit vectors"),
        ([0, 0, 0], np.eye(3) + 1e-5, {"depth": 0.001}, "axes must be three perpendicular unit vectors"),
        ([0, 0, 0], np.diag([1, 1, -1]), {"depth": 0.001}, "axes must be three perpendicular unit vectors"),
        ([0, 0, 0], np.eye(3), {"depth": [0.001, 0.011]}, "touch 1 needs more than the layer's thickness"),
        ([0, 0, 0], np.eye(3), {"load": [0.1, 1e6]}, "touch 1 needs more than the layer's thickness"),
        ([0, 0, 0], np.eye(3), {"load": [0.1, 0.0]}, "load must be above 0 N, got 0"),
        ([0, 0, 0], np.eye(3), {"load": [0.1, np.inf]}, "load must be finite, got inf"),
        ([0, 0, 0], np.eye(3), {"depth": [0.1, 0.1, 0.1]}, r"depth must be a number or have shape \(2,\)"),
        ([0, 0, 0], np.eye(3), {"depth": np.nan}, "depth must be finite"),
        ([0, 0, 0], np.eye(3), {"depth": -0.001}, "depth must be 0 m or more"),
        ([0, 0, 0], np.eye(3), {}, "give either load"),
        ([0.5, 0, 0], np.eye(3), {"load": 1.0}, "touch 1 touches nothing, so no load can be reached: move the array"),
        ([0, 0, 0], np.eye(3), {"load": 1.0, "unit": 0.0}, "unit must be a positive number of metres"),
    ],
)
def test_presses_that_cannot_be_are_named(punch, place, axes, pressed, words):
    with pytest.raises(ValueError, match=words):
        press_forces(punch, [ABOVE[0][0], place], np.stack([np.eye(3), axes]), LAYER, **pressed)


def test_stiffness_is_that_of_a_confined_layer():
    assert Layer(0.002, 3e5, 0.0).stiffness == pytest.approx(1.5e8) and LAYER.stiffness == pytest.approx(1.2e7)
    assert LAYER.shear_stiffness == pytest.approx(4e6)


def test_a_flat_punch_is_borne_equally_by_the_cells_below_it(punch):
    felt = press_forces(punch, *ABOVE, LAYER, (20, 20), 0.001, load=6.0)[0]
    assert np.allclose(felt[5:15, 5:15], 0.06, rtol=1e-9) and (felt > 0).sum() == 100
    by_depth = press_forces(punch, *ABOVE, LAYER, (20, 20), 0.001, depth=6.0 / (1.2e7 * 1e-4))[0]
    assert np.allclose(by_depth, felt)


@pytest.mark.parametrize("depth", [0.002, 0.008])
def test_a_sphere_is_answered_as_the_foundation_answers_it(ball, depth):
    felt, known = ball(LAYER, depth=depth).sum(), np.pi * LAYER.stiffness * depth**2
    assert felt == pytest.approx(known * (RADIUS - depth / 3), rel=0.003)  # a spherical cap's volume


def test_the_load_of_a_sphere_finds_the_depth_of_that_load(ball):
    by_depth = ball(LAYER, depth=0.005)
    assert np.allclose(ball(LAYER, load=by_depth.sum()), by_depth, rtol=1e-9, atol=1e-9)
    peak = np.sqrt(500 / (np.pi * LAYER.stiffness * RADIUS)) * LAYER.stiffness * 0.0015**2
    assert ball(LAYER, load=500.0).max() == pytest.approx(peak, rel=0.01)


@pytest.mark.parametrize("load", [1e-9, 20.0])
def test_the_sum_is_the_load(load):
    areas = np.random.default_rng(1).uniform(0.5, 2, (12, 10))
    felt = forces(RANDOM, LAYER, areas * 1e-5, load=load)
    assert np.allclose(felt.sum(axis=(1, 2)), load, rtol=1e-9) and (felt >= 0).all()
    assert not forces(np.full((2, 3, 3), np.inf), LAYER, 1e-5, depth=0.001).any()


def test_touches_are_answered_one_by_one_and_from_any_height():
    loads = np.linspace(0.1, 4, len(RANDOM))
    felt = forces(RANDOM, LAYER, 1e-5, load=loads)
    assert all(np.array_equal(forces(RANDOM[[k]], LAYER, 1e-5, load=loads[k])[0], felt[k]) for k in (0, 17, 39))
    assert np.allclose(forces(RANDOM - 0.3, LAYER, 1e-5, load=loads), felt)
    assert np.allclose(forces(RANDOM.reshape(40, -1), LAYER, 1e-5, load=loads), felt.reshape(40, -1))


@pytest.mark.parametrize(
    ("offset", "pressed"), [(1000.0, {"load": 1e-6}), (-1e6, {"load": 1.0}), (-1e6, {"depth": 1e-4})]
)
def test_gaps_from_far_away_lose_nothing(offset, pressed):
    far = RANDOM + offset
    near = far - far.min(axis=(1, 2), keepdims=True)  # exact, by Sterbenz
    felt = forces(far, LAYER, 1e-5, **pressed)
    assert np.array_equal(felt, forces(near, LAYER, 1e-5, **pressed))
    assert "load" not in pressed or np.allclose(felt.sum(axis=(1, 2)), pressed["load"], rtol=1e-12)


def test_units_of_the_mesh_change_no_force():
    ball = trimesh.creation.icosphere(4, radius=0.02)
    metres, millimetres = Mesh(ball.vertices, ball.faces), Mesh(1000 * ball.vertices, ball.faces)
    top = np.array([[0, 0, 0.02]])
    for pressed in ({"load": 0.5}, {"depth": 0.001}):
        felt = press_forces(metres, top, ABOVE[1], LAYER, (17, 19), 0.001, **pressed)
        other = press_forces(millimetres, 1000 * top, ABOVE[1], LAYER, (17, 19), 1.0, unit=0.001, **pressed)
        assert np.allclose(felt, other) and 10 < (felt > 0).sum() < 17 * 19
    near, far = (gaps_at(millimetres, 1000 * top, ABOVE[1], w, (17, 19), 1.0, 0.001) for w in (0.002, 0.01))
    assert (
        np.array_equal(np.isfinite(near), far <= far.min() + 0.002) and 0.0005 < near[np.isfinite(near)].max() < 0.002
    )


def test_gaps_are_the_distances_of_a_rigid_array_within_the_layer(punch):
    knot, cells, pitch = trimesh.creation.torus(0.3, 0.12, major_sections=60, minor_sections=30), (9, 30), 0.02
    surface = Surface(Mesh(knot.vertices, knot.faces))
    vertices = np.random.default_rng(0).choice(len(knot.vertices), 100)
    centres, axes = knot.vertices[vertices], sensor_axes(sensor_normals(surface.mesh, vertices))
    near = distances_at(surface, centres, axes, cells, pitch, contact="rigid")
    near -= near.min(axis=(1, 2), keepdims=True)
    gaps = gaps_at(surface, centres, axes, 0.03, cells, pitch)
    first = gaps.min(axis=(1, 2), keepdims=True)
    assert np.allclose(gaps - first, np.where(near <= 0.03, near, np.inf), atol=1e-12)
    places = np.array([[0, 0, 0.007], [0, 0, 0.004], [0.5, 0, 0]])  # over, within and beside the punch
    gaps = gaps_at(punch, places, np.repeat(ABOVE[1], 3, 0), LAYER.thickness, (4, 4), 0.001)
    assert np.allclose(gaps[0], 0.002) and np.allclose(gaps[1], -0.001) and np.isinf(gaps[2]).all()


def test_cells_past_the_object_bear_nothing_even_under_a_layer_thicker_than_the_array(punch):
    soft = Layer(thickness=0.04, modulus=1e5)
    felt = press_forces(punch, *ABOVE, soft, (12, 12), 0.001, depth=0.039)[0]
    assert (felt > 0).sum() == 100


def test_slip_is_shared_as_between_the_whole_contact_and_the_one_that_sticks(ball):
    """Cattaneo and Mindlin: Q(d) = friction (F(d) - F(d - e)), where e is the depth at which the slip would slide."""
    depth, slip = 0.006, 0.002
    stuck = LAYER.shear_stiffness * slip / (LAYER.friction * LAYER.stiffness)
    whole, inner = ball(LAYER, depth=depth), ball(LAYER, depth=depth - stuck)
    dragged = shear(whole[None], [[slip, 0.0]], LAYER, 0.0015**2)[0]
    assert dragged.shape == (101, 101, 2) and not dragged[..., 1].any()
    assert np.allclose(dragged[..., 0], LAYER.friction * (whole - inner), atol=1e-12)
    known = LAYER.friction * np.pi * LAYER.stiffness * RADIUS * (depth**2 - (depth - stuck) ** 2)
    assert dragged.sum() == pytest.approx(known, rel=0.01)


def test_shear_sticks_slides_and_points_along_the_slip():
    normal = np.full((2, 3, 3), 0.2)
    slow, fast = shear(normal, [[3e-6, -4e-6], [0.3, -0.4]], LAYER, 1e-6)
    assert np.allclose(slow, LAYER.shear_stiffness * 1e-6 * np.array([3e-6, -4e-6]))
    assert np.allclose(fast, [0.06, -0.08])
    turning = np.zeros((2, 3, 3, 2))
    turning[0, 1, 2] = 0.0, 1.0
    assert np.argwhere(shear(normal, turning, LAYER, 1e-6)).tolist() == [[0, 1, 2, 1]]
    taxels = shear(normal.reshape(2, 9), turning.reshape(2, 9, 2), LAYER, 1e-6)  # of a layout
    assert np.array_equal(taxels.reshape(turning.shape), shear(normal, turning, LAYER, 1e-6))


def pressed(**values):
    return forces(RANDOM[:2], LAYER, 1e-5, **values)


@pytest.mark.parametrize(
    "work, words",
    [
        (lambda: Layer(0.0, 1e5), "layer: thickness must be above 0 metres"),
        (lambda: Layer(0.01, -1.0), "layer: modulus must be above 0 pascals"),
        (lambda: Layer(0.01, np.nan), "modulus must be .*, got nan"),
        (lambda: Layer(0.01, np.inf), "modulus must be .* finite, got inf"),
        (lambda: Layer(0.01, 1e5, poisson=0.5), "poisson must be above -1 and below 0.5"),
        (lambda: Layer(0.01, 1e5, friction=0), "friction must be above 0"),
        (lambda: pressed(load=0), "load must be above 0 N, got 0: give newtons"),
        (lambda: pressed(load=np.nan), "load must be finite, got nan"),
        (lambda: pressed(load=[1.0, 2.0, 3.0]), r"load must be a number or have shape \(2,\)"),
        (lambda: pressed(depth=np.inf), "depth must be finite"),
        (lambda: pressed(depth=-0.001), "depth must be 0 m or more, got -0.001: it counts from the first contact"),
        (lambda: pressed(load=1e6), "touch 0 needs more than the layer's thickness of 0.01 m: press less, or"),
        (lambda: pressed(depth=[0.001, 0.02]), "touch 1 needs more than the layer's thickness"),
        (lambda: pressed(), "give either load, in newtons, or depth"),
        (lambda: pressed(load=1.0, depth=0.1), "give either load"),
        (lambda: forces(np.full((1, 2, 2), np.nan), LAYER, 1e-5, load=1.0), "gaps must be numbers"),
        (lambda: forces(np.full((1, 2, 2), -np.inf), LAYER, 1e-5, depth=0.001), "gaps must be numbers of metres"),
        (lambda: forces(np.array(0.1), LAYER, 1e-5, depth=0.001), r"gaps must have shape \(k, \.\.\.\)"),
        (lambda: forces(RANDOM, LAYER, 0.0, load=1.0), "areas must be above 0 m2"),
        (lambda: forces(RANDOM, LAYER, np.nan, depth=0.001), "areas must be above 0 m2, got nan"),
        (lambda: shear(RANDOM, [0.1, 0.2], LAYER, 1e-5), r"slips must be finite and of shape \(k, 2\)"),
        (lambda: shear(RANDOM * np.nan, np.ones((40, 2)), LAYER, 1e-5), "normal must hold newtons of 0 or more"),
        (lambda: shear(-RANDOM, np.ones((40, 2)), LAYER, 1e-5), "normal must hold newtons of 0 or more"),
        (lambda: shear(RANDOM, np.ones((40, 2)), LAYER, np.nan), "areas must be above 0 m2, got nan"),
        (lambda: forces(RANDOM, LAYER, np.ones(3), load=1.0), r"areas must be a number, or one per taxel: .* \(3,\)"),
        (lambda: sensor_axes([[0, 0, np.nan]]), "normals must be finite and not zero, got .* at place 0"),
        (lambda: sensor_axes([[0, 0, 1], [0, 0, 0]]), "normals must be finite and not zero, got .* at place 1"),
    ],
)
def test_numbers_that_no_touch_has_are_named(work, words):
    with pytest.raises(ValueError, match=words):
        work()


def test_shear_of_any_slip_is_finite_and_its_wrong_arguments_are_named():
    layer, normal = Layer(friction=0.6), np.ones(3)
    tiny, huge = (shear(normal, np.tile([[length, 0.0]], (3, 1)), layer, 1e-6) for length in (1e-200, 1e200))
    assert (tiny[:, 0] > 0).all() and huge.tolist() == [[0.6, 0.0]] * 3
    slips = np.zeros((3, 2))
    for error, words, arguments in [
        (ValueError, "normal must hold the forces of one or more taxels", (1.0, [0.0, 0.0], layer, 1e-6)),
        (ValueError, r"areas must be a number, or one per taxel: \(3,\)", (normal, slips, layer, [1, 1])),
        (TypeError, r"layer must be a Layer such as Layer\(friction=0.6\), got None", (normal, slips, None, 1e-6)),
    ]:
        with pytest.raises(error, match=words):
            shear(*arguments)

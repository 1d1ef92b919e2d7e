"""What the touch panels show, without a page."""

import numpy as np
import pytest
import trimesh

from haptic_glance.mesh import normalise
from haptic_glance.mesh.mesh import Mesh
from haptic_glance.studio.feeling import (
    LAYER,
    NEWTONS,
    RIGID,
    SENSORS,
    Sensor,
    feel,
    turned,
)
from haptic_glance.touch import Surface, press, sensor_axes
from haptic_glance.touch.places import Places, place_at

UP = np.array([[0.0, 0.0, 1.0]])


@pytest.fixture(scope="module")
def ball():
    shape = trimesh.creation.icosphere(subdivisions=5)
    return Surface(normalise(Mesh(np.asarray(shape.vertices), np.asarray(shape.faces))))


@pytest.fixture(scope="module")
def torus():
    shape = trimesh.creation.torus(1.0, 0.35, major_sections=96, minor_sections=48)
    return Surface(normalise(Mesh(np.asarray(shape.vertices), np.asarray(shape.faces))))


def at_vertex(surface, vertex=0):
    face = int(np.flatnonzero((surface.mesh.faces == vertex).any(axis=1))[0])
    return place_at(surface, surface.mesh.vertices[[vertex]], np.array([face]))


def slab():
    """A flat square with a step of 0.05 in the middle, along y."""
    x = np.array([-0.5, -1e-4, 1e-4, 0.5])
    height = np.array([0.0, 0.0, 0.05, 0.05])
    rows = np.array([[(a, y, z) for a, z in zip(x, height, strict=True)] for y in (-0.5, 0.5)]).reshape(-1, 3)
    faces = [[k, k + 1, k + 5] for k in range(3)] + [[k, k + 5, k + 4] for k in range(3)]
    return Surface(Mesh(rows, np.array(faces)))


def test_an_ideal_array_at_a_vertex_feels_what_press_feels(torus):
    felt = feel(torus, at_vertex(torus, 5), Sensor())
    assert np.allclose(felt.pressed, 1 - press(torus, 5))


def test_the_legend_is_the_relief_in_units_of_the_file(ball):
    """An array of 16 cells on a ball of radius 0.5: the corners are farthest, by the sagitta of their distance."""
    felt = feel(ball, at_vertex(ball), Sensor(), unit=40.0)
    corner = np.hypot(0.075, 0.075)
    expected = (0.5 - np.sqrt(0.25 - corner**2)) - (0.5 - np.sqrt(0.25 - 2 * 0.005**2))
    assert felt.span == (pytest.approx(40 * expected, rel=0.02), 0.0)
    assert felt.pressed.max() == 1 and felt.pressed.min() == 0


def test_newtons_add_up_to_the_load_and_a_load_too_large_is_refused(ball):
    felt = feel(ball, at_vertex(ball), Sensor(kind=NEWTONS, load=2.0))
    assert felt.span[0] == 0 and felt.unit == "newtons"
    assert (felt.pressed * felt.span[1]).sum() == pytest.approx(2.0, rel=1e-4)
    with pytest.raises(ValueError, match=f"thickness of {LAYER.thickness:g} m"):
        feel(ball, at_vertex(ball), Sensor(kind=NEWTONS, load=10.0, size=0.01))


def test_a_quarter_turn_turns_the_grid(torus):
    place = at_vertex(torus, 5)
    plain, quarter = (feel(torus, place, Sensor(turn=turn)).pressed for turn in (0, 90))
    assert np.allclose(np.rot90(plain, -1), quarter, atol=1e-5) and not np.allclose(plain, quarter, atol=0.1)
    axes = turned(sensor_axes(np.array([[0.0, 0.6, 0.8]])), 37)
    assert np.allclose(axes[0] @ axes[0].T, np.eye(3)) and np.linalg.det(axes[0]) == pytest.approx(1)
    assert np.allclose(axes[0, 2], [0, 0.6, 0.8])


@pytest.mark.parametrize("kind", SENSORS)
def test_cells_are_drawn_on_the_surface(ball, kind):
    felt = feel(ball, at_vertex(ball), Sensor(kind=kind, cells=8))
    places, pressed = felt.contacts
    assert len(places) == len(pressed) == 64
    assert np.abs(np.linalg.norm(places, axis=1) - 0.5).max() < 0.01
    assert np.abs(np.linalg.norm(felt.corners, axis=1)).min() > 0.5  # the outline lies on or above it


@pytest.mark.parametrize("axis", [0, 1])
def test_row_0_is_up_and_column_0_left(axis):
    """On a slab with a step across an axis, seen from above with y up: the high side is pressed, and drawn there."""
    mesh, position = slab().mesh, np.array([[0.0, 0.0, 0.05]])
    position[0, axis] = 0.02
    if axis == 1:
        mesh = Mesh(mesh.vertices[:, [1, 0, 2]], mesh.faces[:, ::-1])
    felt = feel(Surface(mesh), Places(np.array([-1]), position, UP), Sensor(kind=RIGID, cells=8))
    places, pressed = felt.contacts
    high, low = (felt.pressed[:, -1], felt.pressed[:, 0]) if axis == 0 else (felt.pressed[0], felt.pressed[-1])
    assert high.min() > 0.9 > 0.1 > low.max()
    assert places[pressed > 0.9, axis].min() > 0 > places[pressed < 0.1, axis].max()
    assert (np.diff(felt.corners[:2, 0]) > 0).all() and felt.corners[0, 1] > felt.corners[3, 1]


def test_cells_that_meet_nothing_are_not_drawn():
    edge = Places(np.array([-1]), np.array([[0.5, 0.0, 0.05]]), UP)
    felt = feel(slab(), edge, Sensor(kind=RIGID, cells=8))
    places, _ = felt.contacts
    assert len(places) == 32 and places[:, 0].max() < 0.5
    assert np.isinf(felt.depths).sum() == 32

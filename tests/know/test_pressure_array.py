"""One touch along a line, beside what geometry says."""

from dataclasses import replace

import numpy as np
import pytest
import trimesh

from haptic_glance.know import Approach, PressureArray
from haptic_glance.know.pressure_array import check_touch, feel_lines
from haptic_glance.mesh.mesh import Mesh
from haptic_glance.touch import Surface

RADIUS, PITCH = 0.4, 0.03
ARRAY = PressureArray((3, 3), PITCH, 0.05)


@pytest.fixture(scope="module")
def ball():
    sphere = trimesh.creation.icosphere(6, radius=RADIUS)
    return Mesh(np.asarray(sphere.vertices), np.asarray(sphere.faces))


def test_a_plate_meets_a_ball_as_geometry_says(ball):
    travel, imprint = Approach(np.array([0.9, 0, 0]), np.eye(3)[[1, 2, 0]], ARRAY).feel(ball)
    away = PITCH * np.array([[np.sqrt(2), 1, np.sqrt(2)], [1, 0, 1], [np.sqrt(2), 1, np.sqrt(2)]])
    assert travel == pytest.approx(0.9 - RADIUS, abs=2e-4)
    assert imprint == pytest.approx(RADIUS - np.sqrt(RADIUS**2 - away**2), abs=4e-4)


def test_a_cell_feels_no_deeper_than_the_array_and_a_miss_travels_for_ever(ball):
    one = Approach(np.array([0.9, 0, 0]), np.eye(3)[[1, 2, 0]], replace(ARRAY, pitch=0.25))
    travel, imprint = one.feel(ball)
    assert imprint[0, 0] == 0.05 and imprint[1, 1] == pytest.approx(0, abs=1e-3) and np.isfinite(travel)
    travel, imprint = replace(one, origin=np.array([0.9, 1.0, 0])).feel(ball)
    assert travel == np.inf and (imprint == 0.05).all()


def test_an_object_of_another_size_feels_as_the_scaled_mesh(ball):
    origins, axes = np.array([[0.9, 0.1, 0], [0.9, 0, 0.2]]), np.tile(np.eye(3)[[1, 2, 0]], (2, 1, 1))
    for size in (0.7, 1.3):
        larger = Surface(Mesh(size * ball.vertices, ball.faces))
        expected = feel_lines(larger, origins, axes, ARRAY)
        ours = feel_lines(Surface(ball), origins / size, axes, ARRAY, np.full(2, size))
        for first, second in zip(ours, expected, strict=True):
            assert first == pytest.approx(second, abs=1e-9)


def test_noise_is_that_of_the_array_and_the_same_for_the_same_line(ball):
    noisy = replace(ARRAY, travel_noise=0.01, relief_noise=0.002)
    approach = Approach(np.array([0.9, 0, 0]), np.eye(3)[[1, 2, 0]], noisy)
    assert approach.feel(ball)[0] == approach.feel(ball)[0] != replace(approach, array=ARRAY).feel(ball)[0]
    random = np.random.default_rng(0)
    travels = [approach.feel(ball, random)[0] for _ in range(400)]
    assert np.std(travels) == pytest.approx(0.01, rel=0.15) and np.mean(travels) == pytest.approx(0.5, abs=0.002)
    corner = [approach.feel(ball, random)[1][0, 0] for _ in range(400)]
    assert np.std(corner) == pytest.approx(0.002, rel=0.15)


def test_lengths_are_in_one_unit(ball):
    metres = Approach(np.array([0.9, 0.05, 0]), np.eye(3)[[1, 2, 0]], ARRAY)
    millimetres = Approach(1000 * metres.origin, metres.axes, ARRAY.scaled(1000))
    first, second = metres.feel(ball), millimetres.feel(Mesh(1000 * ball.vertices, ball.faces))
    assert 1000 * first[0] == pytest.approx(second[0]) and 1000 * first[1] == pytest.approx(second[1], abs=1e-6)
    assert metres.contact(0.3) == pytest.approx([0.6, 0.05, 0]) and metres.direction == pytest.approx([-1, 0, 0])


@pytest.mark.parametrize(
    ("change", "words"),
    [({"pitch": 0}, "pitch"), ({"depth": -1}, "max_distance"), ({"cells": (0, 3)}, "cells"),
     ({"travel_noise": -0.1}, "travel_noise"), ({"relief_noise": np.nan}, "relief_noise")],
)  # fmt: skip
def test_an_array_that_cannot_be_is_named(change, words):
    with pytest.raises(ValueError, match=words):
        replace(ARRAY, **change)


@pytest.mark.parametrize(
    ("travel", "imprint", "words"),
    [
        (np.nan, np.zeros((3, 3)), "travel"), (-1, np.zeros((3, 3)), "travel"), (0.5, np.zeros((2, 3)), "cells"),
        (0.5, np.full((3, 3), np.nan), "finite"), (0.5, np.full((3, 3), -0.1), "0 or more"),
    ],
)  # fmt: skip
def test_a_touch_that_cannot_be_is_named(travel, imprint, words):
    with pytest.raises(ValueError, match=words):
        check_touch(travel, imprint, ARRAY)
    assert check_touch(0.5, np.full((3, 3), 9.0), ARRAY)[1].max() == 0.05

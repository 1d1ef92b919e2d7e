"""The array's size at saddles."""

import numpy as np
import pytest

from haptic_glance.touch import adaptive_distances, distances_at, sensor_axes, sensor_normals


def pitches(*array, **limits):
    return adaptive_distances(*array, **limits)[0]


def at(mesh, vertex):
    return mesh.vertices[[vertex]], sensor_axes(sensor_normals(mesh, [vertex]))


def test_where_the_array_fits_it_keeps_its_size(shapes):
    mesh, vertex = shapes.solid(shapes.sphere)
    assert pitches(mesh, *at(mesh, vertex), (16, 16), 0.01).tolist() == [0.01]


@pytest.mark.parametrize("cells", [(16, 16), (15, 15), (8, 16)])
def test_at_a_saddle_it_shrinks_to_what_fits_and_no_further(shapes, cells):
    mesh, vertex = shapes.solid(lambda x, y: 2 * x * x - 3 * y * y, half=40, spacing=0.0025)
    place = at(mesh, vertex)
    (pitch,) = pitches(mesh, *place, cells, 0.01)
    assert 0.002 < pitch < 0.01
    assert distances_at(mesh, *place, cells, pitch).min() >= -0.005
    assert distances_at(mesh, *place, cells, pitch * 1.05).min() < -0.005


def test_it_ends_at_the_least_size_even_where_that_does_not_fit(shapes):
    mesh, vertex = shapes.solid(lambda x, y: 30 * np.abs(x), spacing=0.002)
    place = at(mesh, vertex)
    assert pitches(mesh, *place, (16, 16), 0.01).tolist() == [0.002]
    assert pitches(mesh, *place, (16, 16), 0.01, min_pitch=0.005).tolist() == [0.005]


def test_a_larger_tolerance_keeps_a_larger_array(shapes):
    mesh, vertex = shapes.solid(lambda x, y: 2 * x * x - 3 * y * y)
    tight, loose = (pitches(mesh, *at(mesh, vertex), (16, 16), 0.01, tolerance=t)[0] for t in (0.001, 0.008))
    assert tight < loose


def test_each_array_is_judged_for_itself(shapes):
    saddle, vertex = shapes.solid(lambda x, y: 2 * x * x - 3 * y * y)
    centres, axes = (np.repeat(part, 3, axis=0) for part in at(saddle, vertex))
    together = pitches(saddle, centres, axes, (16, 16), np.array([0.002, 0.01, 0.02]))
    alone = [pitches(saddle, *at(saddle, vertex), (16, 16), pitch)[0] for pitch in (0.002, 0.01, 0.02)]
    assert together.tolist() == alone and together[0] == 0.002


@pytest.mark.parametrize("min_pitch", [0.002, 0.0099])  # it fits, or ends at the least size
def test_distances_are_those_of_the_array_at_its_size(shapes, min_pitch):
    mesh, vertex = shapes.solid(lambda x, y: 2 * x * x - 3 * y * y, half=20, spacing=0.003)  # narrower than the array
    place = at(mesh, vertex)
    pitch, measured = adaptive_distances(mesh, *place, (16, 16), 0.01, min_pitch)
    assert pitch[0] < 0.01
    np.testing.assert_array_equal(measured, distances_at(mesh, *place, (16, 16), pitch))


def test_no_array_has_no_size(shapes):
    mesh, _ = shapes.solid(shapes.sphere)
    assert pitches(mesh, np.zeros((0, 3)), np.zeros((0, 3, 3))).shape == (0,)


@pytest.mark.parametrize(
    "change, words",
    [
        ({"min_pitch": 0.02}, "min_pitch must be above 0 and at most the pitch"),
        ({"min_pitch": 0.0}, "min_pitch must be"),
        ({"tolerance": -1.0}, "tolerance must be"),
        ({"cells": (0, 1)}, "cells must be"),
        ({"pitch": 0.0}, "pitch must be"),
    ],
)
def test_what_makes_no_size_is_named(shapes, change, words):
    mesh, vertex = shapes.solid(shapes.sphere, half=4)
    with pytest.raises(ValueError, match=words):
        pitches(mesh, *at(mesh, vertex), **change)

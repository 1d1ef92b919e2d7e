"""The size of neighbourhoods, on grids where density and areas are known."""

import numpy as np
import pytest

from haptic_glance.lod import frozen_faces, neighbourhoods
from haptic_glance.lod.neighbourhood import edge_lengths
from haptic_glance.mesh.mesh import Mesh
from tests.shapes import together

from .conftest import sheet


def scaled(mesh, size, place=0):
    return Mesh(size * mesh.vertices + [place, 0, 0], mesh.faces)


EVEN = scaled(sheet(30), 30)  # edges of 1; vertex i of x and j of y has number i * 31 + j
MIDDLE = 15 * 31 + 15
THREE = together(*(scaled(sheet(8), 8 * step, 100 * step) for step in (1, 2, 4)))  # three densities: edges of 1, 2, 4
CENTRES = np.array([40, 40 + 81, 40 + 162])


@pytest.mark.parametrize(
    ("points", "settings", "rings"),
    [
        (CENTRES[:2], {}, [3, 3]),
        (CENTRES[:2], {"rings": 5}, [5, 5]),
        (CENTRES, {"rule": "adaptive"}, [1, 2, 3]),  # by thirds of the longest
        (CENTRES[::-1], {"rule": "adaptive"}, [3, 2, 1]),
        (CENTRES[:2], {"rule": "adaptive"}, [2, 3]),  # compared with each other alone
        (CENTRES[:1], {"rule": "adaptive"}, [3]),
    ],
)
def test_fixed_takes_the_same_everywhere_and_adaptive_goes_by_the_length_of_edges(points, settings, rings):
    assert neighbourhoods(THREE, points, **settings).tolist() == rings


def test_adaptive_puts_the_ends_of_the_thirds_into_the_lower_one():
    corner = np.array([[0.0, 0, 0], [1, 0, 0], [0, 1, 0]])
    exact = Mesh(np.concatenate([corner + [9, 0, 0], 2 * corner, 3 * corner]), np.arange(9).reshape(3, 3))
    assert edge_lengths(exact, np.array([0, 3, 6])).tolist() == [1, 2, 3]
    assert neighbourhoods(exact, [0, 3, 6], "adaptive").tolist() == [1, 2, 3]


def disc(radius):
    return (np.linalg.norm(EVEN.vertices[:, :2] - 15, axis=1) <= radius).astype(float)


def test_area_takes_as_many_rings_as_fit():
    saliency = disc(6)
    rings = int(neighbourhoods(EVEN, [MIDDLE], "area", saliency)[0])
    region = EVEN.vertex_areas[disc(6) > 0].sum()
    within = [EVEN.face_areas[frozen_faces(EVEN, [MIDDLE], r)].sum() for r in (rings, rings + 1)]
    assert within[0] <= region < within[1]


def test_points_of_one_region_share_its_area():
    saliency = disc(6)
    alone = neighbourhoods(EVEN, [MIDDLE], "area", saliency)
    pair = neighbourhoods(EVEN, [MIDDLE, MIDDLE + 2], "area", saliency)
    assert pair[0] == pair[1] < alone[0]


def test_outside_all_regions_and_where_there_is_none_a_point_keeps_one_ring():
    assert neighbourhoods(EVEN, [0], "area", disc(6)).tolist() == [1]
    assert neighbourhoods(EVEN, [MIDDLE], "area", np.full(len(EVEN.vertices), 0.7)).tolist() == [1]


def test_area_counts_surface_and_not_vertices():
    fine = scaled(sheet(60), 30)
    smooth = [-((mesh.vertices[:, :2] - 15) ** 2).sum(axis=1) for mesh in (EVEN, fine)]
    coarse = neighbourhoods(EVEN, [MIDDLE], "area", smooth[0])[0]
    assert abs(neighbourhoods(fine, [30 * 61 + 30], "area", smooth[1])[0] - 2 * coarse) <= 1


@pytest.mark.parametrize("way", ["adaptive", "area"])
def test_odd_meshes_give_defined_rings(way):
    lone = Mesh(np.r_[EVEN.vertices, [[50.0, 0, 0]]], EVEN.faces)
    saliency = np.zeros(len(lone.vertices))
    rings = neighbourhoods(lone, [len(EVEN.vertices), MIDDLE], way, saliency)
    assert (rings >= 1).all()
    flat = Mesh(np.zeros((3, 3)), [[0, 1, 2]])
    assert neighbourhoods(flat, [0, 1], way, np.ones(3)).tolist() == [1, 1]
    assert neighbourhoods(flat, [], way, np.ones(3)).shape == (0,)


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        (([1], "round"), "fixed, adaptive, area"),
        (([1], "area"), "saliency"),
        (([1], "area", np.full(len(EVEN.vertices), np.nan)), "saliency"),
        (([10**6], "adaptive"), "outside"),
    ],
)
def test_bad_arguments_are_named(arguments, words):
    with pytest.raises(ValueError, match=words):
        neighbourhoods(EVEN, *arguments)

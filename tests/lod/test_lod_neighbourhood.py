"""The size of neighbourhoods, on grids where density and areas are known."""

import numpy as np
import pytest

from haptic_glance.lod import frozen_faces, neighbourhoods
from haptic_glance.lod.neighbourhood import edge_lengths
from haptic_glance.mesh.mesh import Mesh


def grid(x, y):
    """A flat sheet with vertices at all (x, y); vertex i of x and j of y has number i * len(y) + j."""
    a = np.arange(len(x) * len(y)).reshape(len(x), len(y))
    corner, right, up, both = a[:-1, :-1].ravel(), a[1:, :-1].ravel(), a[:-1, 1:].ravel(), a[1:, 1:].ravel()
    places = np.stack(np.meshgrid(x, y, indexing="ij"), axis=-1).reshape(-1, 2)
    return Mesh(np.c_[places, np.zeros(len(places))], np.r_[np.c_[corner, right, up], np.c_[up, right, both]])


EVEN = grid(np.arange(31.0), np.arange(31.0))
MIDDLE = 15 * 31 + 15
# Three sheets with edges of 1, 2 and 4 in one mesh: three densities.
SHEETS = [grid(np.arange(9) * step, np.arange(9) * step) for step in (1.0, 2.0, 4.0)]
THREE = Mesh(
    np.concatenate([sheet.vertices + [100 * k, 0, 0] for k, sheet in enumerate(SHEETS)]),
    np.concatenate([sheet.faces + 81 * k for k, sheet in enumerate(SHEETS)]),
)
CENTRES = np.array([40, 40 + 81, 40 + 162])


def test_fixed_takes_the_same_everywhere():
    assert neighbourhoods(EVEN, [3, MIDDLE]).tolist() == [3, 3]
    assert neighbourhoods(EVEN, [3, MIDDLE], rings=5).tolist() == [5, 5]


def test_adaptive_takes_one_two_and_three_rings_by_thirds_of_the_longest():
    assert neighbourhoods(THREE, CENTRES, "adaptive").tolist() == [1, 2, 3]
    assert neighbourhoods(THREE, CENTRES[::-1], "adaptive").tolist() == [3, 2, 1]


def test_adaptive_compares_the_points_with_each_other_alone():
    assert neighbourhoods(THREE, CENTRES[:2], "adaptive").tolist() == [2, 3]  # 1/2 of the longest, and the longest
    assert neighbourhoods(THREE, CENTRES[:1], "adaptive").tolist() == [3]


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
    both = neighbourhoods(EVEN, [MIDDLE, MIDDLE + 2], "area", saliency)
    assert both[0] == both[1] < alone[0]


def test_outside_all_regions_and_where_there_is_none_a_point_keeps_one_ring():
    assert neighbourhoods(EVEN, [0], "area", disc(6)).tolist() == [1]
    assert neighbourhoods(EVEN, [MIDDLE], "area", np.full(len(EVEN.vertices), 0.7)).tolist() == [1]


def test_area_counts_surface_and_not_vertices():
    fine = grid(np.arange(0, 30.5, 0.5), np.arange(0, 30.5, 0.5))
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

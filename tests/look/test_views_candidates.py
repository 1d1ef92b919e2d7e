"""The 62 candidates are those that T3.2.4 counts: 18 sets of four perpendicular views, ten of 72 shared."""

from collections import Counter

import numpy as np
import pytest

from haptic_glance.look.views import CANDIDATES, PERPENDICULAR_SETS
from haptic_glance.look.views.best import BETWEEN, on_circle


def backs(views):
    return np.array([view.axes[2] for view in views])


def test_there_are_18_sets_of_four_and_62_different_viewpoints_in_all():
    assert [len(views) for views in PERPENDICULAR_SETS] == [4] * 18
    assert len(CANDIDATES) == len({view.name for view in CANDIDATES}) == 62
    assert set(CANDIDATES) == {view for views in PERPENDICULAR_SETS for view in views}


def test_ten_of_the_72_are_repetitions_and_all_of_them_at_the_poles():
    times = Counter(view for views in PERPENDICULAR_SETS for view in views)
    assert sum(times.values()) - len(times) == 10
    assert {view.elevation: count for view, count in times.items() if count > 1} == {90: 6, -90: 6}


def test_no_two_candidates_look_from_the_same_side():
    apart = np.degrees(np.arccos((backs(CANDIDATES) @ backs(CANDIDATES).T).clip(-1, 1)))
    assert apart[np.triu_indices(62, 1)].min() > 14  # neighbours on the parallels of 60 degrees: 14.4


@pytest.mark.parametrize("views", PERPENDICULAR_SETS, ids=lambda views: views[0].name)
def test_the_views_of_a_set_are_perpendicular_in_turn_around_one_axis(views):
    looks = backs(views)
    turn = np.roll(looks, -1, axis=0)
    np.testing.assert_allclose(np.einsum("ij,ij->i", looks, turn), 0, atol=1e-12)
    np.testing.assert_allclose(looks, -np.roll(turn, -1, axis=0), atol=1e-12)
    axis = np.cross(looks[0], looks[1])
    assert np.allclose(looks @ axis, 0) and np.isclose(axis[2], 0)


def test_sets_are_different():
    assert len({frozenset(views) for views in PERPENDICULAR_SETS}) == 18


@pytest.mark.parametrize("k", range(18))
def test_an_added_view_stands_half_way_between_two_of_its_set(k):
    views, between = backs(PERPENDICULAR_SETS[k]), backs(BETWEEN[k])
    half = np.cos(np.radians(45))
    np.testing.assert_allclose(np.einsum("ij,ij->i", views, between), half)
    np.testing.assert_allclose(np.einsum("ij,ij->i", np.roll(views, -1, axis=0), between), half)
    assert not set(BETWEEN[k]) & set(CANDIDATES)


def test_the_arrangement_is_a_grid_of_parallels_and_both_poles():
    assert Counter(view.elevation for view in CANDIDATES) == {el: 12 for el in (-60, -30, 0, 30, 60)} | {90: 1, -90: 1}
    assert {view.azimuth for view in CANDIDATES} == set(range(0, 360, 30))


def test_images_stay_upright_over_the_top():
    for views in (*PERPENDICULAR_SETS, *BETWEEN):
        for view in views:
            assert -90 <= view.elevation <= 90 and 0 <= view.azimuth < 360 and view.roll == 0
            assert view.axes[1][2] >= -1e-12


def test_one_set_holds_the_four_principal_views_of_the_thesis():
    principal = {tuple(end) for end in np.vstack([np.eye(3)[1:], -np.eye(3)[1:]])}
    found = [
        views for views in PERPENDICULAR_SETS if {tuple(np.round(back, 9) + 0.0) for back in backs(views)} == principal
    ]
    assert len(found) == 1


@pytest.mark.parametrize(
    "angle, expected", [(0, (30, 0)), (60, (30, 60)), (90, (0, 90)), (120, (210, 60)), (180, (210, 0)),
                        (210, (210, -30)), (270, (0, -90)), (315, (30, -45)), (405, (30, 45))]
)  # fmt: skip
def test_a_circle_passes_over_both_poles(angle, expected):
    view = on_circle(30, angle)
    assert (view.azimuth, view.elevation) == expected

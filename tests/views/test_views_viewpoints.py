"""The sets of viewpoints are those of T figure 3.2."""

import numpy as np
import pytest

from stages.views import FOUR, TWELVE, viewpoint_set


def test_twelve_different_viewpoints():
    assert len({viewpoint.name for viewpoint in TWELVE}) == 12
    backs = np.array([viewpoint.axes[2] for viewpoint in TWELVE])
    apart = np.degrees(np.arccos((backs @ backs.T).clip(-1, 1)))[np.triu_indices(12, 1)]
    assert apart.min() > 40


def test_twelve_hold_top_and_bottom_and_both_ends_of_the_other_axes():
    backs = np.array([viewpoint.axes[2] for viewpoint in TWELVE])
    for end in np.r_[np.eye(3), -np.eye(3)]:
        assert np.isclose(backs @ end, 1).sum() == 1


def test_four_stand_a_right_angle_apart_all_round():
    assert [(viewpoint.azimuth, viewpoint.elevation) for viewpoint in FOUR] == [(0, 0), (90, 0), (180, 0), (270, 0)]


def test_principal_views_are_both_ends_of_y_and_z():
    backs = np.array([viewpoint.axes[2] for viewpoint in viewpoint_set("principal")])
    np.testing.assert_allclose(sorted(backs.round(9).tolist()), [[0, -1, 0], [0, 0, -1], [0, 0, 1], [0, 1, 0]])


def test_unknown_set_names_the_known_ones():
    with pytest.raises(ValueError, match="twelve, four, principal"):
        viewpoint_set("thirteen")

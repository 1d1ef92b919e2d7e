"""The sets of viewpoints are those of T figure 3.2."""

import numpy as np
import pytest

from haptic_glance.look.views import FOUR, TWELVE, viewpoint_set


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


CAPTION = {  # T figure 3.2: turns of the object in degrees, around z, then around x
    "a": (0, 0), "b": (90, 0), "c": (180, 0), "d": (270, 0), "e": (0, 45), "f": (120, 45), "g": (240, 45),
    "h": (0, -45), "i": (120, -45), "j": (240, -45), "k": (90, 0), "l": (0, 180),
}  # fmt: skip


def camera_after(around_z, around_x):
    """Where the first camera stands as seen from the object, once that has turned; x: to the right of the image."""
    right, _, back = TWELVE[0].axes
    z, x = np.radians([around_z, around_x])
    up = np.array([0.0, 0.0, 1.0])
    tilted = np.cos(x) * back - np.sin(x) * np.cross(right, back)
    return np.cos(z) * tilted - np.sin(z) * np.cross(up, tilted) + (1 - np.cos(z)) * (up @ tilted) * up


def test_ten_viewpoints_are_as_captioned_and_two_are_not():
    found = {letter: camera_after(*turns).round(9) + 0.0 for letter, turns in CAPTION.items()}
    ours = {tuple(viewpoint.axes[2].round(9) + 0.0) for viewpoint in TWELVE[:10]}
    assert ours == {tuple(found[letter]) for letter in "abcdefghij"}
    assert (found["k"] == found["b"]).all() and (found["l"] == found["c"]).all()  # as printed: no view of top or bottom
    turned = {tuple(camera_after(0, turn).round(9) + 0.0) for turn in (90, -90)}
    assert {tuple(viewpoint.axes[2].round(9) + 0.0) for viewpoint in TWELVE[10:]} == turned

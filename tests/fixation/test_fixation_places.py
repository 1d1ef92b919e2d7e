"""Whether the most salient place is the same from all sides, on balls at which a network looks."""

import numpy as np
import pytest

from stages.fixation.places import nearer
from stages.fixation.tasks import viewpoint_sphere

VIEWS = viewpoint_sphere(1, 3)[:3]
AXES = np.array([view.axes[2] for view in VIEWS])


def looked_at(mesh, peak=None, blind=()):
    """The gains of a map that is highest towards `peak` in all views, or at each picture's middle for None."""
    seen = (mesh.vertices @ AXES.T > -0.05).T
    seen[list(blind)] = False
    values = np.stack([mesh.vertices @ (axis if peak is None else np.asarray(peak, float)) for axis in AXES])
    return nearer(mesh, VIEWS, seen, values.astype(np.float16) + 0.5)


def test_one_place_seen_from_all_sides_is_told_from_chance_and_from_the_middle(ball):
    found = looked_at(ball, (0, 0, 1))
    assert min(found.values()) > 0.4 and len(found) == 2  # all views look at the pole


def test_looking_at_the_middle_of_each_picture_is_no_place_of_the_object(ball):
    found = looked_at(ball)
    assert found["nearer_than_chance"] < -0.05
    assert found["nearer_than_middle"] == pytest.approx(0, abs=0.01)


def test_a_view_that_sees_nothing_has_no_place(ball):
    assert looked_at(ball, (0, 0, 1), blind=[1, 2]) == {}
    assert len(looked_at(ball, (0, 0, 1), blind=[2])) == 2

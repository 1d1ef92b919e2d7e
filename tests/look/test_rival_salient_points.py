"""Salient points (Castellani 2008) on shapes whose salient places are known."""

import numpy as np
import pytest

from haptic_glance.look.rivals import salient_points


@pytest.mark.slow
def test_a_bump_of_the_right_size_is_the_first_point_and_a_wide_swell_is_none(bump_and_swell, sphere, saliency_of):
    values = saliency_of(salient_points, bump_and_swell)
    found = salient_points.points(bump_and_swell, values)
    along = sphere(5).vertices[:, 0]
    top, swell = along.argmax(), along.argmin()
    assert found[0] == top
    assert values[swell] < 0.3 * values[top]
    assert swell not in found


@pytest.mark.slow
def test_points_exceed_three_tenths_of_the_maximum(raised):
    mesh = raised(np.eye(3), [0.08, 0.08, 0.08], [0.06, 0.006, 0.04])
    values = salient_points.saliency(mesh)
    found = salient_points.points(mesh, values)
    assert len(found) == 2
    assert values[found].min() > 0.3

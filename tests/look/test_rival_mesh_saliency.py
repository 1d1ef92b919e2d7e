"""Mesh saliency (Lee 2005) on shapes whose salient places are known."""

import pytest

from haptic_glance.look.rivals import mesh_saliency


@pytest.mark.slow
def test_a_bump_of_the_right_size_is_the_first_point_and_a_wide_swell_is_none(bump_and_swell, sphere, saliency_of):
    values = saliency_of(mesh_saliency, bump_and_swell)
    found = mesh_saliency.points(bump_and_swell, values)
    along = sphere(5).vertices[:, 0]
    top, swell = along.argmax(), along.argmin()
    assert found[0] == top
    assert values[swell] < 0.1 * values[top]
    assert swell not in found

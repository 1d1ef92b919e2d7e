"""From places on the surface to vertices."""

import numpy as np

from haptic_glance.look.channels.surface import nearest_corners
from haptic_glance.mesh.mesh import Mesh


def test_a_place_takes_the_corner_nearest_to_it():
    sliver = Mesh([[0, -0.4, 0], [0, 0.4, 0], [0, 0.4, 0.01]], [[0, 1, 2]])
    places = np.array([[0, -0.39, 1e-4], [0, 0.39, 1e-3], [0, 0.399, 9e-3]])
    assert nearest_corners(sliver, np.zeros(3, dtype=np.int64), places).tolist() == [
        0,
        1,
        2,
    ]  # the centroid's is 1 or 2

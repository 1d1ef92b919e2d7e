"""The NIST benchmark's ground truth, in files of its layout that the test makes."""

import io

import numpy as np
import pytest
from scipy.io import savemat

from haptic_glance.mesh import MeshError
from stages.weights.ground_truth import read_interest_points


def ground_truth(most=16):
    """Bytes of NAME.mat: at radius r and least users n the points are r + n + 1..., the marks n and n + 1."""
    cells = np.empty((10, most - 1, 2), dtype=object)
    for radius in range(10):
        for users in range(2, most + 1):
            clusters = np.empty((1, 2), dtype=object)
            clusters[0] = ["  ".join(["7"] * users), "  ".join(["123"] * (users + 1))]
            cells[radius, users - 2] = np.array([[radius + users + 1, radius + users + 101]], dtype=float), clusters
    return cells


def stored(**variables):
    stream = io.BytesIO()
    savemat(stream, variables)
    return stream.getvalue()


@pytest.mark.parametrize(("sigma", "users"), [(0.03, 8), (0.01, 2), (0.1, 16)])
def test_points_and_marks_of_a_radius_and_number_of_users(sigma, users):
    vertices, marks = read_interest_points(stored(GT_MODEL=ground_truth()), sigma, users)
    radius = round(sigma * 100) - 1
    assert vertices.tolist() == [radius + users, radius + users + 100]  # counted from 0, where MATLAB counts from 1
    assert marks.tolist() == [users, users + 1] and vertices.dtype == marks.dtype == np.int64


def test_a_path_reads_like_bytes(tmp_path):
    (tmp_path / "ant.mat").write_bytes(stored(GT_MODEL=ground_truth()))
    assert read_interest_points(tmp_path / "ant.mat")[0].tolist() == [10, 110]


def test_no_point_that_enough_users_marked_is_no_error():
    cells = ground_truth()
    cells[2, 6] = np.zeros((0, 0)), np.empty((0, 0), dtype=object)
    vertices, marks = read_interest_points(stored(GT_MODEL=cells))
    assert len(vertices) == len(marks) == 0


def test_a_single_point_is_read():
    cells, cluster = ground_truth(), np.empty((1, 1), dtype=object)
    cluster[0, 0] = "12  13  14"
    cells[2, 6] = np.array([[12.0]]), cluster
    vertices, marks = read_interest_points(stored(GT_MODEL=cells))
    assert vertices.tolist() == [11] and marks.tolist() == [3]


def test_a_sigma_or_number_of_users_that_is_not_there_is_named():
    content = stored(GT_MODEL=ground_truth(most=5))
    with pytest.raises(ValueError, match="sigma 0.035 is not one of 0.01, 0.02"):
        read_interest_points(content, 0.035, 3)
    with pytest.raises(ValueError, match=r"2\.\.5.* got 6"):
        read_interest_points(content, 0.03, 6)


def test_other_files_are_refused_with_the_reason():
    with pytest.raises(MeshError, match="unreadable as a MATLAB file"):
        read_interest_points(b"\x89HDF\r\n\x1a\n" + b"\0" * 600)
    with pytest.raises(MeshError, match="no variable GT_MODEL"):
        read_interest_points(stored(V=np.eye(3)))
    with pytest.raises(ValueError, match="10 radii by users"):
        read_interest_points(stored(GT_MODEL=np.eye(3)))
    cells = ground_truth()
    cells[2, 6, 0] = np.array([[4.0]])
    with pytest.raises(ValueError, match="1 points.* 2 clusters"):
        read_interest_points(stored(GT_MODEL=cells))

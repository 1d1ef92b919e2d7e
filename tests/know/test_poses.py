"""Grids of poses and lines: one table of touches serves all poses."""

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from haptic_glance.know.poses import POSES, even_rotations, pose_grid

START = 0.9


@pytest.mark.parametrize("pose", POSES)
def test_a_line_seen_from_an_object_in_a_pose_is_a_line_of_the_table(pose):
    grid, random = pose_grid(pose, START), np.random.default_rng(0)
    origins, axes = grid.lines_of_object()
    size = len(grid.group)
    for _ in range(20):
        further, turn = random.integers(len(grid.further)), random.integers(len(grid.poses))
        line = random.integers(grid.lines)
        rotation = grid.rotations[further * len(grid.poses) + turn]
        base, element = divmod(line, size)
        row = (further * len(grid.origins) + base) * size + grid.seen[turn, element]
        assert np.allclose(grid.line_origins[line] @ rotation, origins[row], atol=1e-9)
        assert np.allclose(grid.line_axes[line] @ rotation, axes[row], atol=1e-9)


def test_the_grids_have_their_poses_and_any_rotation_is_near_one():
    assert [pose_grid(pose, START).size for pose in POSES] == [1, 48, 2880]
    turns = Rotation.from_matrix(pose_grid("turned", START).rotations).as_rotvec()
    assert np.allclose(np.sort(np.degrees(turns[:, 2]) % 360), np.arange(48) * 7.5, atol=1e-9)
    grid = Rotation.from_matrix(pose_grid("any", START).rotations).as_quat()
    drawn = Rotation.random(500, random_state=0).as_quat()
    nearest = np.degrees(2 * np.arccos(np.clip(np.abs(drawn @ grid.T).max(axis=1), 0, 1)))
    even = even_rotations(2880).as_quat()
    peer = np.degrees(2 * np.arccos(np.clip(np.abs(drawn @ even.T).max(axis=1), 0, 1)))
    assert nearest.max() < 16 and nearest.mean() < peer.mean()


@pytest.mark.parametrize("pose", POSES)
def test_lines_begin_outside_and_pass_near_the_centre(pose):
    grid = pose_grid(pose, START)
    along = np.einsum("li,li->l", grid.line_origins, grid.line_axes[:, 2])
    beside = np.linalg.norm(grid.line_origins - along[:, None] * grid.line_axes[:, 2], axis=1)
    assert np.allclose(along, START) and beside.max() < 0.29
    assert pose == "any" or grid.line_axes[:, 2, 2].min() > -0.2  # none from below the table


def test_an_unknown_pose_is_named():
    with pytest.raises(ValueError, match="unknown pose 'upside': choose one of fixed, turned, any"):
        pose_grid("upside", START)

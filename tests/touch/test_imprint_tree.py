"""The tree of faces: every face in one block, every node in the tightest box."""

import numpy as np
import pytest

from haptic_glance.touch.kernels.faces import face_tree

LANES = 32


def corners_of(count):
    """(count, 3, 3) corners of faces, many of them at one place along an axis."""
    return np.random.default_rng(count).integers(0, 9, (count, 3, 3)).astype(float)


@pytest.mark.parametrize("count", [0, 1, 31, 32, 33, 64, 65, 1000])
def test_each_face_is_in_one_block_and_only_the_last_block_is_filled_up(count):
    corners = corners_of(count)
    blocks = face_tree(corners, np.arange(count) + 1.0)[0]
    faces = blocks.reshape(-1, 10, LANES).transpose(0, 2, 1).reshape(-1, 10)
    assert np.isnan(faces[count:]).all() and len(faces) - count < LANES
    order = np.argsort(faces[:count, 9])
    np.testing.assert_array_equal(faces[:count][order, :9].reshape(-1, 3, 3), corners)


@pytest.mark.parametrize("count", [1, 33, 65, 1000])
def test_the_box_of_a_node_just_holds_the_faces_below_it(count):
    blocks, boxes, children = face_tree(corners_of(count), np.ones(count))

    def places(node):
        """(p, 3) the corners below a node."""
        if children[node] < 0:
            found = blocks[-1 - children[node], : 9 * LANES].reshape(3, 3, LANES).transpose(2, 0, 1).reshape(-1, 3)
            return found[~np.isnan(found[:, 0])]
        return np.concatenate([places(children[node]), places(children[node] + 1)])

    assert len(places(0)) == 3 * count
    for node, box in enumerate(boxes):
        low, high = places(node).min(axis=0), places(node).max(axis=0)
        np.testing.assert_allclose(box, np.concatenate([(low + high) / 2, (high - low) / 2]))


def test_a_node_is_split_across_the_longest_side_of_the_centres():
    corners = corners_of(640) * [1, 1, 5]
    blocks, _, children = face_tree(corners, np.ones(640))
    first = -1 - np.array(children[children < 0])
    assert sorted(first) == list(range(20))
    heights = blocks[:, : 9 * LANES].reshape(20, 3, 3, LANES)[:, :, 2].mean(axis=1)
    assert heights[:10].max() <= heights[10:].min()

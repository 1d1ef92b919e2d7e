"""The cheapest sequence of levels, checked against all sequences, and the shared limit."""

import itertools

import numpy as np
import pytest

from haptic_glance.lod.scene import Frames, Level, budget
from haptic_glance.lod.scene.budget import VIOLATION_COST, cheapest, share_limit
from haptic_glance.mesh.mesh import Mesh

FACES = np.array([100.0, 40.0, 10.0])


def runs(levels):
    return [(level, len(list(group))) for level, group in itertools.groupby(levels)]


def by_trial(faces, errors, steps, tolerance, hold):
    """The least cost of all sequences that hold their levels long enough."""
    best = np.inf
    for levels in itertools.product(range(errors.shape[1]), repeat=len(errors)):
        if any(length < hold for _, length in runs(levels)[1:-1]):
            continue
        best = min(best, cost(levels, faces, errors, steps, tolerance))
    return best


def cost(levels, faces, errors, steps, tolerance):
    total = sum(faces[t, k] + VIOLATION_COST * max(errors[t, k] / tolerance - 1, 0) for t, k in enumerate(levels))
    switches = [(t, levels[t - 1], levels[t]) for t in range(1, len(levels)) if levels[t - 1] != levels[t]]
    return total + sum(VIOLATION_COST * max(steps[t, a, b] / tolerance - 1, 0) for t, a, b in switches)


@pytest.mark.parametrize("hold", [1, 2, 3])
@pytest.mark.parametrize("seed", range(4))
def test_no_sequence_is_cheaper(seed, hold):
    draw = np.random.default_rng(seed)
    errors = np.sort(draw.random((6, 3)) * 1.6, axis=1)
    errors[:, 0] = 0
    steps = draw.random((6, 3, 3)) * 1.4
    faces = np.tile(FACES, (6, 1)) * (1 + 0.1 * draw.random((6, 3)))
    sequence = cheapest(faces, errors, steps, 1.0, hold)
    assert all(length >= hold for _, length in runs(sequence)[1:-1])
    assert cost(sequence, faces, errors, steps, 1.0) == pytest.approx(by_trial(faces, errors, steps, 1.0, hold))


def test_an_infinite_error_is_never_chosen_when_there_is_another():
    errors = np.array([[np.inf, np.inf, 5.0]] * 4)
    assert cheapest(np.tile(FACES, (4, 1)), errors, np.zeros((4, 3, 3)), 1.0, 2).tolist() == [2] * 4


def test_a_limit_is_shared_where_it_hurts_least():
    faces = [np.array([100, 50, 20]), np.array([100, 50, 20])]
    errors = [np.array([0, 0.1, 0.2]), np.array([0, 1.0, 4.0])]
    assert share_limit([0, 0], faces, errors, 200).tolist() == [0, 0]
    assert share_limit([0, 0], faces, errors, 150).tolist() == [1, 0]
    assert share_limit([0, 0], faces, errors, 120).tolist() == [2, 0]
    assert share_limit([0, 0], faces, errors, 70).tolist() == [2, 1]
    assert share_limit([0, 0], faces, errors, 1).tolist() == [2, 2]
    faces = [np.array([100, 60, 10]), np.array([300, 240, 230])]  # of equal errors that which saves the most faces
    assert share_limit([0, 0], faces, [np.array([0, 1, 2])] * 2, 350).tolist() == [0, 1]


def test_no_sharing_has_a_smaller_worst_error():
    draw = np.random.default_rng(3)
    faces = [np.array([90, 60, 40, 25, 10]) + draw.integers(5) for _ in range(3)]
    errors = [np.cumsum(draw.random(5)) for _ in range(3)]
    all_levels = list(itertools.product(range(5), repeat=3))
    total = {levels: sum(by_level[k] for by_level, k in zip(faces, levels, strict=True)) for levels in all_levels}
    worst = {levels: max(by_level[k] for by_level, k in zip(errors, levels, strict=True)) for levels in all_levels}
    for limit in (60, 100, 150, 200, 250):
        shared = tuple(share_limit([0, 0, 0], faces, errors, limit).tolist())
        assert total[shared] <= limit
        assert worst[shared] == min(worst[levels] for levels in all_levels if total[levels] <= limit)


@pytest.mark.slow
def test_the_order_of_vertices_and_faces_changes_no_plan(make_scene, meshes, chains):
    scene = make_scene(frames=6, hold=2)
    mixed = {name: tuple(shuffled(level, k) for k, level in enumerate(chain)) for name, chain in chains.items()}
    full = [mixed[placed.name][0] for placed in scene.objects]
    frames = Frames(scene, {name: chain[0].mesh for name, chain in mixed.items()}, full)
    assert np.array_equal(
        budget(meshes, scene, chains=chains).faces, budget(meshes, scene, chains=mixed, frames=frames).faces
    )


def shuffled(level, seed):
    """The level with its vertices and faces in another order."""
    draw = np.random.default_rng(seed)
    order = draw.permutation(len(level.mesh.vertices))
    faces = np.argsort(order)[level.mesh.faces][draw.permutation(len(level.mesh.faces))]
    return Level(Mesh(level.mesh.vertices[order], faces), level.error)


def test_meshes_of_a_budget_are_a_mapping():
    with pytest.raises(TypeError, match="^meshes must be a mapping from names to meshes, got list$"):
        budget([], None)

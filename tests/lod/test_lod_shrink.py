"""Neighbourhoods shrink no more than the target asks for, the least salient first."""

import numpy as np
import pytest
import trimesh

from haptic_glance.lod import InfeasibleTarget, shrunk_rings, smallest_feasible
from haptic_glance.mesh.mesh import Mesh

BALL = trimesh.creation.icosphere(subdivisions=4, radius=0.5)
SPHERE = Mesh(BALL.vertices, BALL.faces)
KEEP = np.array([11, 900, 1500, 2200, 60, 1234])


def walk(rings):
    """The states that neighbourhoods pass through, one step after the other, written out plainly."""
    rings, states = list(rings), [list(rings)]
    while max(rings) > 0:
        for i in reversed(range(len(rings))):
            if rings[i] > 0:
                rings[i] -= 1
                states.append(list(rings))
    for i in reversed(range(len(rings))):
        if rings[i] == 0:
            rings[i] = -1
            states.append(list(rings))
    return states


def test_a_feasible_target_keeps_everything():
    assert shrunk_rings(SPHERE, smallest_feasible(SPHERE, KEEP), KEEP).tolist() == [3] * 6


@pytest.mark.parametrize("rings", [[3] * 6, [1, 4, 2, 0, -1, 3]])
@pytest.mark.parametrize("faces", [20, 150, 300, 450])
def test_the_first_feasible_state_of_the_walk_is_taken(rings, faces):
    states = walk(rings)
    first = next(state for state in states if smallest_feasible(SPHERE, KEEP, np.array(state)) <= faces)
    assert shrunk_rings(SPHERE, faces, KEEP, np.array(rings)).tolist() == first


@pytest.mark.parametrize("faces", [20, 100, 200, 300, 400])
def test_the_more_salient_of_equal_points_never_has_less(faces):
    rings = shrunk_rings(SPHERE, faces, KEEP)
    assert (np.diff(rings) <= 0).all()
    assert smallest_feasible(SPHERE, KEEP, rings) <= faces


def test_lower_targets_keep_less():
    found = [shrunk_rings(SPHERE, faces, KEEP) for faces in range(5, 600, 60)]
    assert all((low <= high).all() for low, high in zip(found, found[1:], strict=False))
    assert found[0].tolist() == [-1] * 6


def test_order_of_the_vertices_does_not_matter():
    order = np.random.default_rng(0).permutation(len(SPHERE.vertices))
    place = np.argsort(order)
    mixed = Mesh(SPHERE.vertices[order], place[SPHERE.faces])
    assert shrunk_rings(mixed, 250, place[KEEP]).tolist() == shrunk_rings(SPHERE, 250, KEEP).tolist()


def test_nothing_kept_has_nothing_to_shrink():
    assert shrunk_rings(SPHERE, 100, None).shape == (0,)


def test_a_target_below_the_mesh_itself_is_infeasible():
    ring = trimesh.creation.torus(0.35, 0.15, major_sections=24, minor_sections=12)
    with pytest.raises(InfeasibleTarget) as caught:
        shrunk_rings(Mesh(ring.vertices, ring.faces), 10, [3])
    assert (caught.value.frozen, caught.value.smallest) == (0, smallest_feasible(Mesh(ring.vertices, ring.faces)))


def test_bad_arguments_are_named():
    with pytest.raises(ValueError, match="outside"):
        shrunk_rings(SPHERE, 100, [10**6])
    with pytest.raises(ValueError, match="one per kept vertex"):
        shrunk_rings(SPHERE, 100, [1, 2], [3])

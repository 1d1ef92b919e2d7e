"""Thin tips stay: the cost of a collapse says little of them, since all their planes run along them."""

import numpy as np
import pytest
import trimesh

from haptic_glance.lod import metro, simplify
from haptic_glance.lod.errors import vertex_errors
from haptic_glance.mesh.mesh import Mesh

RADIUS = 0.3


def spiky_ball(length, width):
    """A ball of 81,920 faces with twelve cones, and the ids of their tips.

    length: of a cone, in radii of the ball; width: the angle in radians from its axis to its rim.
    """
    ball, axes = trimesh.creation.icosphere(6), trimesh.creation.icosphere(0).vertices
    angles = np.arccos(np.clip(ball.vertices @ axes.T, -1, 1))
    height = 1 + length * np.clip(1 - angles.min(axis=1) / width, 0, None)
    return Mesh(RADIUS * height[:, None] * ball.vertices, ball.faces), angles.argmin(axis=0)


@pytest.mark.parametrize(("length", "width", "faces"), [(2.0, 0.15, 300), (0.7, 0.08, 500)])
def test_no_tip_is_cut_by_more_than_a_thirtieth(length, width, faces):
    mesh, tips = spiky_ball(length, width)
    found = simplify(mesh, faces)
    assert len(found.faces) == faces
    assert vertex_errors(found, mesh)[tips].max() < RADIUS * length / 30
    assert metro(mesh, found)["mean"] < 0.01


def test_tips_give_way_where_the_target_leaves_too_few_faces_for_them():
    mesh, _ = spiky_ball(0.7, 0.08)
    assert len(simplify(mesh, 20).faces) == 20

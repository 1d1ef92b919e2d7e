"""Faces agree with their neighbours and closed surfaces face outwards, whatever came in."""

import numpy as np
import pytest
import trimesh

from haptic_glance.mesh import MeshError, clean
from haptic_glance.mesh.mesh import Mesh
from haptic_glance.mesh.repair import orient
from tests.shapes import mesh_of, together

BALL = trimesh.creation.icosphere(2)
SOUND = mesh_of(BALL)


def volume(mesh):
    a, b, c = mesh.vertices[mesh.faces].transpose(1, 0, 2)
    return np.einsum("ij,ij->i", a, np.cross(b, c)).sum() / 6


def test_a_sound_mesh_stays_as_it_is():
    mesh, notes = orient(SOUND)
    np.testing.assert_array_equal(mesh.faces, BALL.faces)
    assert notes == []


@pytest.mark.parametrize("share", [0.5, 0.8, 1.1])
def test_mixed_winding_is_made_one(share):
    faces = BALL.faces.copy()
    turned = np.random.default_rng(0).random(len(faces)) < share
    faces[turned] = faces[turned][:, ::-1]
    mesh, notes = orient(Mesh(BALL.vertices, faces))
    assert volume(mesh) == pytest.approx(volume(SOUND))
    assert notes == ["320 faces turned outwards"] if share > 1 else notes


def test_an_open_sheet_follows_its_majority():
    sheet = Mesh(BALL.vertices, BALL.faces[BALL.triangles_center[:, 2] > 0.3])
    faces = sheet.faces.copy()
    faces[:3] = faces[:3, ::-1]
    mesh, notes = orient(Mesh(sheet.vertices, faces))
    np.testing.assert_array_equal(np.sort(mesh.face_normals, axis=0), np.sort(sheet.face_normals, axis=0))
    assert notes == ["3 faces turned to agree with their neighbours"]


def bowl():
    """Most of a sphere, open above, away from the origin."""
    ball = trimesh.creation.icosphere(3)
    return Mesh(ball.vertices + [3.0, 0, 0], ball.faces[ball.triangles_center[:, 2] < 0.6])


@pytest.mark.parametrize("seed", range(2))
def test_an_open_part_without_a_majority_looks_away_from_its_middle(seed):
    """As it is after half of the faces were turned at random."""
    mesh = bowl()
    turned = np.random.default_rng(seed).random(len(mesh.faces)) < 0.5
    faces = np.where(turned[:, None], mesh.faces[:, ::-1], mesh.faces)
    oriented = orient(Mesh(mesh.vertices, faces))[0]
    assert np.einsum("ij,ij->i", oriented.face_normals, mesh.face_normals).min() > 0.99


def test_an_open_part_with_a_majority_stays_on_its_side():
    """The inside of a bowl, with a few faces astray, is still the inside."""
    mesh = bowl()
    faces = mesh.faces[:, ::-1].copy()
    faces[:9] = faces[:9, ::-1]
    oriented = orient(Mesh(mesh.vertices, faces))[0]
    assert np.einsum("ij,ij->i", oriented.face_normals, mesh.face_normals).max() < -0.99


def test_a_cavity_keeps_facing_inwards():
    hollow = together(SOUND, Mesh(BALL.vertices / 2, BALL.faces[:, ::-1]))
    mesh, notes = orient(hollow)
    assert notes == [] and volume(mesh) == pytest.approx(volume(hollow))
    inverted, _ = orient(Mesh(hollow.vertices, hollow.faces[:, ::-1]))
    assert volume(inverted) == pytest.approx(volume(hollow))


def test_an_inverted_part_beside_a_sound_one_is_turned_alone():
    pair = together(SOUND, Mesh(BALL.vertices + 5, BALL.faces[:, ::-1]))
    mesh, notes = orient(pair)
    assert notes == ["320 faces turned outwards"]
    assert volume(mesh) == pytest.approx(2 * volume(SOUND))


def test_neither_a_vertex_far_away_nor_a_large_part_decides_the_side_of_a_small_one():
    stray = np.vstack([BALL.vertices, [[1e12] * 3]])
    assert orient(Mesh(stray, BALL.faces))[1] == []
    grain = BALL.vertices * 1e-7 + [0.9, 1.5, 0.9]
    assert orient(together(SOUND, Mesh(grain, BALL.faces)))[1] == []
    notes = orient(together(SOUND, Mesh(grain, BALL.faces[:, ::-1])))[1]
    assert notes == ["320 faces turned outwards"]


def test_a_moebius_strip_stays_and_is_no_crash():
    steps = np.linspace(0, 2 * np.pi, 20, endpoint=False)
    middle = np.c_[np.cos(steps), np.sin(steps), 0 * steps]
    side = 0.2 * np.c_[np.cos(steps / 2) * np.cos(steps), np.cos(steps / 2) * np.sin(steps), np.sin(steps / 2)]
    vertices = np.vstack([middle + side, middle - side])
    faces = []
    for i in range(20):
        j = (i + 1) % 20
        a, b, c, d = i, j, i + 20, j + 20
        if j == 0:
            b, d = d, b
        faces += [(a, c, b), (b, c, d)]
    mesh, _ = orient(Mesh(vertices, np.array(faces)))
    assert len(mesh.faces) == 40


def test_parts_too_far_apart_to_be_seen_are_refused():
    with pytest.raises(MeshError, match="too small for its extent"):
        clean(together(SOUND, Mesh(BALL.vertices + 1000, BALL.faces)))

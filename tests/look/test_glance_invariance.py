"""A glance finds one answer for one surface, whatever its faces, and says which of its places are equally good."""

import numpy as np
import pytest
import trimesh

from haptic_glance.base.rng import rng
from haptic_glance.look.glance import samples_of_mesh, samples_of_points, standardised
from haptic_glance.look.points import detect, saliency
from haptic_glance.look.weights.weights import GLANCES
from haptic_glance.mesh import normalise
from haptic_glance.mesh.mesh import Mesh

from .conftest import as_mesh

TURN = trimesh.transformations.rotation_matrix(np.radians(37), [0, 0, 1])[:3, :3]


def animal() -> trimesh.Trimesh:
    """Bumpy, with a head on one side, so that no two places are alike."""
    ball = trimesh.creation.icosphere(4, radius=0.3)
    ball.vertices *= 1 + 0.15 * np.sin(9 * ball.vertices[:, [0]] + 1) * np.cos(7 * ball.vertices[:, [1]])
    head = trimesh.creation.icosphere(3, radius=0.12).apply_translation([0.33, 0.1, 0.22])
    return trimesh.util.concatenate([ball.apply_scale([1.3, 0.9, 1]), head])


SHAPES = {
    "animal": animal(),
    "box": trimesh.creation.box((0.8, 0.5, 0.3)).subdivide_to_size(0.1),
    "square_box": trimesh.creation.box((0.5, 0.5, 0.8)).subdivide_to_size(0.1),
    "cylinder": trimesh.creation.cylinder(0.2, 0.9),
}
CHANGES = {
    "permuted": lambda mesh: Mesh(mesh.vertices, rng(0, "order").permutation(mesh.faces)),
    "rolled": lambda mesh: Mesh(mesh.vertices, np.roll(mesh.faces, 1, axis=1)),
    "subdivided": lambda mesh: Mesh(*trimesh.remesh.subdivide(mesh.vertices, mesh.faces)),
    "turned": lambda mesh: Mesh(mesh.vertices @ TURN.T, mesh.faces),
    "mirrored": lambda mesh: Mesh(mesh.vertices * [-1, 1, 1], mesh.faces[:, ::-1]),
}


@pytest.mark.parametrize("change", CHANGES)
@pytest.mark.parametrize("shape", SHAPES)
def test_saliency_belongs_to_the_surface(shape, change):
    mesh = normalise(as_mesh(SHAPES[shape]))
    for method in GLANCES if shape != "cylinder" else ["glance"]:  # in any pose its rims are all alike
        found = saliency(CHANGES[change](mesh), method)[: len(mesh.vertices)]
        assert np.corrcoef(saliency(mesh, method), found)[0, 1] > 0.995, method


@pytest.mark.parametrize("change", ["permuted", "rolled", "turned", "mirrored"])
def test_the_first_places_are_found_again(change):
    mesh = normalise(as_mesh(animal()))
    assert detect(CHANGES[change](mesh), count=5).points.tolist() == detect(mesh, count=5).points.tolist()


def test_a_symmetric_object_has_a_symmetric_saliency():
    body = as_mesh(trimesh.creation.icosphere(3).apply_scale([0.5, 0.35, 0.25]))
    values = saliency(body)
    for flip in ([-1, 1, 1], [1, -1, 1]):
        same = np.linalg.norm(body.vertices[:, None] * flip - body.vertices, axis=2).argmin(axis=1)
        assert values[same] == pytest.approx(values, abs=0.01)


def test_samples_of_a_cloud_do_not_depend_on_its_order():
    points, ids = trimesh.sample.sample_surface(animal(), 4000, seed=0)
    normals, order = animal().face_normals[ids], rng(0, "order").permutation(len(points))
    one, other = (samples_of_points(points[k], normals[k]) for k in (slice(None), order))
    assert one.points == pytest.approx(other.points, abs=1e-9)
    for name, values in standardised(one).items():
        assert values == pytest.approx(standardised(other)[name], abs=1e-6), name


def test_equal_places_are_named_equivalent():
    corners = detect(as_mesh(trimesh.creation.box((0.8, 0.5, 0.3))), count=6)
    assert corners.ties is not None and corners.ties[:4].tolist() == [0, 0, 0, 0] and corners.ties[4] > 0
    ball = detect(as_mesh(trimesh.creation.uv_sphere(count=[33, 64])), count=4)
    assert ball.ties is not None and ball.ties.tolist() == [0, 0, 0, 0]
    halves = [trimesh.creation.icosphere(3).apply_translation([x, 0, 0]) for x in (-1.5, 1.5)]
    parts = detect(as_mesh(trimesh.util.concatenate(halves)), count=2)
    assert parts.ties is not None and parts.ties.tolist() == [0, 0]
    animals = detect(as_mesh(animal()), count=3)
    assert animals.ties is not None and animals.ties[0] == 0 and animals.ties[2] > 0
    assert detect(as_mesh(animal()), "random", 3).ties is None


@pytest.mark.filterwarnings("error")
def test_little_to_look_at_has_an_answer_without_a_warning():
    face = Mesh(np.array([[0.0, 0, 0], [1, 0, 0], [0, 1, 0]]), np.array([[0, 1, 2]]))
    plane = as_mesh(trimesh.creation.box((1, 1, 0)))
    for mesh in (face, plane, as_mesh(trimesh.creation.icosphere(2))):
        for method in GLANCES:
            found = detect(mesh, method, 2)
            assert len(found.points) == 2 and np.isfinite(found.saliency).all() and found.saliency.max() == 1
    points = rng(0, "cloud").normal(0, 0.2, (10, 3))
    samples = samples_of_points(points, points / np.linalg.norm(points, axis=1, keepdims=True))
    assert all(np.isfinite(values).all() for values in standardised(samples).values())


def test_samples_belong_to_the_surface():
    mesh = normalise(as_mesh(animal()))
    one = samples_of_mesh(mesh)
    for change in ("permuted", "subdivided"):
        other = samples_of_mesh(CHANGES[change](mesh))
        assert one.tree.query(other.points)[0].max() < 1e-6 and len(other.points) == len(one.points)

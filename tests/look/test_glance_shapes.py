"""The glance on shapes whose salient parts are known: one answer for one surface, and the reasons for it."""

import functools

import numpy as np
import pytest
import trimesh

from haptic_glance.base.rng import rng
from haptic_glance.look.glance import samples_of_mesh, samples_of_points, standardised
from haptic_glance.look.points import detect, saliency
from haptic_glance.look.points.reasons import contributions, reasons
from haptic_glance.look.weights.weights import GLANCES
from haptic_glance.mesh import normalise
from haptic_glance.mesh.mesh import Mesh
from tests.shapes import ball_mesh, mesh_of, raised_ball

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
}
CHANGES = {
    "permuted": lambda mesh: Mesh(mesh.vertices, np.roll(rng(0, "order").permutation(mesh.faces), 1, axis=1)),
    "subdivided": lambda mesh: Mesh(*trimesh.remesh.subdivide(mesh.vertices, mesh.faces)),
    "turned": lambda mesh: Mesh(mesh.vertices @ TURN.T, mesh.faces),
    "mirrored": lambda mesh: Mesh(mesh.vertices * [-1, 1, 1], mesh.faces[:, ::-1]),
}


@functools.cache
def shape(name):
    return normalise(mesh_of(SHAPES[name]))


@functools.cache
def unchanged(name, method):
    return detect(shape(name), method, 5)


@pytest.mark.parametrize(
    ("name", "change", "method"),
    [
        *[("animal", change, "glance") for change in CHANGES],
        ("animal", "turned", "glance_any_pose"),
        ("box", "subdivided", "glance_any_pose"),
        ("square_box", "turned", "glance"),  # of which no horizontal axis is longer
    ],
)
@pytest.mark.slow
def test_saliency_and_the_first_places_belong_to_the_surface(name, change, method):
    before, after = unchanged(name, method), detect(CHANGES[change](shape(name)), method, 5)
    assert np.corrcoef(before.saliency, after.saliency[: len(before.saliency)])[0, 1] > 0.995
    if name == "animal" and method == "glance" and change != "subdivided":
        assert after.points.tolist() == before.points.tolist()


def rack() -> Mesh:
    """Square rods as thick as a cell, between two sheets whose faces lie twice, once for each side."""
    rods = [trimesh.creation.box((0.01, 0.01, 0.6)).apply_translation([x, y, 0]) for x, y in np.ndindex(6, 4)]
    sheets = [trimesh.creation.box((6.0, 4.0, 0.004)).apply_translation([2.5, 1.5, z]) for z in (-0.3, 0.3)]
    flag = Mesh([(0, 0, 0.4), (1, 0, 0.4), (1, 0, 1.1), (0, 0, 1.1)], [(0, 1, 2), (0, 2, 3), (2, 1, 0), (3, 2, 0)])
    solids = [solid.subdivide_to_size(0.4) for solid in rods + sheets]
    return normalise(mesh_of(trimesh.util.concatenate([*solids, trimesh.Trimesh(flag.vertices, flag.faces)])))


@pytest.mark.slow
@pytest.mark.parametrize(
    "mesh",
    [
        mesh_of(trimesh.creation.cylinder(0.3, 1)),
        mesh_of(trimesh.creation.box((1, 0.6, 0.3)).subdivide_to_size(0.2)),
        rack(),
    ],
    ids=["cylinder", "box", "rack"],
)
def test_rounding_changes_neither_saliency_nor_a_place(mesh):
    faces = np.roll(rng(0, "order").permutation(mesh.faces), 1, axis=1)
    before = detect(mesh, "glance", 10)
    for other in (Mesh(mesh.vertices, faces), Mesh(mesh.vertices * 1e-3 + [3, 2, 1], faces)):
        after = detect(other, "glance", 10)
        np.testing.assert_allclose(after.saliency, before.saliency, atol=2e-6)  # saliency has six digits
        assert after.points.tolist() == before.points.tolist()


@pytest.mark.slow
def test_only_the_glance_for_any_pose_ignores_the_pose():
    head = trimesh.creation.icosphere(3, radius=0.15).apply_translation([0.3, 0, 0.3])
    body = trimesh.util.concatenate([trimesh.creation.box((0.7, 0.3, 0.4)).subdivide_to_size(0.05), head])
    turned = body.vertices @ trimesh.transformations.rotation_matrix(2.0, [1, 2, 3])[:3, :3].T
    agreement = {}
    for method in GLANCES:
        values = [saliency(Mesh(vertices, body.faces), method) for vertices in (body.vertices, turned)]
        agreement[method] = np.corrcoef(*values)[0, 1]
    assert agreement["glance_any_pose"] > 0.85 and agreement["glance"] < 0.7, agreement  # samples are drawn anew


@pytest.mark.slow
def test_samples_do_not_depend_on_the_order_of_a_cloud_nor_on_the_triangles():
    points, ids = trimesh.sample.sample_surface(SHAPES["animal"], 2000, seed=0)
    normals, order = SHAPES["animal"].face_normals[ids], rng(0, "order").permutation(len(points))
    ours, theirs = (samples_of_points(points[k], normals[k]) for k in (slice(None), order))
    assert ours.points == pytest.approx(theirs.points, abs=1e-9)
    for name, values in standardised(ours).items():
        assert values == pytest.approx(standardised(theirs)[name], abs=1e-6), name
    ours = samples_of_mesh(shape("animal"))
    for change in ("permuted", "subdivided"):
        theirs = samples_of_mesh(CHANGES[change](shape("animal")))
        assert ours.tree.query(theirs.points)[0].max() < 1e-6 and len(theirs.points) == len(ours.points)


@pytest.mark.slow
def test_equal_places_are_named_equivalent():
    corners = detect(mesh_of(trimesh.creation.box((0.8, 0.5, 0.3))), count=6)
    assert corners.ties[:4].tolist() == [0, 0, 0, 0] and corners.ties[4] > 0
    ball = detect(mesh_of(trimesh.creation.uv_sphere(count=[33, 64])), count=4)
    assert ball.ties.tolist() == [0, 0, 0, 0]
    halves = [trimesh.creation.icosphere(3).apply_translation([x, 0, 0]) for x in (-1.5, 1.5)]
    assert detect(mesh_of(trimesh.util.concatenate(halves)), count=2).ties.tolist() == [0, 0]
    animals = unchanged("animal", "glance")
    assert animals.ties[0] == 0 and animals.ties[2] > 0
    assert detect(shape("animal"), "random", 3).ties is None


@pytest.fixture(scope="module")
def knob():
    return raised_ball([(1.0, 0, 0)], [0.15], [0.3])


def nearest(mesh, place):
    return np.array([np.linalg.norm(mesh.vertices - place, axis=1).argmin()])


@pytest.mark.parametrize("method", GLANCES)
@pytest.mark.slow
def test_the_parts_add_up_to_the_log_of_the_saliency(knob, method):
    some = np.arange(0, len(knob.vertices), 9)
    parts = contributions(knob, some, method)
    total = np.sum(list(parts.values()), axis=0)
    assert np.std(total - np.log(saliency(knob, method)[some])) < 0.05 * np.std(total)
    assert list(parts) == list(GLANCES[method])


def test_a_knob_is_found_for_its_shape_and_a_hollow_counts_against_a_place(knob):
    words = reasons(contributions(knob, nearest(knob, (1.3, 0, 0))))[0]
    assert "bulges out" in dict(words) and [amount for _, amount in words] == sorted(dict(words).values(), reverse=True)
    dent = raised_ball([(1.0, 0, 0)], [0.2], [-0.3])
    parts = contributions(dent, nearest(dent, (0.7, 0, 0)))
    assert parts["convexity"] < 0 and "a hollow" not in dict(reasons(parts, count=len(parts))[0])
    assert dict(reasons(parts, against=True)[0])["a hollow"] == pytest.approx(parts["convexity"][0])
    assert reasons({"below": np.array([0.5])}) == [[("hidden from below", 0.5)]]  # a feature of negative weight
    assert reasons({"below": np.array([-0.5])}, against=True) == [[("seen from below", -0.5)]]


@pytest.mark.slow
def test_the_axis_that_points_up_decides_what_is_high(knob):
    top = nearest(knob, (0, 0, 1.0))
    turned = Mesh(knob.vertices[:, [1, 2, 0]], knob.faces)  # what was z is y now
    ours, theirs = contributions(knob, top), contributions(turned, top, up="y")
    assert ours["rank"][0] == pytest.approx(theirs["rank"][0], abs=0.02)
    assert contributions(turned, top)["rank"][0] < ours["rank"][0] - 0.3
    with pytest.raises(ValueError, match="glance_any_pose"):
        contributions(knob, top, "itti")


def test_a_stray_part_far_away_needs_no_picture_of_its_distance():
    ball, far = ball_mesh(), [[1e6, 0, 0], [1e6, 0.01, 0], [1e6, 0, 0.01]]
    count = len(ball.vertices)
    stray = Mesh(np.r_[ball.vertices, far], np.r_[ball.faces, [[count, count + 1, count + 2]]])
    with pytest.warns(UserWarning, match="stray parts far from the object"):
        values = saliency(stray)
    assert np.isfinite(values).all() and values.max() == 1

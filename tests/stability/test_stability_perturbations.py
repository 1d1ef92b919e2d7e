"""Every perturbation does what it says, takes its places along, and changes nothing where it should not."""

from collections import defaultdict

import numpy as np
import pytest
import trimesh

from haptic_glance.base.rng import rng
from haptic_glance.disturb import mesh as disturbed
from haptic_glance.disturb.objects import PERTURBATIONS
from haptic_glance.disturb.perturbed import Conditions
from haptic_glance.look.camera import Viewpoint
from haptic_glance.look.channels import CHANNELS
from haptic_glance.look.views import render
from haptic_glance.mesh import normalise, rotate_to_z_up
from haptic_glance.mesh.mesh import Mesh, Texture
from haptic_glance.mesh.rays import RayScene
from stages.stability.repeatability import corner_normals, maps_under_conditions, relit

SIZE = (120, 160)
MILD = defaultdict(lambda: 0.5, {
    "noise": 0.002, "remeshing": 0.05, "missing_faces": 0.1, "vertex_order": 1.0, "winding": 0.3, "turn": 20.0,
    "tilt": 20.0, "scale": 100.0, "light": 30.0, "background": 1.0, "background_left_in": 1.0, "scan": 180.0,
})  # fmt: skip
INVALID = {
    "noise": -0.1, "decimation": 1.5, "remeshing": 0.0, "missing_faces": 1.0, "vertex_order": 2.0, "winding": -0.5,
    "scale": 0.0, "light": 200.0, "background": 2.0, "background_left_in": -1.0, "paint": 1.5, "pattern": 2.0,
    "grey": -1.0, "clay": 2.0, "image_size": 0.0, "scan": 0.0,
}  # fmt: skip
WHERE_NOT_EVEN = ("decimation", "remeshing", "scan")  # the surface itself moves a little
STEPS = {"scale": (10, 100), "remeshing": (0.04, 0.08)}  # mild, harsh; else 0.2, 0.6

ORANGE, TEAL = (240, 120, 30), (20, 150, 190)


def apply(name, mesh, severity, seed=0):
    if name in ("grey", "clay"):  # they need colours to take away
        mesh = Mesh(mesh.vertices, mesh.faces, np.where(mesh.vertices[:, :1] > 0, ORANGE, TEAL).astype(np.uint8))
    return PERTURBATIONS[name].apply(mesh, severity, rng(seed, "test"))


@pytest.fixture(scope="module")
def pear():
    """Without symmetry about a level plane: 642 vertices."""
    shape = trimesh.creation.icosphere(subdivisions=3)
    vertices = shape.vertices * (1 + 0.35 * shape.vertices[:, 2:] + 0.2 * shape.vertices[:, :1] ** 2)
    return normalise(Mesh(vertices, shape.faces))


@pytest.mark.parametrize("name", PERTURBATIONS)
@pytest.mark.slow
def test_the_original_stays_equal_generators_give_the_same_and_places_lie_on_it(name, pear):
    before = pear.vertices.copy(), pear.faces.copy()
    first, second = apply(name, pear, MILD[name]), apply(name, pear, MILD[name])
    assert np.array_equal(first.mesh.vertices, second.mesh.vertices) and np.array_equal(
        first.mesh.faces, second.mesh.faces
    )
    assert np.array_equal(pear.vertices, before[0]) and np.array_equal(pear.faces, before[1])
    places = first.original_positions  # found along a ray from the centre, since the pear is star-shaped
    length = np.linalg.norm(places, axis=1)
    hits = RayScene(pear).cast(np.zeros_like(places), places / length[:, None])
    tolerance = 0.03 if name in WHERE_NOT_EVEN else 1e-6
    assert np.abs(hits.distance - length).max() < tolerance


@pytest.mark.parametrize("name", sorted(set(PERTURBATIONS) - {"remeshing", "background_left_in", "scan"}))
def test_the_unharmed_severity_changes_nothing(name, pear):
    perturbed = apply(name, pear, PERTURBATIONS[name].unharmed)
    assert np.allclose(perturbed.mesh.vertices, pear.vertices) and np.array_equal(perturbed.mesh.faces, pear.faces)
    assert perturbed.conditions == Conditions()
    painted = name in ("grey", "clay") and {tuple(color) for color in perturbed.mesh.colors.tolist()} == {ORANGE, TEAL}
    assert perturbed.mesh.colors is None or painted or (perturbed.mesh.colors == 204).all()


@pytest.mark.parametrize("name", sorted(set(PERTURBATIONS) - {"scan"}))  # of which the next test speaks
def test_harsher_of_the_same_kind_goes_farther(name, pear):
    """What severity counts grows with it, and the mild change is part of the harsh one."""
    mild, harsh = (apply(name, pear, s) for s in STEPS.get(name, (0.2, 0.6)))
    if name in ("decimation", "image_size"):
        mild, harsh = harsh, mild
    measure = {
        "decimation": lambda p: -len(p.mesh.faces),
        "remeshing": lambda p: -len(p.mesh.faces),
        "missing_faces": lambda p: -len(p.mesh.faces),
        "vertex_order": lambda p: (p.mesh.vertices != pear.vertices).any(axis=1).sum(),
        "winding": lambda p: (p.mesh.faces != pear.faces).any(axis=1).sum(),
        "scale": lambda p: p.mesh.diagonal,
        "light": lambda p: p.conditions.light,
        "background": lambda p: p.conditions.background,
        "background_left_in": lambda p: p.conditions.background,
        "paint": lambda p: np.ptp(p.mesh.colors, axis=1).max(),
        "pattern": lambda p: np.ptp(p.mesh.colors, axis=1).max(),
        "grey": lambda p: -float(np.ptp(p.mesh.colors, axis=1).max()),
        "clay": lambda p: -float(np.ptp(p.mesh.colors)),
        "image_size": lambda p: -p.conditions.rows,
    }.get(name, lambda p: np.linalg.norm(p.mesh.vertices - p.original_positions, axis=1).mean())
    assert measure(harsh) > measure(mild)


@pytest.mark.slow
def test_one_depth_camera_sees_one_side(pear):
    single, four = (apply("scan", pear, severity).mesh for severity in (360, 90))
    total = pear.face_areas.sum()
    assert 0.3 < single.face_areas.sum() / total < 0.6 < 0.75 < four.face_areas.sum() / total < 1.05
    outwards = np.einsum("ij,ij->i", four.face_normals, four.vertices[four.faces].mean(axis=1))
    assert (outwards > 0).mean() > 0.99


@pytest.mark.slow
@pytest.mark.parametrize("faces", [200, pytest.param(700, marks=pytest.mark.slow)])
def test_a_scanned_plate_may_have_a_ragged_border(faces, monkeypatch):
    monkeypatch.setattr(disturbed, "SIZE", (30, 40))
    monkeypatch.setattr(disturbed, "FACES", faces)
    corners = 0.35 * np.array([[-1.0, 0, -1], [1, 0, -1], [1, 0, 1], [-1, 0, 1]])
    plate = Mesh(corners, np.array([[0, 1, 2], [0, 2, 3]]))
    scanned = apply("scan", plate, 60).mesh
    assert len(scanned.faces) < 1000 and np.ptp(scanned.vertices[:, [0, 2]], axis=0) == pytest.approx(0.7, abs=0.1)


def test_noise_has_the_deviation_asked_for_and_tears_no_seam(pear):
    perturbed = apply("noise", pear, 0.01)
    assert (perturbed.mesh.vertices - pear.vertices).std() == pytest.approx(0.01 * pear.diagonal, rel=0.05)
    soup = Mesh(pear.vertices[pear.faces].reshape(-1, 3), np.arange(3 * len(pear.faces)).reshape(-1, 3))
    moved = apply("noise", soup, 0.01).mesh.vertices
    assert len(np.unique(moved, axis=0)) == len(pear.vertices)


def test_turn_keeps_heights_tilt_the_axis_vertex_order_the_surface_and_winding_turns_it_inside_out(pear):
    turned = apply("turn", pear, 90).mesh.vertices
    assert np.allclose(turned, pear.vertices[:, [1, 0, 2]] * [-1, 1, 1])
    assert np.allclose(apply("tilt", pear, 180).mesh.vertices[:, 2], -pear.vertices[:, 2])
    for name in ("turn", "tilt"):
        assert np.linalg.det(np.linalg.lstsq(pear.vertices, apply(name, pear, 33).mesh.vertices)[0]) == pytest.approx(1)
    reordered = apply("vertex_order", pear, 1.0).mesh
    assert not np.array_equal(reordered.faces, pear.faces)
    assert np.array_equal(reordered.vertices[reordered.faces], pear.vertices[pear.faces])
    assert np.allclose(apply("winding", pear, 1.0).mesh.vertex_normals, -pear.vertex_normals)


def test_missing_faces_are_missing_in_few_patches(pear):
    perturbed = apply("missing_faces", pear, 0.2)
    assert len(perturbed.mesh.faces) == len(pear.faces) - int(0.2 * len(pear.faces))
    counts = perturbed.mesh.edge_counts[1]
    assert 0 < (counts == 1).sum() < 0.1 * len(counts)  # lone faces would leave three open edges each
    assert len(np.unique(perturbed.mesh.faces)) == len(perturbed.mesh.vertices)


def test_remeshing_makes_edges_of_the_length_asked_for(pear):
    remeshed = apply("remeshing", pear, 0.08).mesh
    corners = remeshed.vertices[remeshed.faces]
    lengths = np.linalg.norm(corners - np.roll(corners, 1, axis=1), axis=2)
    assert np.median(lengths) == pytest.approx(0.08 * pear.diagonal, rel=0.2)
    assert lengths.std() / lengths.mean() < 0.3


def test_a_pattern_and_paint_have_two_colours_in_patches_over_what_was_there(pear):
    colors = apply("pattern", pear, 1.0).mesh.colors
    assert len(np.unique(colors, axis=0)) == 2
    ends = colors[np.stack(pear.adjacency.nonzero(), axis=1)]
    assert (ends[:, 0] == ends[:, 1]).all(axis=1).mean() > 0.7
    two = np.where(pear.vertices[:, 2:] > 0, 200, 100) * np.ones(3)
    painted = apply("paint", Mesh(pear.vertices, pear.faces, two.astype(np.uint8)), 1.0).mesh
    assert len(np.unique(painted.colors, axis=0)) == 2
    assert painted.colors[pear.vertices[:, 2] > 0].max() == 200


def test_grey_keeps_the_brightness_of_each_place_and_clay_none(pear):
    grey, clay = (apply(name, pear, 1.0).mesh.colors for name in ("grey", "clay"))
    assert np.array_equal(np.unique(grey), [120, 130]) and (np.ptp(grey, axis=1) == 0).all() and (clay == 204).all()
    with pytest.raises(ValueError, match="has no colours to take away: run it on a set with meshes.colours=own"):
        PERTURBATIONS["grey"].apply(pear, 1.0, rng(0, "test"))


@pytest.mark.parametrize("name", INVALID)
def test_a_severity_out_of_range_is_named(name, pear):
    with pytest.raises(ValueError, match="must lie in|leave no surface"):
        apply(name, pear, INVALID[name])


def test_light_at_no_angle_is_the_renderers_own_and_else_brightens_the_side_it_comes_from(pear):
    view = render(pear, Viewpoint(0, 0), SIZE, "raster")
    assert np.abs(relit(pear, view, 0.0, corner_normals(pear)).rgb.astype(int) - view.rgb).max() <= 1
    rgb = relit(pear, view, 60.0, corner_normals(pear)).rgb[..., 0]
    rows, columns = np.nonzero(view.mask)
    assert rows[rgb[rows, columns].argmax()] < rows.mean() and columns[rgb[rows, columns].argmax()] < columns.mean()
    assert (rgb[~view.mask] == view.rgb[~view.mask, 0]).all()


@pytest.mark.slow
def test_a_background_that_is_kept_out_changes_no_map(pear):
    plain, white = (
        maps_under_conditions(pear, tuple(CHANNELS), Conditions(background=b), SIZE).maps for b in (0.0, 1.0)
    )
    assert all(np.array_equal(plain[name], white[name]) for name in CHANNELS)


def test_a_background_left_in_changes_the_maps_and_smaller_images_give_smaller_ones(pear):
    black, white = (
        maps_under_conditions(pear, ("intensity", "edge"), Conditions(background=b, filled=False), SIZE).maps
        for b in (0.0, 1.0)
    )
    assert all(np.abs(black[name] - white[name]).max() > 0.05 for name in black)
    assert maps_under_conditions(pear, ("edge",), Conditions(rows=0.5), SIZE).size == (15, 20)
    assert maps_under_conditions(pear, (), Conditions(), SIZE) is None


@pytest.mark.parametrize("name", sorted(set(PERTURBATIONS) - {"scan", "remeshing"}))
def test_the_axis_that_points_up_and_the_paint_go_along(name, pear):
    """And the object turns about its own axis."""
    painted = Texture(np.zeros((len(pear.faces), 3, 2)), np.zeros(len(pear.faces), int), (np.full((1, 1, 4), 90),))
    lying = Mesh(pear.vertices[:, [0, 2, 1]] * [1, 1, -1], pear.faces, texture=painted, up="y")
    changed = PERTURBATIONS[name].apply(lying, MILD[name], rng(0, "test")).mesh
    upright = PERTURBATIONS[name].apply(rotate_to_z_up(lying), MILD[name], rng(0, "test")).mesh
    assert changed.up == "y" and (changed.texture is not None or changed.colors is not None)
    assert rotate_to_z_up(changed).vertices == pytest.approx(upright.vertices, abs=1e-6 if name != "noise" else 0.02)


def test_cameras_stand_around_z(pear):
    with pytest.raises(ValueError, match="is y up"):
        PERTURBATIONS["scan"].apply(Mesh(pear.vertices, pear.faces, up="y"), 180.0, rng(0, "test"))

"""Scans simulated on a table: the table goes, the object stays; a scan without a table stays whole."""

import numpy as np
import pytest
import trimesh
from scipy.spatial.transform import Rotation

from haptic_glance.mesh import remove_plane
from haptic_glance.mesh.mesh import Mesh, Texture
from stages.meshes.collect import prepare_mesh
from stages.meshes.sources import MeshFile

CELLS = 50  # of the table's grid, a side


def shapes():
    blob = trimesh.creation.icosphere(4)
    blob.vertices *= 1 + 0.3 * np.sin(3 * blob.vertices[:, :1]) * np.cos(2 * blob.vertices[:, 1:2])
    box = trimesh.creation.box((1.2, 1.2, 0.8))
    for _ in range(4):
        box = box.subdivide()
    lying = trimesh.creation.cylinder(0.2, 2.0, sections=60)
    for _ in range(2):
        lying = lying.subdivide()
    lying.apply_transform(trimesh.transformations.rotation_matrix(np.pi / 2, (1, 0, 0)))
    return {"blob": blob, "box": box, "lying": lying, "goblet": _goblet()}


def _goblet():
    """A cup on a thin foot, which a careless test takes for a table."""
    profile = [(0, 0), (0.5, 0), (0.5, 0.02), (0.1, 0.04), (0.1, 0.5), (0.5, 0.7), (0.5, 1.2), (0.45, 1.2), (0, 0.7)]
    goblet = trimesh.creation.revolve(np.array(profile), sections=60)
    for _ in range(2):
        goblet = goblet.subdivide()
    return goblet


SHAPES = shapes()


def scan(shape, noise=0.0, holes=0, bottom=True, table=2.0):
    """(Mesh, (m,) boolean: the object's own faces): on a table `table` times as wide, turned and shifted at random.

    noise: standard deviation, a share of the diagonal of it all.
    """
    draw = np.random.default_rng(0)
    vertices = SHAPES[shape].vertices - [0, 0, SHAPES[shape].vertices[:, 2].min()]
    faces = SHAPES[shape].faces
    if not bottom:
        flat = (vertices[faces][:, :, 2].max(axis=1) < 0.05) & (SHAPES[shape].face_normals[:, 2] < -0.5)
        faces = faces[~flat]
    mask = np.ones(len(faces), dtype=bool)
    if table:
        half = table * np.abs(vertices[:, :2]).max()
        x, y = np.meshgrid(np.linspace(-half, half, CELLS), np.linspace(-half, half, CELLS))
        ids = np.arange(CELLS**2).reshape(CELLS, CELLS)
        a, b, c, d = (part.ravel() for part in (ids[:-1, :-1], ids[:-1, 1:], ids[1:, :-1], ids[1:, 1:]))
        squares = np.concatenate([np.stack([a, b, c], axis=1), np.stack([b, d, c], axis=1)])
        faces = np.concatenate([faces, squares + len(vertices)])
        vertices = np.concatenate([vertices, np.stack([x.ravel(), y.ravel(), np.zeros(CELLS**2)], axis=1)])
        mask = np.r_[mask, np.zeros(len(squares), dtype=bool)]
    diagonal = np.linalg.norm(np.ptp(vertices, axis=0))
    for _ in range(holes):
        middle = vertices[faces].mean(axis=1)
        whole = np.linalg.norm(middle - middle[draw.integers(len(faces))], axis=1) > 0.04 * diagonal
        faces, mask = faces[whole], mask[whole]
    vertices = vertices + draw.normal(size=vertices.shape) * noise * diagonal
    turn = Rotation.random(random_state=0).as_matrix()
    return Mesh(vertices @ turn.T * 30 + draw.normal(size=3) * 100, faces), mask


def shares(mesh, of_object, left):
    """(share of the object's area that is left, share of the table's)."""
    kept = {corners.tobytes() for corners in left.vertices[left.faces]}
    still = np.array([corners.tobytes() in kept for corners in mesh.vertices[mesh.faces]])
    areas = mesh.face_areas
    return areas[still & of_object].sum() / areas[of_object].sum(), areas[still & ~of_object].sum() / areas[
        ~of_object
    ].sum()


@pytest.mark.parametrize(("shape", "bottom"), [("blob", True), ("box", False), ("lying", True), ("goblet", False)])
@pytest.mark.slow
def test_a_smooth_scan_loses_its_table_and_nothing_else(shape, bottom):
    mesh, mask = scan(shape, bottom=bottom)
    left = remove_plane(mesh)
    kept, table = shares(mesh, mask, left)
    assert kept > 0.995 and table == 0 and remove_plane(left) is left


@pytest.mark.slow
@pytest.mark.parametrize(
    ("shape", "noise", "least"), [("blob", 0.002, 0.95), ("box", 0.005, 0.9), ("lying", 0.005, 0.9)]
)
def test_a_rough_scan_with_holes_and_no_bottom_keeps_nine_tenths_and_more(shape, noise, least):
    mesh, mask = scan(shape, noise, holes=6, bottom=False)
    kept, table = shares(mesh, mask, remove_plane(mesh))
    assert kept > least and table < 0.01


def test_a_foot_thinner_than_the_noise_goes_with_the_table_and_the_rest_stays():
    mesh, mask = scan("goblet", 0.005, holes=6, bottom=False)
    kept, table = shares(mesh, mask, remove_plane(mesh))
    assert 0.75 < kept < 0.9 and table < 0.01


@pytest.mark.slow
@pytest.mark.parametrize(
    ("shape", "noise", "bottom"),
    [("goblet", 0, True), ("goblet", 0.003, False), ("box", 0.003, False), ("lying", 0, True)],
)
def test_a_scan_without_a_table_comes_back_as_it_is(shape, noise, bottom):
    mesh, _ = scan(shape, noise, holes=3, bottom=bottom, table=None)
    assert remove_plane(mesh) is mesh


def test_a_bare_table_and_one_hardly_larger_than_the_object_come_back_as_they_are():
    mesh, mask = scan("box")
    table = Mesh(mesh.vertices, mesh.faces[~mask])
    assert remove_plane(table) is table
    mesh, _ = scan("box", bottom=False, table=1.05)  # taken for the base of the object
    assert remove_plane(mesh) is mesh


def test_a_plane_through_slivers_alone_is_no_table():
    """A pleated sheet, whose faces all cross its middle but for some without area."""
    across, along = np.mgrid[:15, :15]
    vertices = np.stack([across / 2, along / 2, np.take([0.45, 0, -0.45, 0], across % 4)], axis=2).reshape(-1, 3)
    ids = 15 * across + along
    corners = ids[:-1, :-1].reshape(-1, 1)
    slivers = ids[1::2, :-2].reshape(-1, 1) + [0, 1, 2]
    pleated = Mesh(vertices, np.concatenate([corners + [0, 15, 16], corners + [0, 16, 1], slivers]))
    assert remove_plane(pleated) is pleated


def test_what_is_left_keeps_its_order_colours_and_texture():
    mesh, mask = scan("blob")
    colors = np.arange(3 * len(mesh.vertices)).reshape(-1, 3) % 256
    uv = np.random.default_rng(0).random((len(mesh.faces), 3, 2))
    texture = Texture(uv, np.zeros(len(mesh.faces)), (np.zeros((1, 1, 4)),))
    left = remove_plane(Mesh(mesh.vertices, mesh.faces, colors, texture))
    assert len(left.faces) == mask.sum()
    np.testing.assert_array_equal(left.vertices[left.faces], mesh.vertices[mesh.faces[mask]])
    np.testing.assert_array_equal(left.colors[left.faces], (colors[mesh.faces[mask]] % 256).astype(np.uint8))
    np.testing.assert_array_equal(left.texture.uv, uv[mask])
    assert len(np.unique(left.faces)) == len(left.vertices)


def test_the_same_scan_gives_the_same_mesh_whatever_was_asked_before():
    mesh, _ = scan("blob", 0.005)
    first = remove_plane(mesh)
    remove_plane(scan("box")[0], seed=3)
    np.testing.assert_array_equal(remove_plane(mesh).vertices, first.vertices)


def test_a_mesh_without_surface_is_named_and_a_single_face_comes_back():
    for faces in (np.zeros((0, 3), dtype=int), np.array([[0, 0, 1]])):
        with pytest.raises(ValueError, match="no surface"):
            remove_plane(Mesh(np.eye(3), faces))
    triangle = Mesh(np.eye(3), np.array([[0, 1, 2]]))
    assert remove_plane(triangle) is triangle


def test_the_stage_takes_the_table_out_on_request_and_says_so():
    mesh, mask = scan("box", bottom=False)
    content = trimesh.Trimesh(mesh.vertices, mesh.faces, process=False).export(file_type="ply")
    item = MeshFile("box", "box.ply", ".ply", lambda: content, "z", "m", "unknown")
    assert prepare_mesh(item)[1]["faces"] == len(mesh.faces)
    _, row = prepare_mesh(item, remove_table=True)
    assert row["faces"] == mask.sum() and f"plane removed with {(~mask).sum()} faces" in row["repairs"]

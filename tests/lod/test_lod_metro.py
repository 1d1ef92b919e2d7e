"""Metro against shapes whose distance is known."""

import numpy as np
import pymeshlab
import pytest
import trimesh

from haptic_glance.lod import metro, simplify
from haptic_glance.lod.errors import SurfaceIndex
from haptic_glance.mesh.mesh import Mesh

BALL = trimesh.creation.icosphere(subdivisions=4, radius=0.5)
SPHERE = Mesh(BALL.vertices, BALL.faces)


def square(height=0.0, side=1.0):
    corners = np.array([[0, 0, height], [side, 0, height], [side, side, height], [0, side, height]])
    return Mesh(corners, [[0, 1, 2], [0, 2, 3]])


def test_distance_to_itself_is_zero():
    assert all(value < 1e-15 for value in metro(SPHERE, SPHERE, 2000).values())


def test_parallel_planes_are_their_distance_apart():
    found = metro(square(), square(0.25), 500)
    assert found == pytest.approx(dict.fromkeys(("mean", "rms", "max"), 0.25 / np.sqrt(2)), rel=1e-12)


def test_concentric_spheres_are_their_offset_apart():
    found = metro(SPHERE, Mesh(1.1 * SPHERE.vertices, SPHERE.faces), 3000)
    assert found == pytest.approx(dict.fromkeys(("mean", "rms", "max"), 0.05 / SPHERE.diagonal), rel=0.01)


def test_moved_cube_has_the_known_mean_and_maximum():
    # A unit cube moved by t along x: outside points are t away over the two x faces; the four sides touch but for a
    # strip of width t, whose points are 0 to t from the other's edge.
    cube, shift = trimesh.creation.box(), 0.2
    a = Mesh(cube.vertices, cube.faces)
    found = metro(a, Mesh(a.vertices + [shift, 0, 0], a.faces), 20_000)
    outside = shift * 1 + 4 * shift * shift / 2
    # The x face left inside the other cube is nearest to that cube's x face, but for a boundary where a side is nearer.
    inside = shift - 4 * shift**2 / 2 + 8 * shift**3 / 6
    assert found["max"] == pytest.approx(shift / np.sqrt(3), rel=1e-9)
    assert found["mean"] == pytest.approx((outside + inside) / 6 / np.sqrt(3), rel=0.02)


def test_larger_of_both_directions_counts():
    # All of the small square lies on the large one, not the other way round: the far corner is sqrt(2) / 2 away.
    small, large = square(side=0.5), square()
    assert metro(large, small, 500)["max"] == pytest.approx(0.5, rel=1e-12)
    assert metro(small, large, 500)["max"] == pytest.approx(1.0, rel=1e-12)
    for name in ("mean", "rms"):
        assert metro(small, large, 500)[name] == pytest.approx(2 * metro(large, small, 500)[name], rel=0.1)
        assert metro(large, small, 500)[name] > 0.1


def test_scale_position_and_vertex_order_do_not_matter():
    simple = simplify(SPHERE, 300)
    value = metro(SPHERE, simple, 1000)
    moved = [Mesh(3 * m.vertices + [1, 2, 3], m.faces) for m in (SPHERE, simple)]
    assert metro(*moved, 1000) == pytest.approx(value, rel=1e-9)
    order = np.random.default_rng(1).permutation(len(simple.vertices))
    shuffled = Mesh(simple.vertices[np.argsort(order)], order[simple.faces])
    assert metro(SPHERE, shuffled, 1000) == pytest.approx(value, rel=1e-12)


def test_seed_decides_and_samples_narrow_the_error():
    simple = simplify(SPHERE, 200)
    assert metro(SPHERE, simple, 500, seed=3) == metro(SPHERE, simple, 500, seed=3)
    spread = [np.std([metro(SPHERE, simple, k, seed)["mean"] for seed in range(6)]) for k in (100, 10_000)]
    assert spread[1] < spread[0]


def test_agrees_with_pymeshlab_within_sampling_error():
    simple = simplify(SPHERE, 200)
    theirs = []
    for sampled, target in ((0, 1), (1, 0)):
        work = pymeshlab.MeshSet(verbose=False)
        for mesh in (SPHERE, simple):
            work.add_mesh(pymeshlab.Mesh(mesh.vertices, mesh.faces))
        theirs.append(
            work.apply_filter(
                "get_hausdorff_distance", sampledmesh=sampled, targetmesh=target, savesample=False, samplevert=False,
                sampleedge=False, samplefauxedge=False, sampleface=True, samplenum=20_000,
                maxdist=pymeshlab.PercentageValue(50),
            )
        )  # fmt: skip
    found = metro(SPHERE, simple, 20_000)
    for ours, name in (("mean", "mean"), ("rms", "RMS")):
        assert found[ours] * SPHERE.diagonal == pytest.approx(max(t[name] for t in theirs), rel=0.02)
    assert found["max"] * SPHERE.diagonal >= 0.95 * max(t["max"] for t in theirs)


def test_samples_are_even_by_area():
    mesh = Mesh(np.r_[square().vertices, square(1, 3).vertices], np.r_[square().faces, square().faces + 4])
    points = SurfaceIndex(mesh).sample(1000, np.random.default_rng(0))[0]
    assert (points[:, 2] == 0).sum() == pytest.approx(100, abs=1)
    upper = points[points[:, 2] == 1]
    assert (upper[:, :2].mean(axis=0) == pytest.approx(1.5, abs=0.1)) and upper.max() <= 3


def test_bad_arguments_are_named():
    with pytest.raises(ValueError, match="samples"):
        metro(SPHERE, SPHERE, 0)
    with pytest.raises(ValueError, match="area"):
        metro(SPHERE, Mesh(np.zeros((3, 3)), [[0, 1, 2]]))

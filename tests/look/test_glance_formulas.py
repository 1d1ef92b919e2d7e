"""Each number of the glance against its formula, worked out another way: dense matrices, all pairs, direct sums."""

from dataclasses import replace

import numpy as np
import pytest
import trimesh
from scipy.spatial import KDTree

from haptic_glance.base.jit import interpreted
from haptic_glance.look.glance import FEATURES, Samples, cells, samples_of_mesh, standardised
from haptic_glance.look.glance.cells import cut, visibility
from haptic_glance.look.glance.draw import denoised
from haptic_glance.look.glance.features import features, fullness, relief, symmetry
from haptic_glance.look.glance.samples import averaging, nearest, object_axes
from haptic_glance.look.weights.weights import GLANCES
from haptic_glance.mesh.mesh import unit
from tests.shapes import mesh_of

TYPICAL = {  # deviation of each feature, from 33 objects: the published weights were learned with it
    "rank": 0.29, "middle": 0.31, "upward": 0.53, "upward_high": 0.098, "seen": 0.11, "above": 0.16,
    "above_high": 0.047, "below": 0.15, "log_below": 1.0, "log_side": 0.7, "convexity": 0.12, "detail": 0.055,
    "relief": 0.065, "fullness_0.12": 0.23, "fullness_0.24": 0.27, "distance": 0.096, "distance_squared": 0.054,
    "outward": 0.49, "off_plane": 0.03, "on_plane": 0.2,
}  # fmt: skip
AXES = np.array([[0.8, 0.6, 0], [-0.6, 0.8, 0], [0, 0, 1]])


def bean() -> trimesh.Trimesh:
    """Round, bent and bumpy, with no symmetry but y = 0 before its turn about the vertical."""
    shape = trimesh.creation.icosphere(5, radius=0.3)
    x, y, z = shape.vertices.T
    shape.vertices = np.c_[1.4 * x, 0.7 * y, z + 1.5 * x**2 + 0.05 * np.sin(20 * x) * np.cos(15 * y)]
    shape.vertices = shape.vertices @ AXES
    return shape


def sized(samples):
    """(s, 3): the points from their centroid, along the axes of the object, over 3.5 times their deviation."""
    local = (samples.points - samples.shares @ samples.points) @ samples.axes.T
    return local / (3.5 * np.sqrt(samples.shares @ (local**2).sum(axis=1)))


def spacing_of(samples):
    return np.sqrt((samples.areas**2).sum() / samples.areas.sum())


@pytest.fixture(scope="module")
def few() -> Samples:
    return samples_of_mesh(mesh_of(bean()), 400)


@pytest.fixture(scope="module")
def dense(few):
    """(s, s): the matrix of the averages."""
    squared = ((few.points[:, None] - few.points[None]) ** 2).sum(axis=2)
    spacing = spacing_of(few)
    side = np.clip((few.normals @ few.normals.T + 0.2) / 0.4, 0, 1)
    weight = np.exp(-squared / (1.4 * spacing) ** 2) * side * (squared <= (2.5 * spacing) ** 2)
    np.fill_diagonal(weight, 1)
    weight *= few.areas
    return weight / weight.sum(axis=1, keepdims=True)


@pytest.mark.slow
def test_an_average_weighs_near_points_of_its_side_by_their_area(few, dense):
    assert few.average.toarray() == pytest.approx(dense, abs=1e-12)
    values, spacing = few.points, spacing_of(few)
    steps = np.linalg.matrix_power(dense, 7)  # 2.6^2 = 6.76
    assert few.smoothed(values, 2.6 * spacing) == pytest.approx(steps @ values, abs=1e-12)


@pytest.mark.slow
@pytest.mark.parametrize("stray", [0, 1e9])  # in units of the reach: more cubes than have keys of their own
def test_an_average_is_that_of_all_pairs_however_many_are_near(stray):
    random = np.random.default_rng(0)
    points, areas = random.random((300, 3)) * 1.5, random.random(300)  # half of all pairs lie within the reach
    points[7] += stray
    normals = unit(random.normal(size=(300, 3)))
    normals[5] = 0  # of faces that cancel out
    squared = ((points[:, None] - points[None]) ** 2).sum(axis=2)
    weight = np.exp(-squared / 0.7**2) * np.clip((normals @ normals.T + 0.2) / 0.4, 0, 1) * (squared <= 1)
    np.fill_diagonal(weight, 1)
    expected = weight * areas / (weight * areas).sum(axis=1, keepdims=True)
    operator = averaging(points, normals, areas, reach=1.0, width=0.7, sides=(-0.2, 0.2))
    assert operator.toarray() == pytest.approx(expected, abs=1e-12) and operator.nnz > 40 * 300


def test_relief_is_how_far_a_point_stands_out_of_one_and_of_six_averages(few, dense):
    spacing = spacing_of(few)
    fine, coarse = (
        np.einsum("ij,ij->i", few.normals, few.points - np.linalg.matrix_power(dense, step) @ few.points)
        / (np.sqrt(step) * spacing)
        for step in (1, 6)
    )
    around = np.linalg.matrix_power(dense, 18) @ np.abs(coarse)
    for values, wanted in zip(relief(few), (fine, np.abs(fine - coarse), around), strict=True):
        assert values == pytest.approx(wanted, abs=1e-12)
    # on a rough surface the mean of this and of how far the point lies below the planes of its neighbours
    below = ((few.points[None] - few.points[:, None]) * few.normals).sum(axis=2)
    fine, coarse = (
        (out + (np.linalg.matrix_power(dense, step) * below).sum(axis=1) / (np.sqrt(step) * spacing)) / 2
        for step, out in ((1, fine), (6, coarse))
    )
    around = np.linalg.matrix_power(dense, 18) @ np.abs(coarse)
    for values, wanted in zip(relief(replace(few, rough=True)), (fine, np.abs(fine - coarse), around), strict=True):
        assert values == pytest.approx(wanted, abs=1e-12)


@pytest.mark.slow
def test_fullness_is_the_surface_in_a_gaussian_over_a_disc():
    samples = samples_of_mesh(mesh_of(bean()), 2000)
    local = sized(samples)
    squared = ((local[:, None] - local[None]) ** 2).sum(axis=2)
    for radius in (0.12, 0.24):
        within = np.exp(-squared / (2 * radius**2 / 5)) @ samples.shares
        off = fullness(samples, radius) - np.log(within / radius**2)  # points are counted in voxels
        assert np.abs(off).max() < 0.2 and abs(off.mean()) < 0.05


def test_stray_faces_far_away_neither_fill_the_memory_nor_change_the_fullness_of_the_object(few):
    points, areas = np.r_[few.points, 300 * np.eye(3)], np.r_[few.areas, [1e-12 * few.areas.sum()] * 3]
    stray = replace(few, points=points, areas=areas)  # whose voxels would be terabytes
    assert fullness(stray, 0.12)[:-3] == pytest.approx(fullness(few, 0.12), abs=0.02)


def directions():
    """(112, 3): seven rings of sixteen, every other one turned by half a step."""
    vectors = []
    for ring in range(7):
        height = 1 - (2 * ring + 1) / 7
        for k in range(16):
            turn = 2 * np.pi * (k + 0.5 * (ring % 2)) / 16
            across = np.sqrt(1 - height**2)
            vectors.append((across * np.cos(turn), across * np.sin(turn), height))
    return np.array(vectors)


def looked_at(samples):
    """(s,) of `visibility`, one direction and one point after the other."""
    spacing = spacing_of(samples)
    places = (samples.points - samples.shares @ samples.points) / spacing
    sums, counts, seen = np.zeros((3, len(places))), np.zeros(3), np.zeros(len(places))
    for eye in directions():
        right = unit(np.cross(eye, [0, 0, 1.0])[None])[0]
        across, up, toward = np.array([right, np.cross(eye, right), eye]) @ samples.axes
        pixels = np.floor(places @ np.array([across, up]).T / 1.4 + 0.5).astype(int)
        near, cosine, depth = places @ toward, samples.normals @ toward, {}
        for pixel, value in zip(map(tuple, pixels), near, strict=True):
            depth[pixel] = max(depth.get(pixel, -np.inf), value)
        front = [max(depth.get((x + i, y + j), -np.inf) for i in (-1, 0, 1) for j in (-1, 0, 1)) for x, y in pixels]
        shown = np.clip((2.6 - (np.array(front) - near) * np.maximum(cosine, 0.05)) / 0.8, 0, 1) * (cosine > 0)
        group = 0 if eye[2] < -0.5 else 1 if eye[2] < 0.5 else 2
        sums[group] += shown * cosine
        counts[group] += 1
        seen += shown
    below, side, above = sums / counts[:, None]
    return seen / 112, side, above, below


@pytest.mark.slow
def test_visibility_is_that_of_pictures_drawn_point_by_point(few, monkeypatch):
    monkeypatch.setattr(cells, "_seen", interpreted(cells._seen))  # which minds the bounds of a picture
    for values, wanted in zip(visibility(few), looked_at(few), strict=True):
        assert values == pytest.approx(wanted, abs=1e-9)


def test_a_mirror_plane_counts_by_the_correlation_of_both_halves(few):
    samples, (x, y, z) = few, sized(few).T
    radius = np.hypot(x, y)
    index = [
        np.clip(((values - low) / (high - low) * bins).astype(int), 0, bins - 1)
        for values, low, high, bins in (
            (np.arctan2(y, x), -np.pi, np.pi, 120), (radius, 0, radius.max(), 12),
            (z, z.min() - 1e-9, z.max() + 1e-9, 24),
        )
    ]  # fmt: skip
    amounts = np.zeros((120, 12, 24))
    np.add.at(amounts, tuple(index), samples.shares)
    for axis, mode in enumerate(("wrap", "symmetric", "symmetric")):  # a Gaussian of one bin, up to four bins away
        weights = np.exp(-(np.arange(-4, 5) ** 2) / 2)
        padded = np.pad(amounts, [(4, 4) if k == axis else (0, 0) for k in range(3)], mode=mode)
        parts = [np.take(padded, np.arange(k, k + amounts.shape[axis]), axis) for k in range(9)]
        amounts = np.tensordot(weights / weights.sum(), parts, 1)
    images = [amounts[(k - np.arange(120)) % 120] for k in range(120)]  # bin j of the image is bin k - j
    fits = np.exp(((np.array([(image * amounts).sum() for image in images]) / (amounts**2).sum()) - 1) / 0.1)
    share = fits / fits.sum()
    score = share @ fits - fits.mean()
    share = np.where(share > 0.1 * share.max(), share, 0)
    share /= share.sum()
    edges = -np.pi + (np.arange(120) + 1) * np.pi / 120  # half of the sum of the middles of bins j and k - j
    away = np.abs(np.outer(x, np.sin(edges)) - np.outer(y, np.cos(edges)))
    off, on = symmetry(samples)
    assert score > 0.1 and off == pytest.approx(score * (away @ share), abs=1e-9)
    assert on == pytest.approx(score * (np.exp(-((away / 0.05) ** 2)) @ share), abs=1e-9)


def test_rounding_moves_no_place_into_another_bin_and_a_symmetric_surface_stays_its_own_mirror_image():
    random = np.random.default_rng(0)
    quarter = np.radians(np.r_[3:90:3, 45, 45])  # on the walls between the bins
    turn = np.concatenate([quarter, np.pi - quarter, -quarter, quarter - np.pi])
    radius, height, areas = (np.tile(random.random(len(quarter)), 4) for _ in range(3))
    points = np.stack([radius * np.cos(turn), radius * np.sin(turn), height], axis=1)
    values = []
    for jitter in (0, 1e-14, -1e-14):
        moved = points * [1, 1 + jitter, 1] + jitter * random.normal(size=points.shape)
        values.append(symmetry(Samples(moved, unit(points), areas, np.eye(3))))
    assert values[0][1].max() > 0.1  # the planes of the axes are found
    assert np.ptp(values, axis=0) == pytest.approx(0, abs=1e-9)
    assert np.ptp(np.reshape(values[0], (2, 4, -1)), axis=1) == pytest.approx(0, abs=1e-9)


@pytest.mark.slow
def test_each_feature_is_its_formula():
    samples = samples_of_mesh(mesh_of(bean()), 3000)
    columns, (seen, side, above, below) = features(samples), visibility(samples)
    local = sized(samples)
    height, distance, normals = local[:, 2], np.linalg.norm(local, axis=1), samples.normals @ samples.axes.T
    rank = np.array([samples.shares @ ((height < h) + (height == h) / 2) for h in height])
    assert columns["rank"] == pytest.approx(rank, abs=0.02) and columns["rank"] == pytest.approx(
        rank, abs=0.006, rel=0.1
    )
    wanted = {
        "middle": np.sin(np.pi * columns["rank"]), "upward": normals[:, 2], "upward_high": height * normals[:, 2],
        "seen": seen, "above": above, "above_high": above * height, "below": below,
        "log_below": np.log(below + 0.02), "log_side": np.log(side + 0.01),
        "distance": distance, "distance_squared": (local**2).sum(axis=1),
        "outward": (normals * local / distance[:, None]).sum(axis=1),
    }  # fmt: skip
    names = dict(zip(("convexity", "detail", "relief"), relief(samples), strict=True))
    names |= dict(zip(("off_plane", "on_plane"), symmetry(samples), strict=True))
    names |= {f"fullness_{radius}": fullness(samples, radius) for radius in (0.12, 0.24)}
    assert {"rank", *wanted, *names} == set(columns) and list(columns) == list(FEATURES) == list(GLANCES["glance"])
    for name, values in (wanted | names).items():
        assert columns[name] == pytest.approx(values, abs=1e-12), name


@pytest.mark.slow
def test_a_feature_is_scaled_to_deviation_one_but_never_up_to_more_than_twice_a_typical_objects():
    for samples in (samples_of_mesh(mesh_of(trimesh.creation.icosphere(4, radius=0.5)), 2000),
                    samples_of_mesh(mesh_of(bean()), 2000)):  # fmt: skip
        scaled = standardised(samples)
        for name, values in features(samples).items():
            mean = samples.shares @ values
            deviation = np.sqrt(samples.shares @ (values - mean) ** 2)
            wanted = np.clip((values - mean) / max(deviation, 0.5 * TYPICAL[name]), -4, 4)
            assert scaled[name] == pytest.approx(wanted, abs=1e-9), name


def test_pieces_of_triangles_fill_their_cells_and_no_others():
    corners = np.random.default_rng(3).uniform(-2.5, 2.5, (12, 3, 3))
    pieces = cut(corners)
    face, places, area, middles = pieces[:, 0].astype(int), pieces[:, 1:4], pieces[:, 4], pieces[:, 5:]
    assert len(np.unique(pieces[:, :4], axis=0)) == len(pieces) and (area > 0).all()
    assert ((middles >= places) & (middles <= places + 1)).all()
    first, second = (corners[:, k] - corners[:, 0] for k in (1, 2))
    whole = np.linalg.norm(np.cross(first, second), axis=1) / 2
    assert np.bincount(face, area) == pytest.approx(whole)
    for axis in range(3):
        assert np.bincount(face, area * middles[:, axis]) == pytest.approx(whole * corners[:, :, axis].mean(axis=1))


def test_the_longest_horizontal_axis_comes_first_unless_none_is_longer():
    points = np.random.default_rng(0).normal(size=(500, 3)) * [3, 1, 5] @ AXES + [7, -4, 2]
    areas = np.random.default_rng(1).uniform(0.5, 2, 500)
    axes, middle = object_axes(points, areas, points)
    assert middle == pytest.approx(np.average(points, axis=0, weights=areas))
    moments = np.cov(points[:, :2].T, aweights=areas)
    assert abs(axes[0, :2] @ moments @ axes[1, :2]) < 1e-9 and axes[2].tolist() == [0, 0, 1]
    assert axes[0, :2] @ moments @ axes[0, :2] == pytest.approx(np.linalg.eigvalsh(moments)[1])
    cross, shift = np.array([[1.0, 0, 0], [-1, 0, 0], [0, 1, 0], [0, -1, 0]]), np.array([2.0, -1.0, 3.0])
    ends = np.array([[0.5, 0, 0], [1.2, 1.6, 9], [0, -1.9, 0]]) + shift
    for ratio, first in ((0.997, (0.6, 0.8)), (1.003, (0.6, 0.8)), (0.98, (1, 0)), (1.02, (0, 1))):
        axes, _ = object_axes(cross * [1, ratio, 1] + shift, np.ones(4), ends)  # squared lengths 0.6 % or 4 % apart
        assert axes @ axes.T == pytest.approx(np.eye(3), abs=1e-12) and np.abs(axes[0, :2]) == pytest.approx(first)


def test_a_value_between_points_is_the_mean_of_ten_by_distance_area_and_side(few):
    places = few.points[:40] + 0.3 * few.spacing * unit(np.random.default_rng(0).normal(size=(40, 3)))
    normals = unit(few.normals[:40] + 0.5 * np.random.default_rng(1).normal(size=(40, 3)))
    ids, weights = few.interpolation(places, normals)
    for place, normal, neighbours, parts in zip(places, normals, ids, weights, strict=True):
        away = np.linalg.norm(few.points - place, axis=1)
        near = np.argsort(away)[:10]
        assert neighbours.tolist() == near.tolist()
        facing = np.maximum(few.normals[near] @ normal + 0.3, 0.01)
        wanted = facing * few.areas[near] * np.exp(-((away[near] / (0.75 * few.spacing)) ** 2))
        assert parts == pytest.approx(wanted / wanted.sum(), abs=1e-12)


def test_points_as_far_as_the_next_one_are_left_out_unless_all_are():
    grid = KDTree([(x, y, 0) for x in range(-2, 3) for y in range(-2, 3)])
    distances, _ = nearest(grid, np.array([[0.0, 0, 0], [0.5, 0.5, 0]]), 3)
    assert distances.tolist() == [[0, np.inf, np.inf], [0.5**0.5] * 3]
    assert np.isfinite(nearest(grid, np.zeros((1, 3)), 25)[0]).all()


def rough(few):
    """The few samples, with normals so rough that they are moved."""
    random = np.random.default_rng(5)
    moved = few.points + 0.4 * few.spacing * random.normal(size=(len(few.points), 1)) * few.normals
    turned = unit(few.normals + 0.5 * random.normal(size=few.normals.shape))
    return Samples(moved, turned, few.areas, few.axes)


def test_a_rough_point_moves_onto_the_paraboloid_of_its_neighbours(few):
    samples = rough(few)
    smooth, start = denoised(samples), unit(samples.average @ unit(samples.average @ samples.normals))
    checked = 0
    for k in range(0, len(samples.points), 4):
        away = np.linalg.norm(samples.points - samples.points[k], axis=1) / samples.spacing
        near = np.argsort(away)[:32]
        frame = np.linalg.svd(start[k][None])[2]
        right, up = frame[1:]
        offsets = (samples.points[near] - samples.points[k]) / samples.spacing
        x, y, z = offsets @ right, offsets @ up, offsets @ start[k]
        weight = np.exp(-(away[near] ** 2) / (2 * 2.5**2)) * np.sqrt(samples.areas[near]) / samples.spacing
        weight *= start[near] @ start[k] > 0.2
        terms = np.stack([np.ones(32), x, y, x * x, x * y, y * y], axis=1)
        step, along, aside = np.linalg.lstsq(terms * weight[:, None], z * weight)[0][:3]
        held_back = abs(step) > 1.9 or max(abs(along), abs(aside)) > 0.6
        if not held_back and (weight > 0.1).sum() >= 15:
            checked += 1
            assert smooth.points[k] == pytest.approx(samples.points[k] + step * samples.spacing * start[k], abs=1e-4)
            assert smooth.normals[k] == pytest.approx(unit((start[k] - along * right - aside * up)[None])[0], abs=1e-3)
    assert checked > 60 and smooth.areas is samples.areas
    assert np.linalg.norm(smooth.normals, axis=1) == pytest.approx(1)

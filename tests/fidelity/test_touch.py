"""Chapter 4: imprints, their similarity and features, contours and sequences."""

from pathlib import Path

import numpy as np
import pytest
import pywt
import trimesh
from scipy import ndimage, stats

from haptic_glance.know.features import FEATURES, SIMILARITY_THRESHOLD, confusable, features, similarity
from haptic_glance.know.joined_touches import concatenate_touches, draw_combinations, touch_map
from haptic_glance.lod import simplify
from haptic_glance.mesh.mesh import Mesh
from haptic_glance.touch.distances import adaptive_distances, distances
from haptic_glance.touch.follow import follow
from haptic_glance.touch.press import press_many
from haptic_glance.touch.quasi_tangent import quasi_tangent
from haptic_glance.touch.surface import sensor_axes, sensor_normals
from stages.engine.rows import read_rows
from stages.imprints.imprints import FaceCentres
from stages.sequences.sequence_trials import sequence_features

ROOT = Path(__file__).parents[2]
CELLS, PITCH = (16, 16), 0.01


def spread(mesh, count):
    return np.linspace(0, len(mesh.vertices) - 1, count).astype(int)


@pytest.fixture(scope="module")
def imprints(dromedary):
    return press_many(dromedary, spread(dromedary, 40), CELLS, PITCH)


def test_cross_correlation(imprints, agreement):
    """T4.2.3.3: the normalised cross-correlation of two imprints, and those removed at 0.85."""
    images = imprints
    literal = np.empty((len(images), len(images)))
    for i, a in enumerate(images):
        for j, b in enumerate(images):
            first, second = a - a.mean(dtype=float), b - b.mean(dtype=float)
            literal[i, j] = (first * second).sum() / np.sqrt((first**2).sum() * (second**2).sum())
    matrix, labels = similarity(images), np.arange(len(images)) % 2
    removed = [any(literal[i, j] >= 0.85 and labels[i] != labels[j] for j in range(len(images)))
               for i in range(len(images))]  # fmt: skip
    assert SIMILARITY_THRESHOLD == 0.85 and (confusable(matrix, labels) == removed).all() and any(removed)
    agreement("difference", np.abs(matrix - literal).max())


def test_features(dromedary, agreement):
    """T4.2.3.4: of three levels norm, mean, deviation, entropy of each band; of the imprint five numbers."""
    images = press_many(dromedary, spread(dromedary, 6), CELLS, PITCH).astype(float)
    literal = []
    for image in images:
        row, levels = [], pywt.wavedec2(image, "db2", mode="symmetric", level=3)
        for bands in levels[:0:-1]:
            for band in bands:
                share = band**2 / (band**2).sum()
                entropy = -(share[share > 0] * np.log(share[share > 0])).sum()
                row += [np.sqrt((band**2).sum()), band.mean(), band.std(), entropy]
        centre = np.array(ndimage.center_of_mass(image)) / (np.array(image.shape) - 1)
        literal.append([*row, image.max(), image.mean(), image.std(), *centre])
    vectors = features(images)
    assert vectors.shape[1] == len(FEATURES) == 3 * 3 * 4 + 5
    agreement("difference", np.abs(vectors - literal).max())


def test_several_touches(imprints, agreement):
    """T4.2.3.5: a map of two dimensions, three coordinates, and random others of the same object in one vector."""
    samples, places = features(imprints), np.random.default_rng(0).random((40, 3))
    labels = np.arange(40) // 10
    mapped = touch_map().fit(samples).transform(samples)
    five = np.column_stack([mapped, places])
    chosen = draw_combinations(labels, 3, np.random.default_rng(1))
    vectors = concatenate_touches(five, chosen)
    held = [
        mapped.shape == (40, 2),
        vectors.shape == (40, 15),
        all((vectors[k] == np.concatenate([five[touch] for touch in chosen[k]])).all() for k in range(40)),
        (labels[chosen] == labels[:, None]).all() and len(np.unique(chosen, axis=0)) > 20,
    ]
    agreement("settings", (sum(map(bool, held)), len(held)))


def test_quasi_tangent_plane(dromedary, agreement):
    """T4.2.3.1: the plane of the three closest neighbours; its normal is the cross product of P1P2 and P1P3."""
    mesh = dromedary
    vertices = np.arange(5, len(mesh.vertices), 997)
    _, axes = quasi_tangent(mesh, vertices)
    apart = []
    for vertex, axis in zip(vertices, axes[:, 2], strict=True):
        near = np.setdiff1d(mesh.faces[(mesh.faces == vertex).any(axis=1)], [vertex])
        order = np.argsort(np.linalg.norm(mesh.vertices[near] - mesh.vertices[vertex], axis=1))
        first, second, third = mesh.vertices[near[order[:3]]]
        normal = np.cross(second - first, third - first)
        apart.append(1 - abs(normal @ axis) / np.linalg.norm(normal))
    agreement("difference", max(apart))


def printed_distances(mesh, vertex, centres_of_faces):
    """T4.3.1: from each cell of the tangent plane along the normal, T [221], to the hit or the centre of its face."""
    faces = mesh.faces[(mesh.faces == vertex).any(axis=1)]
    corners = mesh.vertices[faces]
    normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    average = (normals / np.linalg.norm(normals, axis=1, keepdims=True)).mean(axis=0)
    normal = average / np.linalg.norm(average)
    right, up, _ = sensor_axes(normal[None])[0]
    corners = mesh.vertices[mesh.faces]
    first, second = corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]
    p = np.cross(-normal, second)
    determinant = np.einsum("ij,ij->i", first, p)
    inverse = np.divide(1, determinant, out=np.zeros_like(determinant), where=np.abs(determinant) > 1e-14)
    lengths = np.full(CELLS, np.inf)
    for i in range(CELLS[0]):
        for j in range(CELLS[1]):
            place = mesh.vertices[vertex] + PITCH * ((j - 7.5) * right + (7.5 - i) * up)
            t = place - corners[:, 0]
            u = np.einsum("ij,ij->i", t, p) * inverse
            q = np.cross(t, first)
            v, away = (q @ -normal) * inverse, np.einsum("ij,ij->i", second, q) * inverse
            hit = (inverse != 0) & (u >= 0) & (v >= 0) & (u + v <= 1) & (away >= 0)
            if hit.any():
                face = np.where(hit, away, np.inf).argmin()
                lengths[i, j] = (place - corners[face].mean(axis=0)) @ normal if centres_of_faces else away[face]
    return np.clip(lengths, -CELLS[0] * PITCH, CELLS[0] * PITCH)


def convex():
    """A ball of few faces, on which no cell of a tangent plane is inside but close to the place."""
    ball = trimesh.creation.icosphere(subdivisions=3, radius=0.5)
    return Mesh(ball.vertices, ball.faces)


def sensor_apart(surface, centres_of_faces):
    mesh = convex()
    vertices = [0, 17, 300]
    lengths = distances(surface(mesh), vertices, CELLS, PITCH)
    literal = np.stack([printed_distances(mesh, vertex, centres_of_faces) for vertex in vertices])
    outside = literal > 1e-6
    return lengths[outside], literal[outside]


def test_distances(agreement):
    """The distances to where the rays meet the surface."""
    lengths, literal = sensor_apart(lambda mesh: mesh, False)
    assert len(lengths) > 600
    agreement("difference", np.abs(lengths - literal).max())


def test_face_centres(agreement):
    """The distances to the centres of the faces, as T4.3.1 prints them."""
    lengths, literal = sensor_apart(FaceCentres, True)
    agreement("difference", np.abs(lengths - literal).max())


def test_hit_beside_face_centre(dromedary, agreement):
    """The imprints of the two, on a dromedary of 4,000 faces."""
    mesh = simplify(dromedary, 4000)
    hits, centres = (press_many(surface, spread(mesh, 40), CELLS, PITCH) for surface in (mesh, FaceCentres(mesh)))
    pairs = zip(hits, centres, strict=True)
    likeness = [np.corrcoef(a.ravel(), b.ravel())[0, 1] for a, b in pairs if a.any() and b.any()]
    agreement("r", float(np.mean(likeness)))


def test_smaller_array(dromedary, agreement):
    """T4.4.3: 32 x 32 cells, closer together where the array would intersect the object."""
    mesh, vertices = dromedary, spread(dromedary, 60)
    axes = sensor_axes(sensor_normals(mesh, vertices))
    pitches, lengths = adaptive_distances(mesh, mesh.vertices[vertices], axes)
    saddles = pitches < 0.01
    plain = distances(mesh, vertices, (32, 32), 0.01)
    held = [
        lengths.shape[1:] == (32, 32),
        saddles.any() and not saddles.all(),
        (plain[saddles].min(axis=(1, 2)) < 0).all(),
    ]
    agreement("settings", (sum(map(bool, held)), len(held)))


def test_contour(agreement):
    """T4.4.6: the section by the plane through the centre and two points, 25 places at equal distances; in units."""
    mesh = convex()
    points = mesh.vertices[[10, 200]] * [1, 1, 0.8]
    positions = follow(mesh, np.stack([np.zeros(3), *points])).positions
    normal = np.cross(*points)
    normal /= np.linalg.norm(normal)
    heights = mesh.vertices @ normal
    ends = []
    for face in mesh.faces:
        for a, b in zip(face, np.roll(face, -1), strict=True):
            if heights[a] * heights[b] < 0 and a < b:
                weight = heights[a] / (heights[a] - heights[b])
                ends.append((1 - weight) * mesh.vertices[a] + weight * mesh.vertices[b])
    across = np.stack([points[0] / np.linalg.norm(points[0]), np.cross(normal, points[0] / np.linalg.norm(points[0]))])
    curve = np.array(ends)
    curve = curve[np.argsort(np.arctan2(*(curve @ across.T).T[::-1]))]
    closed = np.concatenate([curve, curve[:1]])
    along = np.concatenate([[0], np.cumsum(np.linalg.norm(np.diff(closed, axis=0), axis=1))])

    def at(arc):
        return np.stack([np.interp(arc % along[-1], along, closed[:, axis]) for axis in range(3)], axis=1)

    starts = np.linspace(0, along[-1], 20001)
    start = starts[np.linalg.norm(at(starts) - positions[0], axis=1).argmin()]
    literal = at(start + along[-1] / 25 * np.arange(25))
    assert len(positions) == 25
    agreement("difference", float(np.linalg.norm(positions - literal, axis=1).max()))


def test_longest_curve_of_a_section(agreement):
    """T4.4.6: "the set of points belonging both to the object and the plane"; the share that is not followed."""
    rows = read_rows(ROOT / "reports/measurements/princeton_eight/contours.csv.gz")
    shares = rows[rows["metric"] == "share"]["value"]
    assert len(shares) == 24 * 2
    agreement("share", 100 * (1 - shares.mean()))


def test_series(agreement):
    """T4.4.9: rms, standard deviation and skewness of three levels of db2 wavelets and of the series itself."""
    values = np.random.default_rng(0).normal(size=(3, 25, 19)).cumsum(axis=1)
    literal = []
    for sample in values:
        row = []
        for series in sample.T:
            details = pywt.wavedec(series, "db2", mode="symmetric", level=3)[:0:-1]
            for band in (*details, series):
                row += [np.sqrt((band**2).mean()), band.std(), stats.skew(band)]
        literal.append(row)
    vectors = sequence_features(values)
    assert vectors.shape[1] == 19 * 4 * 3
    agreement("difference", np.abs(vectors - literal).max())

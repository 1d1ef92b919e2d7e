"""Which collapses are allowed, their order, cost and fit: against the definitions, worked out face by face."""

import numpy as np
import pytest
import trimesh

from haptic_glance.base import jit
from haptic_glance.base.jit import interpreted
from haptic_glance.lod import fast
from haptic_glance.lod.kernels import collapse, quadrics, refit
from haptic_glance.mesh.mesh import Mesh


def rough_ball(seed, subdivisions=1, noise=0.15):
    """A closed mesh with folds, slivers and, in places, vertices of three faces."""
    random, ball = np.random.default_rng(seed), trimesh.creation.icosphere(subdivisions)
    vertices, faces = [*(ball.vertices + random.normal(0, noise, ball.vertices.shape))], [*map(list, ball.faces)]
    for _ in range(12):
        a, b, c = faces.pop(random.integers(len(faces)))
        faces += [[a, b, len(vertices)], [b, c, len(vertices)], [c, a, len(vertices)]]
        vertices.append(sum(vertices[k] for k in (a, b, c)) / 3 + random.normal(0, 0.1, 3))
    return Mesh(np.array(vertices), np.array(faces))


def surface_of(mesh):
    return fast.half_edge_mesh(mesh, np.zeros(len(mesh.faces), dtype=bool), None)[0]


def normal(face, places):
    a, b, c = (places[k] for k in face)
    return np.cross(b - a, c - a)


def cosine(first, second):
    size = np.linalg.norm(first) * np.linalg.norm(second)
    return first @ second / size if size > 0 else 1.0


def quality(face, places):
    a, b, c = (places[k] for k in face)
    sides = sum(side @ side for side in (b - a, c - b, a - c))
    return 2 * np.sqrt(3) * np.linalg.norm(np.cross(b - a, c - a)) / sides


def neighbours(faces, vertex):
    return {k for face in faces if vertex in face for k in face} - {vertex}


def height(face, places):
    a, b, c = (places[k] for k in face)
    return np.linalg.norm(np.cross(b - a, c - a)) / np.sqrt(sum(side @ side for side in (b - a, c - b, a - c)))


def spoils(faces, before, v, other, place, turn, shape, fold, cut, thin):
    """Whether a move of vertex v to a place spoils a face around it that does not touch `other`."""
    after = before.copy()
    after[v] = place
    moved = [face for face in faces if v in face and other not in face]
    for face in moved:
        first, second = normal(face, before), normal(face, after)
        if cosine(first, second) < turn:
            return True
        if quality(face, after) < min(shape, quality(face, before) * (1 + 1e-12)):
            return True
        if height(face, after) < thin and np.linalg.norm(second) < np.linalg.norm(first):
            return True
        for beside in faces:
            if len({*face} & {*beside}) == 2 and (
                beside in moved or (v not in beside and cosine(first, second) < 0.98)
            ):
                folds = [cosine(normal(face, places), normal(beside, places)) < fold for places in (before, after)]
                if folds == [False, True]:
                    return True
    back = before[v] - place
    around = neighbours(faces, v)
    return np.linalg.norm(back) > cut and all((before[k] - place) @ back <= 0 for k in around)


LIMITS = [
    (0.2, 0.01, -0.9, np.inf, 0.0), (0.05, 0.6, -2.0, np.inf, 0.0), (0.01, 0.0, -0.3, np.inf, 0.0),
    (0.01, 0.0, -2.0, 0.3, 0.0), (0.01, 0.0, -2.0, np.inf, 0.1),
]  # fmt: skip


def allowed(faces, places, i, j, locked, place, turn, shape, fold, cut, thin):
    """Whether the edge i-j may collapse to a place."""
    edge, near = {i, j}, {i, j} | neighbours(faces, i) | neighbours(faces, j)
    faces = [face for face in faces if near & {*face}]
    removed = [face for face in faces if edge <= {*face}]
    left = [tuple(i if k == j else k for k in face) for face in faces if face not in removed]
    if len(neighbours(faces, i) & neighbours(faces, j)) != 2 or len({frozenset(face) for face in left}) < len(left):
        return False
    for v, other in ((i, j), (j, i)):
        if not locked[v] and spoils(faces, places, v, other, place, turn, shape, fold, cut, thin):
            return False
    after = places.copy()
    after[[i, j]] = place
    for face in removed:  # the two beside it become neighbours
        beside = [neighbour for neighbour in faces if neighbour not in removed and len({*face} & {*neighbour}) == 2]
        neighbour, opposite = (normal(face, after) for face in beside)
        folded = any(cosine(normal(face, places), normal(neighbour, places)) < fold for neighbour in beside)
        if cosine(neighbour, opposite) < fold and not folded:
            return False
    return True


@pytest.mark.parametrize("limits", LIMITS, ids=["all", "slivers", "folds", "tips", "thin"])
@pytest.mark.slow
def test_a_collapse_keeps_the_topology_and_spoils_no_face(limits):
    random, answers, may = np.random.default_rng(2), [], interpreted(collapse.may_collapse)
    for seed, noise in enumerate((0.08, 0.15)):
        surface = surface_of(rough_ball(seed, noise=noise))
        faces, places = [*map(tuple, surface.corner.reshape(-1, 3).tolist())], surface.position
        mark, last = np.zeros(len(places), dtype=np.int32), np.zeros(1, dtype=np.int64)
        for h in range(0, len(surface.corner), 4):
            i, j = surface.corner[h], surface.corner[surface.opposite[h]]
            locked = np.zeros(len(places), dtype=bool)
            locked[[i, j]] = [(False, False), (True, False), (False, True)][h % 3]
            middle = (places[i] + places[j]) / 2 + random.normal(0, 0.02, 3)
            place = places[i] if locked[i] else places[j] if locked[j] else middle
            link = surface.corner, surface.opposite, surface.start, locked, places, mark, last, h
            answer = may(*link, *place, *limits)
            assert answer == allowed(faces, places, i, j, locked, place, *limits), (seed, h)
            answers.append(answer)
    assert 0.1 < np.mean(answers) < 0.9


@pytest.mark.parametrize("apex", [3, 4])
def test_no_edge_of_a_tetrahedron_or_beside_a_vertex_of_three_faces_collapses(apex):
    vertices = np.array([[0, 0, 0], [1, 0, 0], [0.4, 0.9, 0], [0.5, 0.3, 0.8], [0.5, 0.3, -0.8]])
    faces = [[0, 1, 3], [1, 2, 3], [2, 0, 3], *([[0, 2, 1]] if apex == 3 else [[1, 0, 4], [2, 1, 4], [0, 2, 4]])]
    mesh = Mesh(vertices[: apex + 1], np.array(faces))
    surface, source, _ = fast.half_edge_mesh(mesh, np.zeros(len(faces), dtype=bool), None)
    locked, mark, last = np.ones(5, dtype=bool), np.zeros(5, dtype=np.int32), np.zeros(1, dtype=np.int64)
    for h in range(len(surface.corner)):  # nothing moves: only the topology speaks
        link = surface.corner, surface.opposite, surface.start, locked, surface.position, mark, last, h
        answer = interpreted(collapse.may_collapse)(*link, 0.0, 0.0, 0.0, 0.01, 0.0, -2.0, np.inf, 0.0)
        ends = source[surface.corner[[h, surface.opposite[h]]]]
        assert answer == (apex == 4 and max(ends) > 2)  # an apex may go down to the other three


def test_buckets_halve_each_doubling_of_the_cost():
    bucket = interpreted(collapse.bucket_of)
    assert [bucket(2.0**k) for k in (-100, -1, 0, 3)] == [0, 198, 200, 206]
    assert [bucket(1.4999), bucket(1.5), bucket(1.9999), bucket(2.0)] == [200, 201, 201, 202]
    assert bucket(0.0) == bucket(1e-40) == 0 and collapse.BUCKETS == 456
    assert bucket(3e38) == bucket(1e60) == bucket(np.inf) == bucket(np.nan) == bucket(-np.nan) == 455


def plane_sums(mesh, weight, place, vertices):
    """The error of some vertices at a place: a third of each face's area times its squared distances, by definition."""
    error, a_third = 0.0, 1 / 6
    for face in mesh.faces:
        n = normal(face, mesh.vertices)
        double = np.linalg.norm(n)
        for v in face:
            if v in vertices:
                off = (place - mesh.vertices[face[0]]) @ n / double
                near = place - mesh.vertices[v]
                error += a_third * double * weight[v] * (off**2 + 1e-6 * near @ near)
    return error


@pytest.mark.slow
def test_the_cost_of_a_collapse_is_the_least_sum_of_squared_distances_to_the_planes_of_both_ends():
    mesh, random = rough_ball(3), np.random.default_rng(4)
    weight = random.uniform(0.5, 2, len(mesh.vertices))
    quadric = np.zeros((len(mesh.vertices), 10))
    interpreted(quadrics._add_planes)(mesh.vertices, mesh.faces.ravel(), weight, quadric)
    for a, b in mesh.faces[:, :2]:
        error, *place = interpreted(quadrics.best_place)(quadric, mesh.vertices, a, b)
        assert error == pytest.approx(plane_sums(mesh, weight, np.array(place), (a, b)), abs=1e-12)
        assert error == pytest.approx(interpreted(quadrics.error_at)(quadric, a, b, *place), abs=1e-12)
        middle, length = mesh.vertices[[a, b]].mean(axis=0), np.linalg.norm(mesh.vertices[a] - mesh.vertices[b])
        q = quadric[a] + quadric[b]
        best = -np.linalg.solve(q[[[0, 1, 2], [1, 3, 4], [2, 4, 5]]], q[6:9])
        within = np.linalg.norm(best - middle) <= 2 * length
        assert place == pytest.approx(best if within else middle, abs=1e-9)


@pytest.mark.parametrize(("meet", "taken"), [(1.9, True), (2.1, False), (1e6, False)])
def test_a_vertex_never_goes_further_than_twice_the_length_of_its_edge(meet, taken):
    # The planes meet `meet` lengths from the middle of the edge; almost parallel ones do so anywhere.
    def plane(x, y, z, d):
        return np.array([x * x, x * y, x * z, y * y, y * z, z * z, x * d, y * d, z * d, d * d])

    ends = np.array([[-0.5, 0, 0], [0.5, 0, 0]])
    planes = np.stack([plane(1, 0, 0, -meet) + plane(0, 1, 0, 0), plane(0, 0, 1, 0)])
    place = interpreted(quadrics.best_place)(planes, ends, 0, 1)[1:]
    assert place == pytest.approx((meet if taken else 0, 0, 0), abs=1e-9)


def nearest_of(places, point):
    """(squared distance, shares of the corners) of the point of a triangle nearest to a point."""
    near = trimesh.triangles.closest_point(places[None], point[None])[0]
    return ((near - point) ** 2).sum(), trimesh.triangles.points_to_barycentric(places[None], near[None])[0]


@pytest.mark.parametrize("flat", [1, 0.1])  # flat ones are obtuse
def test_the_nearest_point_is_that_of_trimesh(flat):
    random = np.random.default_rng(7)
    for _ in range(400):
        corners, point = random.normal(size=(3, 3)) * (1, flat, 1), random.normal(size=3) * 3
        square, second, third = interpreted(refit._nearest)(corners, 0, 1, 2, *point)
        known, shares = nearest_of(corners, point)
        assert square == pytest.approx(known)
        assert (1 - second - third, second, third) == pytest.approx(shares, abs=1e-9)


@pytest.mark.slow
def test_the_fit_moves_each_vertex_by_the_pull_of_the_targets_merged_into_it():
    mesh, random = rough_ball(5, subdivisions=2, noise=0.01), np.random.default_rng(6)
    surface = surface_of(mesh)
    start, count = surface.position + random.normal(0, 0.02, surface.position.shape), len(surface.position)
    original, corner, weight = surface.position.copy(), surface.corner.copy(), random.uniform(0.5, 2, count)
    surface.position[:] = start
    surface.parent[5], surface.parent[9], surface.locked[[3, 30]] = 9, 20, True  # 5 was merged into 9, that into 20
    faces = corner.reshape(-1, 3)
    targets = [(v, original[v], weight[v]) for v in range(count)]
    targets += [(face[0], original[face].mean(axis=0), weight[face].mean()) for face in faces]
    pull, share = np.zeros((count, 3)), np.zeros(count)
    samples = 60
    for owner, point, size in targets[:: len(targets) // samples]:
        owner = {5: 20, 9: 20}.get(owner, owner)
        around = [np.roll(face, -int(np.flatnonzero(face == owner)[0])) for face in faces if owner in face]
        parts, face = min(((*nearest_of(start[face], point), face) for face in around), key=lambda entry: entry[0])[1:]
        n = normal(face, start)
        off = (point - start[owner]) @ n / (n @ n) * n
        for v, part in zip(face, parts, strict=True):
            pull[v] += part * size * off
            share[v] += part * size
    scratch = np.zeros((count, 4)), np.empty(count, dtype=np.int32)
    interpreted(refit._refit)(surface, original, corner, weight, samples, -0.9, *scratch)
    assert np.c_[pull, share] == pytest.approx(scratch[0], abs=1e-9)
    moved = (surface.position != start).any(axis=1)
    assert not moved[[3, 30]].any() and moved.sum() > 50 and not moved[share < 1e-12].any()
    wanted = start + 1.4 * pull / np.maximum(share, 1e-300)[:, None]
    assert surface.position[moved] == pytest.approx(wanted[moved], abs=1e-9)


@pytest.mark.slow
def test_edges_collapse_in_the_order_of_their_cost_until_the_faces_are_few_enough(monkeypatch):
    target, ball = 160, trimesh.creation.icosphere(2)
    surface = surface_of(Mesh(ball.vertices * [1, 0.8, 0.6], ball.faces))
    surface.locked[:3] = True
    costs, plain, cost = [], interpreted(collapse.collapse_edge), interpreted(collapse._cost)
    known = surface.corner, surface.opposite, surface.locked, surface.position, surface.quadric, None

    def recorded(*arguments):
        alive = [h for h in range(len(surface.corner)) if surface.corner[h] >= 0 and h < surface.opposite[h]]
        ends = surface.corner[np.array([alive, surface.opposite[alive]])]
        free = np.array(alive)[~surface.locked[ends].all(axis=0)]
        costs.append([cost(*known, arguments[8])[0], min(cost(*known, h)[0] for h in free)])
        return plain(*arguments)

    monkeypatch.setattr(collapse, "collapse_edge", recorded)
    work = jit._plain.__wrapped__(collapse._decimate)  # interpreted, with what was just set
    mark, last = np.zeros(len(surface.position), dtype=np.int32), np.zeros(1, dtype=np.int64)
    queue = collapse.empty_queue(len(surface.corner))
    left = work(surface, None, *queue, mark, last, target, 0.2, 0.01, -0.9)
    alive = surface.corner >= 0
    assert left == target == alive.sum() / 3 and len(costs) == (320 - target) / 2
    assert set(range(3)) <= set(surface.corner[alive].tolist())  # locked vertices stay
    paid, least_of_all = np.array(costs).T
    assert (paid <= 1.5 * least_of_all + 1e-12).mean() > 0.9  # one bucket: others were refused before

"""Every entry of METHODS keeps the contract in methods.py: form, count, sameness, and no surprise on odd meshes."""

import numpy as np
import pytest
import trimesh

from haptic_glance.look.channels import ViewMaps
from haptic_glance.look.points.detectors import RandomPoints, SvmDetector
from haptic_glance.look.points.glance import SampledDetector
from haptic_glance.look.points.methods import METHODS, PUBLISHED
from haptic_glance.look.points.options import Options
from haptic_glance.look.rivals import leifman, song
from haptic_glance.look.views import TWELVE
from haptic_glance.look.weights import LearnedWeights
from haptic_glance.mesh import normalise
from haptic_glance.mesh.mesh import Mesh
from tests.shapes import ball_mesh, flat_grid, raised_ball

pytestmark = pytest.mark.slow

EXACTLY = 1 - 1e-6  # correlation of the saliency before and after
ALIKE = {  # of those whose answer a moved mesh may change a little: ties are told apart anew, samples lie elsewhere
    "glance": 0.995, "glance_any_pose": 0.99, "glance_deep": 0.99, "touch": 0.9, "sift": 0.9, "leifman": 0.99,
    "song": 0.99, "tasse": 0.99, "mesh_saliency": 0.99, "salient_points": 0.99,
}  # fmt: skip
SMOOTH = ("mesh_saliency", "salient_points", "sift", "tasse")  # which see nothing where all places are alike
DRAWS = [name for name, method in METHODS.items() if isinstance(method, RandomPoints)]  # by the order of the faces
IN_ANY_ORDER = [name for name in METHODS if name not in DRAWS]
OF_THE_SURFACE = [name for name in IN_ANY_ORDER if not METHODS[name].channels]  # they look from no fixed place
QUARTER = np.array([[0.0, -1, 0], [1, 0, 0], [0, 0, 1]])


class MeanOfChannels:
    """Stands for an SVM that the pipeline trains."""

    def predict(self, rows):
        return rows.mean(axis=1)


def options_of(name, **more):
    """Options in which a method that needs learned weights finds even ones."""
    method, learned = METHODS[name], LearnedWeights()
    weights, svms = dict(learned.weights), dict(learned.svms)
    if isinstance(method, SvmDetector):
        svms[name] = {0: MeanOfChannels()}
    elif method.required_weights not in {None, *weights}:
        weights[method.required_weights] = dict.fromkeys(method.channels, 1.0)
    return Options(LearnedWeights(weights, svms), **more)


@pytest.fixture(scope="module", autouse=True)
def few_samples():
    with pytest.MonkeyPatch.context() as patch:
        for rival in (leifman, song):
            patch.setattr(rival, "SAMPLES", 300)
        yield


@pytest.fixture(scope="module")
def bumpy():
    """A long ball with three unlike bumps, of which every method finds some: 642 vertices."""
    tops = trimesh.util.unitize(np.array([[1.0, 0.2, 0.1], [-0.3, 1, 0.4], [0.1, -0.6, -1]]))
    ball = raised_ball(tops, [0.12, 0.15, 0.2], [0.5, 0.4, 0.6], subdivisions=3)
    return normalise(Mesh(ball.vertices * [1, 0.5, 0.5], ball.faces))


@pytest.fixture(scope="module")
def maps(bumpy, make_maps):
    return make_maps(bumpy, bumpy.vertices[np.linalg.norm(bumpy.vertices, axis=1).argmax()])


@pytest.fixture(scope="module", params=METHODS)
def name(request):
    if request.param == "glance_deep":
        pytest.importorskip("torch")
    return request.param


@pytest.fixture(scope="module")
def find(name, maps):
    """A function (mesh, count, options) -> Detection by the method; `maps` are the views of every mesh of its size."""

    def find(mesh, count=None, **options):
        method = METHODS[name]
        view_maps = ViewMaps(mesh, TWELVE, maps) if method.channels else None
        return method.find(mesh, view_maps, options_of(name, **options), count)

    return find


@pytest.fixture(scope="module")
def found(name, find, bumpy):
    return find(bumpy, 7 if without_threshold(name) else None)


def without_threshold(name):
    return not hasattr(METHODS[name], "saliency")


def test_the_answer_has_the_agreed_form_and_comes_again(name, find, found, bumpy):
    points, values = found.points, found.saliency
    assert points.dtype == np.int64 and 0 < len(points) == len(set(points.tolist()))
    assert np.isin(points, bumpy.used).all()
    again = find(bumpy, 7 if without_threshold(name) else None)
    assert np.array_equal(again.points, points)
    if without_threshold(name):
        assert values is None and found.strong is None
        return
    assert values.shape == (len(bumpy.vertices),) and values.dtype == np.float64
    assert values.min() >= 0 and values.max() == pytest.approx(1) and found.strong == len(points)
    assert np.array_equal(again.saliency, values)
    if name in PUBLISHED:
        assert (np.diff(values[points]) <= 1e-6).all()  # most salient first


@pytest.mark.parametrize("count", [1, 7, 60])
def test_as_many_points_as_asked_for(find, bumpy, count):
    points = find(bumpy, count).points
    assert len(points) == len(set(points.tolist())) == count


@pytest.mark.parametrize("name", IN_ANY_ORDER, indirect=True, scope="module")
def test_the_order_of_vertices_and_faces_changes_nothing(name, find, found, bumpy):
    order = np.random.default_rng(5).permutation(len(bumpy.vertices))
    place = np.argsort(order)
    shuffled = Mesh(bumpy.vertices[order], np.roll(place[bumpy.faces][::-1], 1, axis=1))
    other = find(shuffled, 7 if without_threshold(name) else None)
    assert np.array_equal(order[other.points], found.points)
    if found.saliency is not None:
        assert np.allclose(other.saliency, found.saliency[order], rtol=0, atol=1e-4)


@pytest.mark.parametrize("name", OF_THE_SURFACE, indirect=True, scope="module")
def test_a_turn_about_the_vertical_does_not_change_a_method_of_the_surface(name, find, found, bumpy):
    other = find(Mesh(bumpy.vertices @ QUARTER.T, bumpy.faces), 7 if without_threshold(name) else None)
    if found.saliency is not None:
        assert np.corrcoef(other.saliency, found.saliency)[0, 1] > ALIKE.get(name, EXACTLY)
    if name not in ALIKE:
        assert set(other.points) == set(found.points)


@pytest.mark.parametrize("name", PUBLISHED)
def test_neither_unit_nor_place_nor_which_side_is_out_changes_a_published_detector(name, bumpy):
    rival = PUBLISHED[name]
    angle = 0.0 if name in ("leifman", "song") else 1.0  # a turn draws other samples
    turn = trimesh.transformations.rotation_matrix(angle, [1, 2, 3])[:3, :3]
    moved = Mesh(1e-5 * (bumpy.vertices @ turn.T + [3, -2, 1]), bumpy.faces[:, ::-1])
    values, again = rival.saliency(bumpy), rival.saliency(moved)
    assert np.corrcoef(values, again)[0, 1] > ALIKE.get(name, EXACTLY)
    if name not in ALIKE:
        assert np.allclose(again, values, atol=1e-4 * values.max())
        assert set(rival.points(moved, again)) == set(rival.points(bumpy, values))
    with pytest.raises(ValueError, match="one per vertex"):
        rival.points(bumpy, np.ones(7))


def odd_meshes(bumpy):
    triangle = np.array([[0.0, 0, 0], [0.5, 0, 0], [0, 0.5, 0]])
    ball, nothing = ball_mesh(2), np.zeros((0, 3), int)
    long = 0.5 * ball.vertices * [1, 0.3, 0.3]
    soup = long[ball.faces].reshape(-1, 3)  # coincident vertices: no face shares one
    tip = bumpy.vertices[np.linalg.norm(bumpy.vertices, axis=1).argmax()]  # a vertex in no face lies below it
    grid = flat_grid(20, 20)
    return {
        "no vertices": (np.zeros((0, 3)), nothing),
        "no faces": (triangle, nothing),
        "one triangle": (triangle, [[0, 1, 2]]),
        "a needle": (triangle * [1, 0, 0], [[0, 1, 2]]),
        "a point": (np.zeros((3, 3)), [[0, 1, 2]]),
        "flat": (grid.vertices / 40, grid.faces),
        "far pieces": (np.concatenate([long, long + [1e6, 0, 0]]), np.concatenate([ball.faces, ball.faces + 162])),
        "coincident vertices": (soup, np.arange(len(soup)).reshape(-1, 3)),
        "a face twice": (triangle, [[0, 1, 2], [0, 1, 2], [2, 1, 0]]),
        "untidy": (np.r_[bumpy.vertices, [0.93 * tip]], np.r_[bumpy.faces, [[0, 0, 12], [5, 5, 5]]]),
    }


@pytest.mark.filterwarnings("error")
@pytest.mark.filterwarnings("ignore:.*stray parts far from the object")
def test_odd_meshes_give_finite_values_and_points_on_the_surface(name, find, bumpy):
    for odd, (vertices, faces) in odd_meshes(bumpy).items():
        mesh = Mesh(vertices, faces)
        try:
            detection = find(mesh, 3 if without_threshold(name) else None)
        except ValueError as error:  # a view of nothing, or nothing to draw from, is refused with the reason
            assert str(error) and (METHODS[name].channels or name in DRAWS), odd
            continue
        points, values = detection.points, detection.saliency
        assert points.dtype == np.int64 and np.isin(points, mesh.faces).all(), odd
        assert len(points) or odd != "untidy"
        if values is not None:
            assert values.shape == (len(mesh.vertices),) and np.isfinite(values).all(), odd
            assert values.min(initial=0) >= 0 and values.max(initial=0) <= 1 + 1e-12, odd
            if not isinstance(METHODS[name], SampledDetector) and not METHODS[name].channels:
                assert not np.delete(values, mesh.used).any(), odd


@pytest.mark.parametrize("name", SMOOTH)
def test_a_sphere_and_a_plane_have_neither_saliency_nor_points(name):
    for mesh in ball_mesh(4), flat_grid(9, 9):
        detection = METHODS[name].find(mesh, None, Options())
        assert not detection.saliency.any() and len(detection.points) == 0

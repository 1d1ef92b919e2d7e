"""Odd meshes, through every method: a finite saliency and points on the surface; what cannot be seen is refused."""

from functools import cache

import numpy as np
import pytest
import trimesh

from haptic_glance.disturb.perturbed import Conditions
from haptic_glance.look.points.methods import METHODS
from haptic_glance.look.points.options import Options
from haptic_glance.look.weights import LearnedWeights
from haptic_glance.mesh import normalise
from haptic_glance.mesh.mesh import Mesh
from stages.stability.repeatability import maps_under_conditions

SIZE = (90, 120)
COUNT = 5
BALL = trimesh.creation.icosphere(subdivisions=2, radius=0.4)
GRID = trimesh.creation.box((0.6, 0.6, 0.2)).subdivide().subdivide()


def black(vertices, faces):
    """A mesh painted black: under any light each of its pixels has the grey value zero."""
    return Mesh(vertices, faces, np.zeros((len(vertices), 3), dtype=np.uint8))


def twice(shape, apart):
    """A shape and its copy so many units away."""
    return Mesh(
        np.r_[shape.vertices, shape.vertices + [apart, 0, 0]], np.r_[shape.faces, shape.faces + len(shape.vertices)]
    )


ODD = {
    "one triangle": Mesh([[0, -0.4, -0.3], [0, 0.4, -0.3], [0, 0, 0.4]], [[0, 1, 2]]),
    "two pieces far apart": twice(BALL, 5),
    "flat": Mesh(GRID.vertices * [1, 1, 0], GRID.faces[GRID.face_normals[:, 2] > 0.9]),
    "inward normals": Mesh(BALL.vertices, BALL.faces[:, ::-1]),
    "a vertex in no face": Mesh(np.r_[BALL.vertices, [[3.0, 0.2, 0.3]]], BALL.faces),
    "all one colour": Mesh(GRID.vertices, GRID.faces, np.full((len(GRID.vertices), 3), [200, 30, 30])),
    "an image of one grey value": black(GRID.vertices, GRID.faces),
    "coincident vertices": Mesh(
        GRID.vertices[GRID.faces].reshape(-1, 3), np.arange(3 * len(GRID.faces)).reshape(-1, 3)
    ),
}
CHANNELS = tuple(dict.fromkeys(name for method in METHODS.values() for name in method.channels))
# One of each kind of detector. Others differ in channels alone.
# Those as published have tests/look/test_detector_contract.py.
KINDS = ("glance", "itti", "VisAttCurvP", "equal", "random", "farthest", "touch", "height", "mesh_saliency", "harris")
RUNNING = [name for name in KINDS if METHODS[name].required_weights in {None, *LearnedWeights().weights}]


@cache
def seen(name):
    mesh = normalise(ODD[name])
    return mesh, maps_under_conditions(mesh, CHANNELS, Conditions(), SIZE)


@pytest.mark.slow
@pytest.mark.filterwarnings("ignore:.torch.jit:DeprecationWarning")  # of kornia, where it is imported
@pytest.mark.filterwarnings("error")
@pytest.mark.parametrize("method", RUNNING)
@pytest.mark.parametrize("name", ODD)
def test_an_odd_mesh_has_a_defined_answer(name, method):
    mesh, sight = seen(name)
    detection = METHODS[method].find(mesh, sight, Options(name=name), COUNT)
    used = np.unique(mesh.faces)
    assert detection.points.dtype == np.int64 and len(set(detection.points)) == len(detection.points) <= COUNT
    assert len(detection.points) == min(COUNT, len(used)) and np.isin(detection.points, used).all()
    if detection.saliency is not None:
        assert detection.saliency.shape == (len(mesh.vertices),) and np.isfinite(detection.saliency).all()
        assert detection.saliency.min() >= 0 and detection.saliency.max() <= 1


@pytest.mark.parametrize("mesh", [twice(BALL, 5000), Mesh([[0, 0, 0], [1, 0, 0], [2, 0, 0]], [[0, 1, 2]])])
def test_what_no_pixel_sees_is_refused(mesh):
    with pytest.raises(ValueError, match="no pixel of any view sees the mesh"):
        maps_under_conditions(normalise(mesh), ("intensity",), Conditions(), SIZE)

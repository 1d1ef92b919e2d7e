"""T3.3.5 and T3.3.6 to the letter, beside the stage: bounding boxes, hidden vertices as zeros, pairs of centres."""

import numpy as np
import pytest
import trimesh

from haptic_glance.look.camera import Viewpoint
from haptic_glance.look.channels import facing
from haptic_glance.look.views import render
from haptic_glance.mesh.mesh import Mesh
from stages.fixation.agreement import agreement_rows
from stages.fixation.places import centres, project_by_boxes, project_to_vertices

SIZE = 224


@pytest.fixture(scope="module")
def ring():
    """A torus off the middle, taller than wide in the picture, and its vertices seen from one side."""
    torus = trimesh.creation.torus(0.3, 0.1, major_sections=64, minor_sections=32)
    mesh, viewpoint = Mesh(torus.vertices[:, [2, 0, 1]] * [1, 0.7, 1] + [0, 0.1, -0.05], torus.faces), Viewpoint(30, 20)
    return mesh, viewpoint, facing(mesh, [viewpoint])[0] > 0


@pytest.fixture(scope="module")
def seconds(ring):
    """(render (h, w), a smooth map (h, w)) of the ring."""
    mesh, viewpoint, _ = ring
    down, right = np.mgrid[:SIZE, :SIZE] / SIZE
    return render(mesh, viewpoint, (SIZE, SIZE), "raster").rgb.mean(axis=2), np.sin(5 * down) ** 2 + right


def by_boxes(saliency, picture, mesh, viewpoint):
    """T3.3.5: project the vertices, plot them as an image, resize one bounding box to the other, pixel to pixel."""
    rows, columns = np.nonzero(picture)
    box = saliency[rows.min() : rows.max() + 1, columns.min() : columns.max() + 1]
    right, up = viewpoint.axes[:2] @ mesh.vertices.T
    places = []
    for values, pixels in ((-up, box.shape[0]), (right, box.shape[1])):  # plotted on as many pixels as the other box
        places.append(np.rint((values - values.min()) / (values.max() - values.min()) * (pixels - 1)).astype(int))
    plotted = np.zeros(box.shape)
    plotted[places[0], places[1]] = 1
    assert all(edge.any() for edge in (plotted[0], plotted[-1], plotted[:, 0], plotted[:, -1]))  # its box is all of it
    return box[places[0], places[1]]


def test_boxes_are_those_of_the_text(ring, seconds):
    (mesh, viewpoint, seen), (picture, saliency) = ring, seconds
    projected = project_by_boxes(saliency[None], mesh, viewpoint, seen, picture)[0]
    assert (
        np.array_equal(projected, by_boxes(saliency, picture, mesh, viewpoint) * seen) and np.ptp(projected[seen]) > 0.5
    )


def test_hidden_vertices_belong_to_the_box(ring, seconds):
    (mesh, viewpoint, _), (picture, saliency) = ring, seconds
    low = mesh.vertices[:, 2] < 0
    part, whole = (project_by_boxes(saliency[None], mesh, viewpoint, seen, picture)[0] for seen in (low, low | ~low))
    assert np.array_equal(part[low], whole[low]) and not part[~low].any()


def test_boxes_and_the_camera_agree_to_a_pixel(ring, seconds):
    (mesh, viewpoint, seen), (picture, _) = ring, seconds
    places = np.mgrid[:SIZE, :SIZE].astype(float)
    boxes = project_by_boxes(places, mesh, viewpoint, seen, picture)[:, seen]
    off = np.abs(boxes - project_to_vertices(places, mesh, viewpoint, seen)[:, seen])
    assert 0.1 < off.mean() < 0.5 and off.max() < 1.6


def test_an_empty_picture_has_no_box(ring):
    mesh, viewpoint, seen = ring
    with pytest.raises(ValueError, match="render must show"):
        project_by_boxes(np.ones((1, 9, 9)), mesh, viewpoint, seen, np.zeros((9, 9)))


@pytest.fixture(scope="module")
def judged(ring):
    """(people's density (n,), saliency (n,), seen (n,), the rows of their agreement by metric) of the ring."""
    mesh, _, seen = ring
    people, model = (
        np.exp(-((mesh.vertices - mesh.vertices[ids][:, None]) ** 2).sum(axis=2) / 0.01).sum(axis=0)
        for ids in ([3, 900, 1500], [40, 1000])
    )
    people, model = 5 * people + 2, model + 0.1  # neither begins at zero nor ends at one
    lesson = {"amounts": people, "density": people, "areas": mesh.vertex_areas}
    rows = agreement_rows(mesh, lesson, seen[None], model[None], model)
    return people, model, seen, {row["metric"]: row["value"] for row in rows if row["view"] == 0}


def test_correlation_has_both_between_zero_and_one_times_the_visibility(judged, agreement):
    people, model, seen, scores = judged
    first, other = ((values - values.min()) / (values.max() - values.min()) * seen for values in (people, model))
    agreement("difference", abs(scores["pcc_masked"] - np.corrcoef(first, other)[0, 1]))
    assert abs(scores["pcc_masked"] - scores["pcc"]) > 0.02  # it is another number


def test_distance_is_the_least_of_the_pairs_of_the_pseudocode(ring, judged, agreement):
    mesh, (people, model, seen, scores) = ring[0], judged
    ours = [centre for centre in centres(mesh.vertices, model, seen)]
    distances = []
    for centre in centres(mesh.vertices, people, seen):
        if ours:
            nearest = min(ours, key=lambda peak: float(((peak - centre) ** 2).sum()))
            distances.append(np.linalg.norm(nearest - centre))
            ours = [peak for peak in ours if peak is not nearest]
    assert scores["distance"] == pytest.approx(min(distances)) and scores["distance"] > 0
    agreement("difference", abs(scores["distance_mean"] - np.mean(distances)))

"""The published weights are those that people's gaze taught, on 19 meshes and 14 point clouds."""

import io
import zipfile
from pathlib import Path

import numpy as np
import pytest

from haptic_glance.look.glance import samples_of_mesh, samples_of_points, standardised
from haptic_glance.look.weights import fit_fixations
from haptic_glance.look.weights.weights import GLANCES
from haptic_glance.mesh import normalise, rotate_to_z_up
from haptic_glance.mesh.axes import TO_Z_UP
from haptic_glance.mesh.files import parse
from haptic_glance.mesh.mesh import unit
from stages.weights.gaze import gaze_on_vertices, read_gaze

SHARED = Path(__file__).parents[2] / "../shared/data"


def on_meshes():
    """(Samples, seconds of gaze at each) of the 19 meshes, which have +y up."""
    with zipfile.ZipFile(SHARED / "gaze.zip") as archive:
        for member in sorted(name for name in archive.namelist() if "dataset_" in name and name.endswith(".txt")):
            mesh = parse(archive.read(f"Models_3D/{Path(member).stem}.obj"), ".obj")
            positions, _, seconds = read_gaze(archive.read(member))
            amounts, mesh = gaze_on_vertices(mesh, positions, seconds), normalise(rotate_to_z_up(mesh, "y"))
            yield at_samples(samples_of_mesh(mesh), mesh.vertices, amounts)


def on_clouds():
    """The same of the 14 clouds."""
    with zipfile.ZipFile(SHARED / "gaze_clouds.zip") as archive:
        for member in sorted(archive.namelist()):
            rows = np.loadtxt(io.BytesIO(archive.read(member)))
            points, normals = rows[:, :3] @ TO_Z_UP["y"].T, unit(rows[:, 3:6] @ TO_Z_UP["y"].T)
            points, first, place = np.unique(points, axis=0, return_index=True, return_inverse=True)
            centre = (points.min(axis=0) + points.max(axis=0)) / 2
            points = (points - centre) / (2 * np.linalg.norm(points - centre, axis=1).max())
            yield at_samples(samples_of_points(points, normals[first]), points, np.bincount(place.ravel(), rows[:, 6]))


def at_samples(samples, positions, amounts):
    return samples, np.bincount(samples.tree.query(positions)[1], amounts, minlength=len(samples.points))


@pytest.mark.slow
@pytest.mark.skipif(not (SHARED / "gaze_clouds.zip").exists(), reason="../shared/data is not there")
def test_the_published_weights_are_those_that_gaze_taught():
    subjects = [*on_meshes(), *on_clouds()]
    features = [standardised(samples) for samples, _ in subjects]
    amounts = [entry for _, entry in subjects]
    for method, published in GLANCES.items():
        kept = [np.stack([entry[name] for name in published], axis=1) for entry in features]
        weights = fit_fixations(kept, amounts, [samples.areas for samples, _ in subjects])
        assert weights == pytest.approx(list(published.values()), abs=0.002), method

"""Lavoue's fixation density maps, in files of the published layout that the test makes."""

import zipfile
from types import SimpleNamespace

import numpy as np
import pytest

from haptic_glance.base.fetch import FetchError
from haptic_glance.mesh.mesh import Mesh
from stages.meshes.sources import FIXATION_MAPS, SOURCES, collection_files
from stages.weights.gaze import fixation_files, fixations_on_vertices
from stages.weights.ground_truth import ground_truth_amounts, published_files  # fmt: skip

DENSITIES = {"300": [0.0, 1.5, 8.25], "413": [2.0, 0.0, 0.0], "599": [0.0, 0.0, 3e-3]}
TRIANGLE = Mesh(np.eye(3), np.array([[0, 1, 2]]))


@pytest.fixture
def folder(tmp_path):
    (tmp_path / "FixationMaps").mkdir()
    (tmp_path / "CentricityAndVisibilityMaps").mkdir()
    for view, density in DENSITIES.items():
        lines = "\n".join(map(str, density))
        (tmp_path / f"FixationMaps/car-vasa_{view}norm.txt").write_text(lines + "\n")
        seen = "\r\n".join(str(int(value > 0)) for value in density)
        (tmp_path / f"CentricityAndVisibilityMaps/car-vasa_{view}_visibility.txt").write_text(seen)
        centre = tmp_path / f"CentricityAndVisibilityMaps/car-vasa_{view}_100_CentricityObject_NewCalculation.txt"
        centre.write_text("1\n1\n1\n")
    return tmp_path


def looked(path, mesh=TRIANGLE):
    return fixations_on_vertices(fixation_files(collection_files(path, *FIXATION_MAPS))["car-vasa"], mesh)


def test_a_vertex_has_the_mean_of_the_views_that_see_it_by_its_area(folder):
    expected = np.array([2.0, 1.5, (8.25 + 3e-3) / 2]) * TRIANGLE.vertex_areas
    np.testing.assert_allclose(looked(folder), expected)


def test_a_vertex_that_no_view_sees_has_nothing(folder):
    for view in DENSITIES:
        (folder / f"CentricityAndVisibilityMaps/car-vasa_{view}_visibility.txt").write_text("1\n0\n1\n")
    assert looked(folder)[1] == 0 and looked(folder)[0] > 0


def test_a_zip_reads_like_the_folder(folder, tmp_path):
    with zipfile.ZipFile(tmp_path / "all.zip", "w") as archive:
        for path in folder.rglob("*.txt"):
            archive.write(path, f"3DVA/{path.relative_to(folder)}")
    assert looked(tmp_path / "all.zip").tolist() == looked(folder).tolist()


def test_a_map_of_another_length_is_named_with_both_counts(folder):
    square = Mesh(np.eye(4)[:, :3], TRIANGLE.faces)
    with pytest.raises(ValueError, match="car-vasa_300norm.txt has 3 values for 4 vertices"):
        looked(folder, square)


@pytest.mark.parametrize(("text", "reason"), [("1\nx\n2\n", "one number"), ("1\nnan\n2", "NaN"), ("1\n-1\n2", "neg")])
def test_a_damaged_map_is_named(folder, text, reason):
    (folder / "FixationMaps/car-vasa_413norm.txt").write_text(text)
    with pytest.raises(ValueError, match=f"car-vasa_413norm.txt.*{reason}"):
        looked(folder)


def test_an_absent_map_is_named(folder):
    (folder / "CentricityAndVisibilityMaps/car-vasa_599_visibility.txt").unlink()
    with pytest.raises(ValueError, match="no CentricityAndVisibilityMaps/car-vasa_599_visibility.txt"):
        looked(folder)


def test_the_set_reads_its_meshes_and_their_truth(folder):
    (folder / "3DModels-Simplif").mkdir()
    (folder / "3DModels-Simplif/car-vasa.obj").write_text("v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n")
    settings = SimpleNamespace(folder=str(folder), objects=[], up="y")
    (file,) = SOURCES["fixation_maps"](settings)
    assert (file.name, file.up, file.suffix) == ("car-vasa", "y", ".obj") and file.content().startswith(b"v 0 0 0")
    published = published_files("fixation_maps", folder)["car-vasa"]
    amounts = ground_truth_amounts("car-vasa", "fixation_maps", TRIANGLE, published)
    np.testing.assert_array_equal(amounts, looked(folder))


def test_an_absent_collection_ends_in_one_line_with_the_remedy(tmp_path):
    with pytest.raises(FetchError, match="nowhere.*FixationMaps.zip.*https://perso.liris.cnrs.fr") as caught:
        looked(tmp_path / "nowhere")
    assert "\n" not in str(caught.value)

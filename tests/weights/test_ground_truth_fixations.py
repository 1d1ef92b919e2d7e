"""Lavoue's fixation density maps, in files of the published layout that the test makes."""

import zipfile

import pytest

from stages.kit.fetch import FetchError
from stages.weights.ground_truth import read_fixations

DENSITIES = {"300": [0.0, 1.5, 8.25], "413": [2.0, 0.0, 0.0], "599": [0.0, 0.0, 3e-3]}


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


def test_densities_and_visibility_of_three_views(folder):
    found = read_fixations(folder, "car-vasa", 3)
    assert list(found) == ["300", "413", "599"]
    for view, density in DENSITIES.items():
        assert found[view].density.tolist() == density
        assert found[view].visible.tolist() == [value > 0 for value in density]


def test_a_zip_reads_like_the_folder(folder, tmp_path):
    with zipfile.ZipFile(tmp_path / "all.zip", "w") as archive:
        for path in folder.rglob("*.txt"):
            archive.write(path, f"3DVA/{path.relative_to(folder)}")
    assert read_fixations(tmp_path / "all.zip", "car-vasa", 3)["413"].density.tolist() == DENSITIES["413"]


def test_a_map_of_another_length_is_named_with_both_counts(folder):
    with pytest.raises(ValueError, match="car-vasa_300norm.txt has 3 values for 4 vertices"):
        read_fixations(folder, "car-vasa", 4)


@pytest.mark.parametrize(("text", "reason"), [("1\nx\n2\n", "one number"), ("1\nnan\n2", "NaN"), ("1\n-1\n2", "neg")])
def test_a_damaged_map_is_named(folder, text, reason):
    (folder / "FixationMaps/car-vasa_413norm.txt").write_text(text)
    with pytest.raises(ValueError, match=f"car-vasa_413norm.txt.*{reason}"):
        read_fixations(folder, "car-vasa", 3)


def test_an_unknown_object_is_named_with_the_known_ones(folder):
    with pytest.raises(ValueError, match="no map cow_300: there are maps of car-vasa"):
        read_fixations(folder, "cow", 3)


def test_an_absent_collection_ends_in_one_line_with_the_remedy(tmp_path):
    with pytest.raises(FetchError, match="nowhere.*FixationMaps.zip.*https://perso.liris.cnrs.fr") as caught:
        read_fixations(tmp_path / "nowhere", "cow", 3)
    assert "\n" not in str(caught.value)

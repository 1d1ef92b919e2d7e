"""Classes of several objects: which objects are taken, what is refused, and classes that are too small."""

import pytest

from haptic_glance.base.files import write_text
from stages.meshes.collect import chosen_objects, read_classes, small_classes

CLASSES = {"vase": ["urn", "jar"], "animal": ["dog", "61"]}


def test_classes_say_which_objects_are_taken_unless_objects_are_named():
    assert chosen_objects([], CLASSES) == ["urn", "jar", "dog", "61"]
    assert chosen_objects(["urn"], CLASSES) == ["urn"]
    assert chosen_objects([], {}) == []


def test_an_empty_class_and_an_object_of_two_classes_are_refused():
    with pytest.raises(ValueError, match="every class must name at least one object"):
        chosen_objects([], CLASSES | {"car": []})
    with pytest.raises(ValueError, match="jar, urn named twice"):
        chosen_objects(["urn"], CLASSES | {"pot": ["urn", "jar"]})


def test_classes_are_read_in_their_order_and_names_stay_texts(tmp_path):
    write_text(tmp_path / "classes.csv", "class,object\nvase,urn\nanimal,dog\nanimal,61\nvase,jar\n")
    found = read_classes(tmp_path)
    assert found == CLASSES and list(found) == ["vase", "animal"]


def test_a_data_set_without_classes_is_named(tmp_path):
    with pytest.raises(ValueError, match=r"classes\.csv is not there: name the classes .* meshes\.classes"):
        read_classes(tmp_path)


def test_a_class_with_one_object_left_has_a_note():
    (row,) = small_classes(CLASSES, ["urn", "dog", "61", "lamp"])
    assert row == {
        "group": "vase",
        "metric": "objects",
        "value": 1,
        "note": "class vase has 1 of its 2 objects: none of it can be held out",
    }

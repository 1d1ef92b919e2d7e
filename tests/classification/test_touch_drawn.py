"""Random sets of objects: dealt like cards, nested groups, the same by seed alone."""

from collections import Counter

import pytest

from stages.classification.trials import drawn_sets, set_of

GROUPS = {"six": list("abcdef"), "four": list("abcd")}
OBJECTS = [f"object_{k:02}" for k in range(20)]


def test_groups_of_one_set_are_nested_and_as_large_as_the_named_ones():
    sets = drawn_sets(GROUPS, OBJECTS, 5, 0)
    assert len(sets) == 10
    for number in range(1, 6):
        six, four = sets[f"six.{number:02}"], sets[f"four.{number:02}"]
        assert len(set(six)) == 6 and four == six[:4] and set(six) <= set(OBJECTS)


def test_no_object_comes_again_before_too_few_are_left():
    sets = drawn_sets({"six": GROUPS["six"]}, OBJECTS, 6, 0)
    times = Counter(one for objects in list(sets.values())[:3] for one in objects)
    assert max(times.values()) == 1 and max(Counter(sum(sets.values(), [])).values()) == 2


def test_sets_depend_on_the_seed_and_not_on_the_order_of_objects():
    first = drawn_sets(GROUPS, OBJECTS, 6, 0)
    assert drawn_sets(GROUPS, OBJECTS[::-1], 6, 0) == first != drawn_sets(GROUPS, OBJECTS, 6, 1)
    assert list(first.items())[:4] == list(drawn_sets(GROUPS, OBJECTS, 2, 0).items())


def test_too_few_objects_are_an_error_that_says_how_many():
    with pytest.raises(ValueError, match="takes 6 objects, there are 5"):
        drawn_sets(GROUPS, OBJECTS[:5], 1, 0)


def test_columns_of_a_drawn_and_of_a_named_set():
    assert set_of("six.07") == {"group": "six", "set": 7}
    assert set_of("six") == {"group": "six", "set": None}

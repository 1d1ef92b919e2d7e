"""Random numbers that belong to an item."""

import pytest

from haptic_glance.base.rng import rng


def test_an_item_has_its_own_numbers_for_each_seed():
    drawn = [rng(seed, name).random() for seed, name in ((0, "cup"), (0, "cup"), (0, "mug"), (1, "cup"))]
    assert drawn[0] == drawn[1] and len(set(drawn)) == 3


def test_a_negative_seed_is_named():
    with pytest.raises(ValueError, match="seed -1 is negative: give 0 or more"):
        rng(-1, "cup")

"""Splits of recorded touches."""

import numpy as np

from stages.recorded.splits import block_split, split_number


def test_a_block_holds_out_neighbours_of_each_class():
    labels = np.repeat(["a", "b"], [20, 12])
    train, test = block_split(labels, 3)
    assert sorted([*train, *test]) == list(range(32))
    for one, count in (("a", 5), ("b", 3)):
        own = np.sort(test[labels[test] == one])
        assert len(own) == count and (np.diff(own) == 1).all()
    assert len({tuple(block_split(labels, number)[1]) for number in range(9)}) > 3


def test_each_repetition_has_a_split_of_its_own():
    assert len({split_number(seed, repetition) for seed in (0, 1) for repetition in range(9)}) == 18

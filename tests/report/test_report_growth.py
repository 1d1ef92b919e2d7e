"""The chart of growth: the exponent that it fits, and that it asks for enough numbers of objects."""

import numpy as np
import pandas as pd
import pytest

from stages.kit.files import write_table
from stages.report import stability
from stages.report.results import NotRun
from stages.report.stability import growth
from stages.report.topics import build_one

SIZES = (30, 300, 1000, 3000)


def test_the_exponent_of_a_power_is_found_and_its_interval_widens_with_noise():
    n = np.array([300, 1000, 3000, 10_000.0])
    assert growth.exponent(n, 3 * n**1.5) == pytest.approx((1.5, 1.5, 1.5))
    power, low, high = growth.exponent(n, 3 * n**1.5 * [1, 1.2, 0.9, 1.1])
    assert low < 1.5 < high and low < power < high and high - low > 0.1


def rows(sizes, powers):
    """Rows of made-up stages whose time is a power of the number of objects, but for a start below 300."""
    made = [{"stage": stage, "objects": n, "processor": n**power + 1000 * (n < 300), "main_mib": 50 + n / 100,
             "seconds": 1, "machine": "here"} for n in sizes for stage, power in powers.items()]  # fmt: skip
    return pd.DataFrame([*made, {"stage": growth.STATUS, "objects": sizes[-1], "seconds": 1.26, "machine": "here"}])


@pytest.fixture
def results(bare, small):
    def written(*given):
        write_table(bare / "reports/bench/growth.csv", rows(*given))
        return small.results(bare)

    return written


def test_the_words_have_the_exponent_of_all_stages_and_the_time_of_the_status(results):
    words = growth.build(results(SIZES, {"views": 1, "lod": 1})).words
    assert words["power"] == "1.00 [1.00, 1.00]" and words["status"] == "1.3" and words["largest"] == "3,000"
    assert (words["memory_least"], words["memory"]) == ("50", "80")
    assert growth.build(results(SIZES, {"views": 2})).words["power"].startswith("2.00")


def test_it_is_drawn_and_said(results):
    figure = build_one(stability, "figures", "growth", results(SIZES, {"views": 1}))
    assert figure.paths[0].exists() and "up to 3,000 objects" in " ".join(figure.alt.split())


def test_too_few_numbers_of_objects_are_not_fitted(results):
    with pytest.raises(NotRun, match="fewer than three numbers of 300 objects and more"):
        growth.build(results(SIZES[:3], {"views": 1}))

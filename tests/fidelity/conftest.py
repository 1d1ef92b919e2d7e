"""Each test here compares the library with the letter of the thesis; the fidelity table states how well they agree."""

import functools
from pathlib import Path

import numpy as np
import pandas as pd
import pytest

from haptic_glance.mesh import load, normalise
from tests.fidelity.agreements import matches

ROOT = Path(__file__).parents[2]
TABLE = pd.read_csv(ROOT / "data/reference/thesis/fidelity.csv").fillna("")


@pytest.fixture
def agreement(request):
    """A function of a kind, of FORMS, and what the test measures: compares it with the rows that name the test.

    Kinds: r, a correlation; difference, the largest absolute one; settings, (that hold, of how many); pixels; share, in
    percent.
    """
    name = f"{request.node.path.name}::{request.node.originalname}"
    rows = TABLE[TABLE["test"] == name]

    def measured(kind, value):
        assert len(rows), f"no row of the fidelity table names {name}, which measures {kind} {value}"
        for row in rows.itertuples():
            message = f"{row.thesis}: the table states {row.agreement!r}, {name} measures {kind} {value}"
            assert matches(row.agreement, kind, value), message

    return measured


@pytest.fixture(scope="session")
def composed_set():
    """A function from a data set to its settings, composed once."""
    from stages.compose import composed

    return functools.cache(lambda dataset: composed([f"data={dataset}"]))


@pytest.fixture
def settings(composed_set):
    """A function that holds printed settings against those of a data set: (how many hold, how many there are).

    printed: dict "section.key" -> the value in print, or a predicate.
    """

    def held(dataset, printed):
        values, count = composed_set(dataset), 0
        for key, wanted in printed.items():
            value = values
            for part in key.split("."):
                value = value[part]
            count += bool(wanted(value)) if callable(wanted) else value == wanted
        return count, len(printed)

    return held


@pytest.hookimpl(hookwrapper=True)
def pytest_runtest_makereport(item):
    """A skipped test that the table names is a failed one: its row would claim what was not tested."""
    outcome = yield
    report = outcome.get_result()
    if report.skipped and f"{item.path.name}::{item.originalname}" in set(TABLE["test"]):
        report.outcome, report.longrepr = "failed", f"skipped: the row of {item.name} would not be tested"


@pytest.fixture(scope="session")
def dromedary():
    return normalise(load(ROOT / "samples/dromedary.glb"))


@pytest.fixture(scope="session")
def picture():
    """(rgb (h, w, 3) u1 on black, mask (h, w)): two coloured, shaded and striped bodies."""
    y, x = np.mgrid[:288, :384]
    rgb = np.zeros((288, 384, 3))
    bodies = ((140, 130, 90, 70, (0.9, 0.3, 0.25)), (170, 270, 60, 80, (0.3, 0.5, 0.9)))
    mask = np.zeros(x.shape, dtype=bool)
    for row, column, high, wide, colour in bodies:
        square = ((y - row) / high) ** 2 + ((x - column) / wide) ** 2
        inside = square < 1
        shade = np.sqrt(np.maximum(1 - square, 0)) * (0.8 + 0.2 * np.sin(x / 5 + y / 11))
        rgb[inside] = (shade[..., None] * colour)[inside]
        mask |= inside
    rgb[120:150, 110:150] = (0.2, 0.8, 0.3)
    return (rgb * 255).astype(np.uint8), mask

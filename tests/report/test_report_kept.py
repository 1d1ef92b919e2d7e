"""Figures of protocols as printed: drawn on their own set, kept where that is off, else drawn on the first set."""

from functools import partial
from types import SimpleNamespace

import pytest

from stages.report.claims_page import as_printed
from stages.report.drawing import plt
from stages.report.items import Figure

PROTOCOL = "household_3_1"


def figure_x(results):
    drawing, axes = plt.subplots(figsize=(1, 1))
    axes.plot([0, 1])
    return Figure(drawing, {"set": results.sets[0]})


@pytest.fixture
def at(tmp_path):
    """A function (first set, own_meshes) -> the words of the figure and the bytes of its picture, written there."""

    def written(first, own=False):
        results = SimpleNamespace(sets=[first], own_meshes=own, out=tmp_path, reports=tmp_path, read=set())
        figure = partial(as_printed, figure_x, PROTOCOL)(results)
        figure.name = "figure_x"
        figure.write(tmp_path / "figures")
        assert figure.paths[0].is_file() and PROTOCOL in results.read or figure.drawing.axes
        return figure.words, figure.paths[0].read_bytes()

    return written


def test_without_a_drawing_the_first_set_is_drawn(at):
    assert at("household")[0] == {"set": "household"}


def test_the_drawing_of_the_printed_protocol_outlasts_its_data(at):
    drawn = at(PROTOCOL)
    assert drawn[0] == {"set": PROTOCOL}
    assert at("household") == drawn


def test_a_folder_of_ones_own_has_its_own_drawing(at):
    at(PROTOCOL)
    assert at("folder", own=True)[0] == {"set": "folder"}

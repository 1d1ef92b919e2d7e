"""The chart of kernels over commits: which rows it draws, and that it needs the history."""

import pandas as pd
import pytest

from haptic_glance.base.files import write_table
from stages.report import stability
from stages.report.results import NotRun
from stages.report.stability import score
from stages.report.topics import build_one


def row(commit, hour, what, ratio, machine="here"):
    """A row of the history; ratio None for the reference loop."""
    ends = {} if ratio is None else {"low": 0.9 * ratio, "high": 1.1 * ratio, "limit": 1.5 * ratio}
    date = f"2026-11-21T{hour:02}:00:00+00:00"
    return {"commit": commit, "date": date, "what": what, "peer": f"peer of {what}", "ratio": ratio, **ends,
            "machine": machine}  # fmt: skip


@pytest.fixture
def results(bare, small):
    def written(*rows):
        write_table(bare / "reports/bench/history.csv", pd.DataFrame(list(rows)))
        return small.results(bare)

    return written


def test_lines_are_those_of_the_machine_that_measured_last_by_date(results, monkeypatch):
    drawn, draw = {}, score._draw

    def noted(axes, rows, *looks):
        drawn[rows["what"].iloc[0]] = rows
        draw(axes, rows, *looks)

    monkeypatch.setattr(score, "_draw", noted)
    rows = [row("b", 2, "maps", 0.2), row("a", 1, "maps", 0.1), row("a", 1, "old", 5.0, "elsewhere")]
    words = score.kernels(results(*rows, row("b", 2, "loop", None))).words
    assert list(drawn) == ["maps"] and list(drawn["maps"]["ratio"]) == [0.1, 0.2]
    assert list(drawn["maps"]["place"]) == [0, 1]
    assert words == {"kernels": 1, "commits": 2, "machine": "here", "names": "maps (peer of maps)"}


def test_one_commit_is_drawn_and_said(results):
    figure = build_one(stability, "figures", "kernels", results(row("a", 1, "maps", 0.1), row("a", 1, "press", 4.0)))
    assert figure.paths[0].exists() and "press (peer of press), maps (peer of maps)" in figure.alt


def test_without_the_history_it_is_not_run(bare, small):
    with pytest.raises(NotRun, match="make bench"):
        score.kernels(small.results(bare))

"""The table and the figure of the face counts."""

import pandas as pd
import pytest

from haptic_glance.base.files import write_table, write_text
from stages.charts.results import NotRun, Results
from stages.engine.settings import Workspace
from stages.report.parts import build_item
from stages.scene import counts_report as table
from stages.scene import report as scene
from tests.frames import has_ink


def rows():
    """Every model under every condition; the n-th model wastes n tenths more."""
    entries = []
    for number, method in enumerate(table.MODELS, start=1):
        for condition in table.CONDITIONS:
            for metric in table.METRICS:
                cell = {"method": method, "condition": condition, "setting": None, "metric": metric, "cases": 9}
                entries.append(cell | {"value": 1 + number / 10, "low": 1.05, "high": 1.6, "objects": 7})
        for metric in ("fit", "ask"):
            entries.append({"method": method, "condition": "cost", "metric": metric, "value": number, "seconds": 1})
    return pd.DataFrame(entries).assign(dataset="test", item="all", note="")


@pytest.fixture
def written(tmp_path):
    """A function that writes rows and returns the results."""
    common = "seed: 0\nprofile: test\nparallel: {backend: sequential}\ngraph: {}\nsets: [test]\n"
    write_text(tmp_path / "params.yaml", common)

    def write(frame):
        write_table(tmp_path / "reports/measurements/test/scene.csv.gz", frame)
        return Results(Workspace(tmp_path), None)

    return write


def test_metric_that_was_not_measured_is_a_dash(written):
    frame = rows()
    frame = frame[~((frame["condition"] == "flat") & (frame["metric"] == "excess"))]
    shown = table.counts_table(written(frame)).shown.set_index("asked about")
    assert set(shown.loc["objects of flat sides", "excess error, %"]) == {"–"}


@pytest.mark.slow
def test_figure_is_drawn_without_all_conditions(written):
    frame = rows()
    frame = frame[frame["condition"].isin(["left_out", "larger"])]
    assert has_ink(build_item(scene, "figures", "face_counts", written(frame)))


def test_without_a_judgement_it_is_not_run(written):
    frame = rows().assign(value=None, note="3 objects have curves")
    with pytest.raises(NotRun, match="3 objects"):
        table.counts_table(written(frame))

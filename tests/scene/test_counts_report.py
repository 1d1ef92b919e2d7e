"""The table and the figure of the face counts."""

from types import SimpleNamespace

import pandas as pd
import pytest

from stages.kit.files import write_table
from stages.report.figures import face_counts as figure
from stages.report.results import NotRun, Results
from stages.report.tables import face_counts as table


def rows():
    """Every model under every condition; the n-th model wastes n tenths more."""
    found = []
    for number, method in enumerate(table.MODELS, start=1):
        for condition in table.CONDITIONS:
            for metric in table.METRICS:
                cell = {"method": method, "condition": condition, "setting": None, "metric": metric, "cases": 9}
                found.append(cell | {"value": 1 + number / 10, "low": 1.05, "high": 1.6, "objects": 7})
        for metric in ("fit", "ask"):
            found.append({"method": method, "condition": "cost", "metric": metric, "value": number, "seconds": 1})
    return pd.DataFrame(found).assign(dataset="test", object="all", note="")


@pytest.fixture
def root(tmp_path):
    write_table(tmp_path / "reports/measurements/scene.csv", rows())
    return tmp_path


def test_table_has_a_line_a_model_and_condition(root):
    shown = table.build(Results(SimpleNamespace(), root)).shown
    assert len(shown) == len(table.MODELS) * len(table.CONDITIONS)
    line = shown[(shown["asked about"] == "objects left out") & (shown["model"] == table.MODELS["linear"])].iloc[0]
    assert line["wasted faces, %"] == "120 [105, 160]" and line["objects"] == 7


def test_metric_that_was_not_measured_is_a_dash(root):
    frame = rows()
    frame = frame[~((frame["condition"] == "flat") & (frame["metric"] == "excess"))]
    write_table(root / "reports/measurements/scene.csv", frame)
    shown = table.build(Results(SimpleNamespace(), root)).shown.set_index("asked about")
    assert set(shown.loc["objects of flat sides", "excess error, %"]) == {"–"}


def test_figure_is_drawn_with_and_without_all_conditions(root):
    assert figure.build(Results(SimpleNamespace(), root)).paths[0].stat().st_size > 10_000
    frame = rows()
    write_table(root / "reports/measurements/scene.csv", frame[frame["condition"].isin(["left_out", "larger"])])
    assert figure.build(Results(SimpleNamespace(), root)).paths[0].exists()


def test_without_a_judgement_it_is_not_run(root):
    frame = rows().assign(value=None, note="3 objects have curves")
    write_table(root / "reports/measurements/scene.csv", frame)
    with pytest.raises(NotRun, match="3 objects"):
        table.build(Results(SimpleNamespace(), root))

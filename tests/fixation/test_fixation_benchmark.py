"""What the benchmark on human gaze makes of the stage's rows."""

import pandas as pd
import pytest

from benchmarks.fixation import summary
from benchmarks.fixation_costs import costs


@pytest.fixture
def rows():
    """Rows of a network frozen and fine-tuned on four meshes; the fine-tuned one is 0.1 better and ten times dearer."""
    found = []
    for method, better, cost in (("net-frozen", 0.0, 1.0), ("net-finetuned", 0.1, 10.0)):
        found.append({"method": method, "task": "level_1", "metric": "accuracy", "value": 0.9, "seconds": 6 * cost})
        for k, name in enumerate("abcd"):
            one = {"object": name, "method": method}
            found.append(one | {"metric": "views", "value": 29, "seconds": cost})
            for view, value in (("0", 0.2), ("1", 0.4), ("all", 9.0)):
                row = one | {"task": "ewigc", "view": view, "metric": "pcc", "seconds": 3.0}
                found.append(row | {"value": value + 0.01 * k + better})
    return pd.DataFrame(found)


def test_a_mesh_counts_once_whatever_its_views_and_all_views_together_are_not_a_view(rows):
    table = summary(rows).set_index("method")
    assert table.loc["net-frozen", "mean"] == pytest.approx(0.315) and table.loc["net-frozen", "meshes"] == 4
    assert table.loc["net-frozen", "low"] < 0.315 < table.loc["net-frozen", "high"]


def test_the_chart_of_costs_gets_the_seconds_and_the_fused_map_of_each_view(rows):
    rows = rows.assign(dataset="gaze", seed=0)
    found = costs(pd.concat([rows, rows.assign(task="level_1", metric="pcc"), rows.assign(metric="nss")]))
    assert found["metric"].value_counts().to_dict() == {"pcc": 16, "views": 8, "accuracy": 2}
    assert set(found["view"].dropna()) == {"0", "1"} and not {"dataset", "seed"} & set(found)

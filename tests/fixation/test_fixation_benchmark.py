"""What the benchmark on human gaze makes of the stage's rows."""

import pandas as pd
import pytest

from benchmarks.fixation import summary


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

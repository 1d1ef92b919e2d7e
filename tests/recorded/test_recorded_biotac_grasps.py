"""Slip and recognition of grasps, also of unseen objects."""

import pandas as pd
import pytest

from stages.recorded import biotac_grasps
from stages.recorded.biotac_grasps import Model, process


@pytest.fixture
def measured(monkeypatch, tmp_path, recordings):
    """A function from a drift of the test part to the rows of the nearest neighbours."""
    monkeypatch.setattr(biotac_grasps, "GROUPS", 2)
    return lambda shift=0.0: pd.DataFrame(
        process(Model("knn", None), tmp_path, recordings.grasps(shift), repetitions=1, seed=0)
    )


def test_slip_of_unseen_objects_is_learned_and_scaling_each_part_undoes_a_drift(measured):
    steady, drifted = measured(), measured(40)

    def unseen(rows, scaled):
        chosen = (rows["split"] == "test_objects") & (rows["palm"] == "all")
        return rows[chosen & (rows["scaled"] == scaled)]

    assert unseen(steady, "training")["value"].mean() > 0.9
    assert set(unseen(steady, "own")["item"]) == {"o08", "o09", "o10", "o11"}
    assert unseen(drifted, "training")["value"].mean() < 0.7 < 0.9 < unseen(drifted, "own")["value"].mean()
    left_out = steady[steady["split"] == "objects"]
    assert set(left_out["item"]) == {f"o{k:02}" for k in range(8)} and left_out["value"].mean() > 0.9
    recognised = steady[steady["task"] == "recognition"]
    assert set(recognised["split"]) == {"random", "blocks"} and recognised["item"].isna().all()
    assert (recognised["count"] > 80).all()

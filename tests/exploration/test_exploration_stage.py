"""The exploration stage on a small run of its own."""

import numpy as np
import pandas as pd
import pytest

from stages.engine.rows import read_rows
from stages.exploration import Params
from stages.exploration import __main__ as stage
from stages.exploration.one_sampling import EXPERIMENTS
from stages.imprints.imprints import Imprints, write_imprints

SETTINGS = {"sets": ["pair"], "methods": ["here"], "confidences": [0.8], "most": 3, "repetitions": 2}
CLASSIFICATION = {"drawn": 0, "classifiers": [], "repetitions": 1, "closer": [], "touches": [], "combinations": 1}


@pytest.fixture
def run(tmp_path, make_workspace):
    """run(**changes) -> the measurements of a stage run over two objects, one of ridges and one of noise."""
    generator = np.random.default_rng(0)
    for k, name in enumerate(("flat", "rough")):
        images = generator.random((40, 16, 16)) if k else np.linspace(0, 1, 16) * generator.random((40, 16, 1))
        places = generator.uniform(-0.5, 0.5, (40, 3))
        imprints = {"here": Imprints(images, np.arange(40), places, 0.002)}
        write_imprints(tmp_path / f"data/toys/imprints/{name}.npz", imprints)

    def call(objects=("flat", "rough"), **changes):
        sections = {"exploration": SETTINGS | changes}
        sections["classification"] = CLASSIFICATION | {"sets": {"pair": list(objects)}}
        workspace = make_workspace(sections)
        stage.run(workspace)
        return read_rows(workspace.measurements / "exploration.csv.gz")

    return call


@pytest.mark.slow
def test_a_run_writes_every_experiment(run):
    rows = run()
    assert set(zip(rows["split"], rows["likelihood"], strict=True)) == set(EXPERIMENTS)
    assert set(rows["stop"]) == {"fixed", "confidence"} and set(rows["repetition"]) == {0, 1}
    fixed = rows[rows["stop"] == "fixed"]
    assert set(fixed["level"]) == {1, 2, 3} and (fixed["touches"] == fixed["level"]).all()
    assert rows["touches"].dropna().between(1, 3).all() and rows["belief"].dropna().between(0, 1).all()


def test_objects_that_nothing_has_in_common_are_told_apart(run):
    rows = run()
    rows_used = rows[(rows["split"] == "random") & (rows["metric"] == "accuracy")]
    assert rows_used["value"].mean() > 0.95


@pytest.mark.slow
def test_equal_runs_give_equal_rows(run):
    first, second = (run().drop(columns="seconds") for _ in range(2))
    pd.testing.assert_frame_equal(first, second)


def test_a_set_without_imprints_is_a_note(run):
    rows = run(objects=("flat", "gone"))
    assert rows["value"].isna().all() and "no imprints of gone" in rows["note"].iloc[0]


def test_one_object_alone_is_a_note(run):
    assert "at least two objects" in run(objects=("flat",))["note"].iloc[0]


def test_a_sampling_that_nobody_made_is_a_note(run):
    rows = run(methods=["elsewhere"])
    assert "no imprints by elsewhere of flat, rough" in rows["note"].iloc[0]


@pytest.mark.parametrize(
    ("changes", "message"),
    [({"sets": ["seven"]}, "no set seven"), ({"confidences": [1.2]}, "confidences"), ({"most": 0}, "1 or more")],
)
def test_settings_that_make_no_exploration_are_refused(changes, message):
    with pytest.raises(ValueError, match=message):
        stage.check(Params(**SETTINGS | changes), {"pair": []})

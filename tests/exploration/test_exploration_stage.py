"""The exploration stage on a small run of its own."""

import numpy as np
import pytest

from stages.engine.rows import read_rows
from stages.exploration import __main__ as stage
from stages.imprints.imprints import Imprints, write_imprints

SETTINGS = {"sets": ["pair"], "methods": ["glance"], "confidences": [0.8], "most": 3, "repetitions": 2}
CLASSIFICATION = {"drawn": 0, "classifiers": [], "repetitions": 1, "closer": [], "touches": [], "combinations": 1}


@pytest.fixture
def run(tmp_path, make_workspace):
    """run(**changes) -> the measurements of a stage run over two objects, one of ridges and one of noise."""
    generator = np.random.default_rng(0)
    for k, name in enumerate(("flat", "rough")):
        images = generator.random((40, 16, 16)) if k else np.linspace(0, 1, 16) * generator.random((40, 16, 1))
        places = generator.uniform(-0.5, 0.5, (40, 3))
        imprints = {"glance": Imprints(images, np.arange(40), places, 0.002)}
        write_imprints(tmp_path / f"data/toys/imprints/{name}.npz", imprints)

    def call(objects=("flat", "rough"), **changes):
        sections = {"exploration": SETTINGS | changes}
        sections["classification"] = CLASSIFICATION | {"sets": {"pair": list(objects)}}
        workspace = make_workspace(sections)
        stage.run(workspace)
        return read_rows(workspace.measurements / "exploration.csv.gz")

    return call


@pytest.mark.slow
def test_a_run_writes_every_experiment_and_tells_objects_apart_that_have_nothing_in_common(run):
    rows = run()
    assert set(zip(rows["split"], rows["likelihood"], strict=True)) == set(stage.EXPERIMENTS)
    assert set(rows["stop"]) == {"fixed", "confidence"} and set(rows["repetition"]) == {0, 1}
    fixed = rows[rows["stop"] == "fixed"]
    assert set(fixed["level"]) == {1, 2, 3} and (fixed["touches"] == fixed["level"]).all()
    assert rows["touches"].dropna().between(1, 3).all() and rows["belief"].dropna().between(0, 1).all()
    assert rows.loc[(rows["split"] == "random") & (rows["metric"] == "accuracy"), "value"].mean() > 0.95


@pytest.mark.parametrize(
    ("objects", "changes", "note"),
    [
        (("flat", "gone"), {}, "no imprints of gone"),
        (("flat",), {}, "at least two objects"),
        (("flat", "rough"), {"methods": ["itti"]}, "no imprints by itti of flat, rough"),
    ],
)
def test_what_cannot_be_explored_is_a_note(run, objects, changes, note):
    rows = run(objects, **changes)
    assert rows["value"].isna().all() and note in rows["note"].iloc[0]

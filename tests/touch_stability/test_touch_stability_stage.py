"""The touch_stability stage on a small run of its own, and its denoisers."""

import numpy as np
import pandas as pd
import pytest
import trimesh

from haptic_glance.base.files import read_json, write_arrays, write_mesh
from haptic_glance.mesh.mesh import Mesh
from haptic_glance.touch import Skin, press_many
from stages.engine.rows import read_rows
from stages.engine.statistics import lead_left
from stages.imprints.imprints import Imprints, write_imprints
from stages.touch_stability import __main__ as stage
from stages.touch_stability.denoisers import DENOISERS
from stages.touch_stability.disturbed_trials import CLEAN, first_of_each, recognition_rows

SEVERITIES = {"noise": [0.05, 1.0], "object_turned": [90.0], "coarse_model": [60.0], "few_touches": [8.0]}
SETTINGS = {
    "set": "pair", "method": "here", "classifiers": ["knn"], "severities": SEVERITIES, "repetitions": 2,
    "denoisers": [],
}  # fmt: skip
CLASSIFICATION = {"drawn": 0, "classifiers": [], "repetitions": 1, "closer": [], "touches": [], "combinations": 1}


@pytest.fixture
def run(tmp_path, make_workspace):
    """run(**changes) -> the measurements of a stage run over a ball and a box."""
    data = tmp_path / "data/toys"
    solids = {"ball": trimesh.creation.icosphere(subdivisions=3, radius=0.4), "box": trimesh.creation.box((0.5,) * 3)}
    solids["box"] = solids["box"].subdivide().subdivide().subdivide()
    for name, solid in solids.items():
        mesh = Mesh(solid.vertices, solid.faces)
        ids = np.random.default_rng(0).permutation(len(mesh.vertices))[:40]
        write_mesh(data / f"meshes/{name}.npz", mesh)
        write_imprints(
            data / f"imprints/{name}.npz",
            {"here": Imprints(press_many(mesh, ids, (16, 16), 0.01), ids, mesh.vertices[ids], 0.01)},
        )
        saliency = np.linspace(0, 1, len(mesh.vertices))
        arrays = {"glance.points": ids, "glance.strong": np.int64(2), "glance.saliency": saliency}
        write_arrays(data / f"salient_points/{name}.npz", **arrays)
        write_mesh(data / f"lod/{name}/qem_50pct.npz", mesh)

    def call(objects=("ball", "box"), **changes):
        sections = {"touch_stability": SETTINGS | changes}
        sections["classification"] = CLASSIFICATION | {"sets": {"pair": list(objects)}}
        workspace = make_workspace(sections)
        stage.run(workspace)
        return read_rows(workspace.measurements / "touch_stability.csv.gz")

    return call


@pytest.mark.slow
def test_a_run_measures_every_severity_by_every_split(run, tmp_path):
    rows = run()
    measured = set(zip(rows["perturbation"], rows["severity"], strict=True))
    assert measured == {(CLEAN, 0.0), *((name, severity) for name, levels in SEVERITIES.items() for severity in levels)}
    assert set(rows["split"]) == {"random", "regions"} and rows["value"].between(0, 1).all()
    assert set(rows.loc[rows["features"] == "imprint_place", "perturbation"]) == {CLEAN, "object_turned"}
    assert (rows["chance"] == 0.5).all()
    means = rows.groupby(["perturbation", "severity"])["value"].mean()
    assert means[CLEAN, 0.0] > 0.9 and means["noise", 1.0] < 0.7
    measured = read_json(tmp_path / "reports/metrics/toys/touch_stability.json")
    assert 0 < measured["breaking_point"]["anywhere.imprint.knn.noise"] < 1
    assert measured["breaking_point"]["anywhere.imprint.knn.object_turned"] is None
    assert measured["accuracy"]["anywhere.imprint.knn"] > 0.9


@pytest.mark.slow
def test_denoised_touches_are_asked_about_beside_the_others(run):
    rows, other = run(denoisers=["autoencoder"], severities={"noise": [0.2]}), run(severities={"noise": [0.2]})
    cleaned = rows["features"] == "imprint_autoencoder"
    assert set(rows.loc[cleaned, "perturbation"]) == {CLEAN, "noise"}
    pd.testing.assert_frame_equal(
        rows[~cleaned].drop(columns="seconds").reset_index(drop=True), other.drop(columns="seconds")
    )
    means = rows[rows["perturbation"] == "noise"].groupby("features")["value"].mean()
    assert means["imprint_autoencoder"] != means["imprint"]


def test_there_is_no_lead_to_lose_where_clean_touches_are_no_better_than_guessing():
    assert lead_left([0.6, 0.4], 0.8, 0.4) == pytest.approx([0.5, 0.0])
    assert np.isnan(lead_left([0.1, 0.3], 0.3, 0.4)).all() and np.isnan(lead_left([0.1], 0.4, 0.4)).all()


@pytest.mark.slow
def test_a_severity_that_cannot_be_had_is_a_note_and_the_others_are_measured(run):
    rows = run(severities={"coarse_model": [1.0], "noise": [0.05]})
    assert rows["note"].dropna().str.startswith("coarse_model 1 left out").all() and rows["note"].notna().any()
    assert rows.loc[rows["perturbation"] == "noise", "value"].notna().all()


@pytest.mark.parametrize(
    ("objects", "method", "note"),
    [
        (("ball", "gone"), "here", "no imprints of gone"),
        (("ball",), "here", "at least two objects"),
        (("ball", "box"), "there", "no imprints by there"),
    ],
)
def test_what_was_not_touched_is_a_note(run, objects, method, note):
    rows = run(objects=objects, method=method)
    assert rows["value"].isna().all() and note in rows["note"].iloc[0]


def test_few_keeps_as_many_of_each_object():
    truth = np.array([0, 0, 0, 1, 1, 1, 1])
    assert first_of_each(np.array([2, 6, 0, 3, 1, 5, 4]), truth, 2).tolist() == [0, 2, 3, 6]


def test_what_is_learned_from_coarse_models_is_asked_about_clean_touches():
    """Disturbed samples that are clean ones of the other object: asked about, wrong; learned from, wrong as well."""
    truth, generator = np.repeat([0, 1], 40), np.random.default_rng(0)
    clean = 5.0 * truth[:, None] + generator.normal(size=(80, 41))
    samples = {"imprint": clean, "imprint_place": np.hstack([clean, np.zeros((80, 3))])}

    def swapped(perturbation, severity, features):
        return samples[features][::-1]

    severities = {"noise": [1.0], "coarse_model": [1.0]}
    train, test = np.split(generator.permutation(80), [60])
    rows = pd.DataFrame(recognition_rows(samples, swapped, truth, train, test, severities, ["knn"], 0))
    means = rows[rows["features"] == "imprint"].groupby("perturbation")["value"].mean()
    assert means[CLEAN] == 1 and means["noise"] == 0 and means["coarse_model"] == 0


def domes(count, seed):
    """(count, 16, 16) f4 in 0..1: round domes at random places, of random size."""
    random, grid = np.random.default_rng(seed), np.mgrid[:16, :16]
    middle, width = random.uniform(4, 12, (2, count, 1, 1)), random.uniform(3, 8, (count, 1, 1))
    return (1 - np.exp(-((grid[0] - middle[0]) ** 2 + (grid[1] - middle[1]) ** 2) / width**2)).astype(np.float32)


@pytest.fixture(scope="module")
def learned():
    """An autoencoder that learned from a hundred domes in a few passes."""
    autoencoder = pytest.importorskip("stages.touch_stability.autoencoder")
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(autoencoder, "PASSES", 40)
        return autoencoder, DENOISERS["autoencoder"](domes(100, 0), 0)


@pytest.mark.slow
@pytest.mark.parametrize("fault", [{"noise": 0.2}, {"dead": 0.2}])
def test_the_autoencoder_brings_domes_that_it_never_felt_nearer_to_the_truth(learned, fault):
    clean = domes(40, 1)
    worn = Skin(**fault, seed=1)(clean, "domes")
    left, before = (float(((images - clean) ** 2).mean()) for images in (learned[1](worn), worn))
    assert left < 0.5 * before


@pytest.mark.slow
def test_what_it_learns_to_undo_varies_and_equal_seeds_give_equal_denoisers(learned, monkeypatch):
    module, clean = learned[0], domes(20, 2)
    monkeypatch.setattr(module, "PASSES", 2)
    first, again, other = (DENOISERS["autoencoder"](domes(10, 0), seed)(domes(3, 1)) for seed in (0, 0, 1))
    assert np.array_equal(first, again) and not np.array_equal(first, other)
    monkeypatch.setattr(module, "UNDONE", {"dead": 0.3})
    dead = [float((module.disturbed(clean, np.random.default_rng(seed)) == 1).mean()) for seed in range(30)]
    assert 0.2 < max(dead) < 0.35 and min(dead) < 0.1

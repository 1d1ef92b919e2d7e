"""How many faces: curves with a known law, so that each model's right answer is known."""

import numpy as np
import pandas as pd
import pytest

from stages.scene.counts import evaluate
from stages.scene.counts.cases import power_law
from stages.scene.counts.evaluate import evaluate_counts
from stages.scene.counts.models import FOCAL, Curve, fit_counts, read_curves
from tests.shapes import ball_mesh

pytestmark = pytest.mark.slow

COMBINATIONS = ("itti", "VisAttCon")
SHARES = np.array([0.05, 0.1, 0.2, 0.4, 0.7])


def law(name, initial, points, method="itti", exponent=2.0, scale=1e-4):
    """A curve whose error is scale * (faces / initial) ** -exponent: straight in logarithms."""
    faces = np.round(SHARES * initial).astype(int)
    return Curve(name, method, points, initial, faces, scale * (faces / initial) ** -exponent)


def curves(objects=10):
    """Two combinations a name: one law for all, whatever the size and the points."""
    sizes = np.linspace(2000, 9000, objects).astype(int)
    return [law(f"o{k}", size, 3 + k % 4, method) for k, size in enumerate(sizes) for method in COMBINATIONS]


def right(error, initial):
    """The count that the law asks for."""
    return initial * np.sqrt(1e-4 / error)


def test_lookup_is_exact_on_and_between_points_of_a_power_law():
    error = np.geomspace(3e-4, 3e-2, 20)
    assert law("a", 10**6, 5).faces_needed(error) == pytest.approx(right(error, 10**6), rel=1e-4)
    curve = law("a", 4000, 5)
    assert curve.faces_needed(curve.errors).tolist() == curve.faces.tolist() and curve.faces_needed(0) == 4000
    assert curve.error_at(curve.faces) == pytest.approx(curve.errors)


def test_lookup_never_asks_for_more_faces_at_a_larger_error_nor_trusts_a_lucky_mesh():
    curve = Curve("a", "itti", 3, 5000, [400, 800, 1500, 3000], [1e-3, 1.2e-3, 2e-4, 3e-5])
    faces = curve.faces_needed(np.geomspace(1e-9, 1, 500))
    assert (np.diff(faces) <= 0).all() and faces[0] == 5000 and faces[-1] == 400
    assert Curve("a", "itti", 3, 5000, [400, 800, 1500], [1e-4, 3e-4, 1e-4]).faces_needed(2e-4) > 800


def test_curves_are_read_one_an_object_and_method():
    rows = [("a", "itti", 3, 50, "metro_mean", 0.2), ("a", "itti", 3, 80, "metro_mean", 0.1),
            ("a", "qem", 0, 50, "metro_mean", 0.1), ("a", "qem", 0, 50, "metro_max", 9.0),
            ("a", "itti", 3, None, "faces", None)]  # fmt: skip
    frame = pd.DataFrame(rows, columns=["item", "method", "points", "faces", "metric", "value"])
    per_method = read_curves(frame, {"a": 100})
    assert [(c.method, c.points, c.faces.tolist()) for c in per_method] == [("itti", 3, [50, 80]), ("qem", 0, [50])]


@pytest.mark.parametrize("kind, off", [("linear", 0.01), ("network", 0.12)])
def test_a_common_law_is_learned(kind, off):
    model, points = fit_counts(curves(), COMBINATIONS, kind, 0), dict.fromkeys(COMBINATIONS, 4)
    error, distance = np.array([5e-4, 2e-3, 1e-2]), np.array([1.5, 6.0, 20.0])
    faces = model.faces_needed(error * FOCAL / distance, distance, 5000, points)
    assert np.log(faces / right(error, 5000)) == pytest.approx(0, abs=off)
    assert 4 <= model.faces_needed(1e6, 30, 5000, points) <= 5000 and model.faces_needed(1e-6, 1, 5000, points) <= 5000


def test_the_count_is_the_average_over_the_combinations():
    coarse = [law(f"o{k}", 2000 + 500 * k, k, "VisAttCon", scale=1e-5) for k in range(8)]
    fine = [law(f"o{k}", 2000 + 500 * k, k, "itti") for k in range(8)]
    question = (1.0, 2.0, 4000, {"itti": 3, "VisAttCon": 5})
    alone = [fit_counts(fine + coarse, [name], "linear", 0).faces_needed(*question) for name in ("itti", "VisAttCon")]
    average = fit_counts(fine + coarse, ["itti", "VisAttCon"], "linear", 0).faces_needed(*question)
    assert alone[0] > 2 * alone[1] and average == pytest.approx(np.mean(alone), abs=1)


def test_equal_seeds_give_equal_networks_in_any_order_of_calls():
    question = (np.geomspace(0.1, 5, 9), 4, 5000, {"itti": 4})
    first = fit_counts(curves(3), ["itti"], "network", seed=3).faces_needed(*question)
    other = fit_counts(curves(3), ["itti"], "network", seed=1).faces_needed(*question)
    again = fit_counts(curves(3), ["itti"], "network", seed=3).faces_needed(*question)
    assert first.tolist() == again.tolist() != other.tolist()


def test_objects_that_share_a_power_give_it():
    assert power_law(curves()) == pytest.approx(0.5, rel=1e-3)


def ball_curves():
    """A ball under six names, measured by a law, with the meshes and points to build from."""
    mesh = ball_mesh(3, 0.5)
    names = [f"o{k}" for k in range(6)]
    made = [law(name, len(mesh.faces), 2 + k % 3, scale=2e-3, exponent=1) for k, name in enumerate(names)]
    return made, dict.fromkeys(names, mesh), {name: {"itti": np.array([0, 500])} for name in names}


@pytest.fixture(scope="module")
def evaluated():
    """The rows of a small evaluation, by (method, condition, metric)."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(evaluate, "BUILT", 1)
        patch.setattr(evaluate, "RESAMPLES", 20)  # of the ends of intervals, which no test here reads
        frame = pd.DataFrame(evaluate_counts(*ball_curves()))
    return frame.set_index(["method", "condition", "metric"]).sort_index()


def test_all_models_are_right_where_one_law_holds(evaluated):
    for method in ("network", "linear", "one_mesh", "lookup"):
        assert evaluated.loc[(method, "left_out", "factor_90"), "value"].item() < 1.3
    for method in ("linear", "one_mesh", "lookup"):
        assert evaluated.loc[(method, "left_out", "factor_90"), "value"].item() < 1.1


def test_a_safety_factor_raises_the_rate_and_the_waste(evaluated):
    for method in ("network", "linear"):
        rows = evaluated.loc[method]
        for metric in ("within", "waste"):
            raw, safe = (rows.loc[(condition, metric), "value"].item() for condition in ("left_out", "equal_rate"))
            assert safe >= raw


def test_built_meshes_are_measured_and_costs_are_ratios_to_the_lookup(evaluated):
    rows = evaluated.loc[("lookup", "built")]
    assert rows.loc["excess", "objects"].item() == 5
    assert 0 <= rows.loc["within", "value"].item() <= 1
    assert evaluated.loc[("lookup", "cost", "fit"), "value"].item() == 1
    assert (evaluated.loc[(slice(None), "cost"), "seconds"] > 0).all()


def test_too_few_objects_are_a_note():
    made, meshes, points = ball_curves()
    (row,) = evaluate_counts(made[:3], meshes, points)
    assert row["value"] is None and "3 objects" in row["note"]
    assert evaluate_counts([], {}, {})[0]["note"].startswith("0 objects")

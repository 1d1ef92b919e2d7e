"""Stability as a benchmark: pairs of disturbances, several draws, and what the points are worth afterwards."""

import dataclasses

import numpy as np
import pytest

from haptic_glance.base.files import read_arrays, read_json, write_mesh, write_table
from haptic_glance.base.rng import rng
from haptic_glance.disturb.objects import PERTURBATIONS
from haptic_glance.disturb.perturbed import Conditions
from haptic_glance.mesh.mesh import Mesh
from stages.engine.rows import read_rows
from stages.stability.__main__ import process, run
from stages.stability.disturbance import Disturbance, disturbances
from stages.stability.subject import mean_of_draws
from stages.stability.uses import partitions
from stages.weights.training import weight_table

NOISE, TILT, HALF = ("noise", 0.01), ("tilt", 30.0), ("decimation", 0.5)


def apply(mesh, *parts, draw=0):
    return Disturbance(parts, draw).apply(mesh, "pear", 0)


@pytest.mark.parametrize(
    ("single", "none"),
    [
        (("noise", 0.01), ("tilt", 0.0)),
        (("decimation", 0.5), ("light", 0.0)),
        (("missing_faces", 0.2), ("noise", 0.0)),
        (("turn", 30.0), ("noise", 0.0)),
    ],
)
def test_a_pair_with_nothing_is_the_single_disturbance(pear, single, none):
    alone, before, after = apply(pear, single), apply(pear, none, single), apply(pear, single, none)
    for pair in (before, after):
        assert np.allclose(pair.mesh.vertices, alone.mesh.vertices, atol=1e-12)
        off = 0.02 if single[0] == "decimation" else 1e-9  # new vertices lie beside the surface, and are put on it
        assert np.allclose(pair.original_positions, alone.original_positions, atol=off)
        assert pair.conditions == alone.conditions == Conditions()


def test_places_of_a_pair_lie_on_the_object_as_it_was(pear):
    """Turned first and simplified then: the places are those of the whole object, not of the turned one."""
    pair = apply(pear, TILT, HALF)
    back = np.linalg.norm(pear.vertices[:, None] - pair.original_positions, axis=2).min(axis=0)
    assert back.max() < 0.05 * pear.diagonal and len(pair.original_positions) < len(pear.vertices)
    assert np.linalg.norm(pair.original_positions - pair.mesh.vertices, axis=1).max() > 0.1


def test_a_pair_has_the_random_numbers_of_its_parts_and_the_conditions_of_both(pear):
    pair, noise = apply(pear, NOISE, ("light", 30.0), ("image_size", 0.5)), apply(pear, NOISE)
    alone = PERTURBATIONS["noise"].apply(pear, NOISE[1], rng(0, "pear noise"))
    assert np.array_equal(noise.mesh.vertices, alone.mesh.vertices)  # as before there were draws
    assert np.array_equal(pair.mesh.vertices, noise.mesh.vertices)
    assert pair.conditions == Conditions(light=30.0, rows=0.5)


class Refuses:
    def __getattr__(self, name):
        raise AssertionError(f"it asked for {name}")


@pytest.mark.parametrize("name", sorted(set(PERTURBATIONS) - {"remeshing"}))
@pytest.mark.slow
def test_only_what_draws_has_several_draws(pear, name):
    severity = {"scale": 2.0, "scan": 360.0, "decimation": 0.5}.get(name, 0.9)
    mesh = Mesh(pear.vertices, pear.faces, np.full(pear.vertices.shape, 90, dtype=np.uint8))
    many = disturbances([(name, severity)], 3)
    assert len(many) == (3 if PERTURBATIONS[name].random_draws else 1)
    if len(many) == 1:
        PERTURBATIONS[name].apply(mesh, severity, Refuses())
    else:
        first, second = (case.apply(mesh, "pear", 0).mesh for case in many[:2])
        assert first.vertices.shape != second.vertices.shape or not (
            np.array_equal(first.vertices, second.vertices)
            and np.array_equal(first.faces, second.faces)
            and np.array_equal(first.colors, second.colors)
        )


def test_draws_are_averaged_and_one_that_failed_does_not_count():
    def row(value, metric="repeatability"):
        return {"method": "itti", "metric": metric, "value": value, "seconds": value, "note": None}

    failed = [row(None) | {"note": "no surface"}]
    rows = mean_of_draws([failed, [row(0.5), row(0.1, "chance")], [row(0.7), row(0.3, "chance")]])
    assert [entry["value"] for entry in rows] == pytest.approx([0.6, 0.2]) and rows[0]["note"] is None
    assert mean_of_draws([failed, failed]) == failed


def test_every_object_is_in_one_set_of_a_partition_whatever_their_order():
    names = [f"object {number}" for number in range(23)]
    groups = list(partitions(names, 0))
    assert sorted(sum(groups, [])) == sorted(5 * names) and {len(group) for group in groups} == {11, 12}
    assert list(partitions(names[::-1], 0)) == groups
    assert list(partitions(names[:3], 0)) and all(len(group) == 3 for group in partitions(names[:3], 0))


@pytest.fixture
def whole(make_workspace, pear, settings):
    """The workspace after a run on two shapes, and the rows."""
    benchmark = dataclasses.replace(
        settings, methods=["harris", "random"], perturbations=["noise", "light"], draws=2, pairs=["noise+light"],
        severities={"noise": [0.001, 0.02], "light": [60.0]}, used=["harris", "random"], most=2, objects=[],
            count=14,
    )  # fmt: skip

    workspace = make_workspace({"stability": dataclasses.asdict(benchmark)})
    write_mesh(workspace.data / "meshes/pear.npz", pear)
    write_mesh(workspace.data / "meshes/flat.npz", Mesh(pear.vertices * [1, 0.6, 0.4], pear.faces))
    write_table(workspace.data / "weights/weights.csv", weight_table({}, "gaze"))
    run(workspace)
    return workspace, read_rows(workspace.measurements / "stability.csv.gz")


@pytest.mark.slow
def test_points_are_used_on_the_object_as_it_is_and_a_pair_has_no_severity(whole):
    workspace, rows = whole
    lod = rows[rows["metric"] == "lod_mean"].pivot_table(
        index="item", columns=["method", "perturbation"], values="value"
    )
    assert set(lod.columns.get_level_values(1)) == {"none", "plain", "noise", "light"}
    assert (lod["harris", "none"] == lod["harris", "light"]).all()  # who does not look keeps the same points
    assert (lod["harris", "none"] != lod["harris", "plain"]).all() and (
        lod["random", "none"] != lod["random", "light"]
    ).all()
    assert (lod["harris", "plain"] == lod["random", "plain"]).all() and (lod > 0).all(axis=None)
    assert set(rows.loc[rows["metric"] == "lod_salient", "method"]) == {"harris"}
    known = rows[(rows["metric"] == "recognised") & (rows["perturbation"] == "none")]
    assert (known["value"] > 0.8).all() and set(known["item"]) == {"pear", "flat"}  # touched where it was learned
    stored = read_arrays(workspace.data / "stability/touches/pear.npz")
    assert stored["harris.noise"].shape[1] == 41 and "random.learned" in stored

    again = rows[(rows["metric"] == "repeatability") & (rows["method"] == "harris") & (rows["item"] == "pear")]
    assert list(again["perturbation"]) == ["noise", "noise", "light", "noise+light"]
    assert again["severity"].isna().tolist() == [False, False, False, True]
    alone, paired = (again.loc[again["perturbation"] == name, "value"].iloc[0] for name in ("noise", "noise+light"))
    assert paired == pytest.approx(alone, abs=0.3)  # no light for who does not look; one draw beside the mean of two
    metrics = read_json(workspace.metrics / "stability.json")
    assert metrics["repeatability"]["light.harris"] == 1 and metrics["simplified"] == {}


@pytest.mark.slow
def test_draws_of_one_are_the_rows_that_were_always_there(disturbed, settings, tmp_path):
    """The first draw has the random numbers of a run with one: the default run does not move."""
    first = dataclasses.replace(settings, methods=["harris"], perturbations=["noise"], draws=1, pairs=["noise+noise"])
    rows = process("pear", tmp_path, disturbed.root / "data/test", first, 0)
    wanted = [row for row in disturbed.rows if row["method"] == "harris" and row["perturbation"] == "noise"]
    noisy = [row for row in rows if row["perturbation"] == "noise"]
    assert [row["value"] for row in noisy] == [row["value"] for row in wanted]

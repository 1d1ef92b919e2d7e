"""The faces that an object needs to be seen, felt and recognised: where the truth is known, and through the stage."""

import numpy as np
import pandas as pd
import pytest

from haptic_glance.base.files import write_arrays, write_mesh, write_table
from haptic_glance.lod.scene import build_lod_chain
from haptic_glance.lod.scene.chain import finest
from stages.engine.rows import read_rows
from stages.face_needs import Params
from stages.face_needs.__main__ import accuracies, coarsest, differences, felt, run, seen, summary
from stages.scene.compare import write_chain
from tests.scene.conftest import bumpy

SETTINGS = Params([0.5, 2.0], 3, [60, 80], 40.0, 1.0, "glance", 12, [16, 16], 0.01, [0.02, 0.1], 0.02, 3, 2)


@pytest.fixture(scope="module")
def mesh():
    return bumpy(0)


@pytest.fixture(scope="module")
def chain(mesh):
    return build_lod_chain(mesh)


@pytest.mark.parametrize(
    ("passes", "level"), [([1, 1, 1], 2), ([1, 1, 0, 1], 1), ([1, 0, 1, 1], 0), ([0, 1, 1], 0), ([1], 0)]
)
def test_a_level_is_enough_if_it_and_all_finer_ones_are(passes, level):
    assert coarsest(np.array(passes)) == level


@pytest.mark.slow
def test_an_object_seen_from_afar_needs_fewer_faces(mesh, chain):
    near, far = (seen(mesh, chain, 0.15, distance, SETTINGS) for distance in (0.5, 2.0))
    assert near[0] == far[0] == 0 and near[-1] > far[-1] > 0
    assert near[-1] / far[-1] == pytest.approx(4, rel=0.4)  # pixels a metre go with one over the distance
    assert coarsest(near <= 1) < coarsest(far <= 1)


@pytest.mark.slow
def test_the_array_reads_the_same_on_the_same_surface_and_less_so_on_coarser_ones(mesh, chain):
    places = np.arange(0, len(mesh.vertices), 200)
    off = differences(felt(mesh, chain, places, SETTINGS))
    assert off[0] == 0 and 0 < off[1] < off[len(off) // 2] < off[-1]
    assert not differences(felt(mesh, [finest(mesh)] * 3, places, SETTINGS)).any()


def samples(seed=0):
    """Two objects of six levels whose features lie apart, until the last level is that of the other one."""
    draw = np.random.default_rng(seed)
    centres = draw.normal(size=(2, 41)) * 5
    levels = [draw.normal(size=(2, 12, 41)) + centres[:, None] for _ in range(5)]
    levels.append(levels[0][::-1])
    first, second = np.stack(levels, axis=1)
    return {"one": first, "other": second}


@pytest.mark.slow
def test_an_object_is_known_until_its_model_is_that_of_another_and_every_place_is_held_out():
    shares = accuracies(samples(), SETTINGS, 0)
    assert shares["one"].tolist() == shares["other"].tolist() == [1.0] * 5 + [0]
    places_by_object = samples()
    places_by_object["other"] = places_by_object["other"][:3]  # an object with fewer levels keeps its last
    places_by_object["one"][0, 0] = places_by_object["other"][0].mean(
        axis=0
    )  # one place of twelve feels like the other object
    shares = accuracies(places_by_object, SETTINGS, 0)
    assert shares["other"].shape == (6,) and shares["one"][0] == pytest.approx(11 / 12)


@pytest.mark.slow
def test_the_stage_has_a_row_an_object_task_and_condition(make_workspace, chain, mesh):
    workspace = make_workspace({"face_needs": vars(SETTINGS)})
    meshes = {"one": mesh, "two": bumpy(1)}
    for name, shape in meshes.items():
        write_mesh(workspace.data / f"meshes/{name}.npz", shape)
        write_chain(workspace.data / "scene/levels" / name, "ours", chain if name == "one" else build_lod_chain(shape))
        points = np.arange(0, 2400, 200)
        write_arrays(workspace.data / f"salient_points/{name}.npz", **{"glance.points": points, "glance.strong": 2})
    write_table(workspace.data / "meshes/manifest.csv", pd.DataFrame({"object": [*meshes], "size": 0.15}))
    run(workspace)
    rows = read_rows(workspace.measurements / "face_needs.csv.gz")
    needs = rows[rows["metric"] == "faces"].pivot(index="item", columns=["task", "condition"], values="value")
    assert needs.shape == (2, 6) and (needs["full"].iloc[:, 0] == len(mesh.faces)).all()
    assert (needs["seen"][0.5] > needs["seen"][2.0]).all() and (needs["felt"][0.02] > needs["felt"][0.1]).all()
    together = rows[rows["metric"] == "faces_together"]
    assert len(together) == 1 and 12 <= together["value"].iloc[0] <= len(mesh.faces)
    assert set(summary(rows.to_dict("records"))) >= {"seen_0.5", "felt_0.02", "recognised_0.02"}

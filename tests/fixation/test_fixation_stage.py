"""The stage on four shapes, in a folder of its own, with an untrained network: nothing is fetched."""

import shutil

import numpy as np
import pytest

from haptic_glance.base.fetch import FetchError
from haptic_glance.base.files import read_arrays, sha256, write_arrays, write_mesh, write_text
from stages.engine.rows import read_rows
from stages.fixation import Params, backbone
from stages.fixation import __main__ as stage
from stages.fixation.tasks import SEMANTICS

pytestmark = pytest.mark.slow

METHOD = "mobilenet_v2-random"
SETTINGS = {
    "parallels": 1, "azimuths": 3, "size": 64, "projection": "camera",
    "methods": [METHOD], "source": "package", "device": "cpu",
    "penalties": [0.01], "folds": 2, "rate": 0.01, "rates": [0.01, 0.03], "epochs": 1, "batch": 4, "momentum": 0.9,
}  # fmt: skip


MESHES = {"source": "folder", "folder": "", "up": "z", "unit": "", "objects": [], "classes": {}, "strict": False}


@pytest.fixture
def run(shapes, make_workspace):
    """A function that runs the stage with some settings changed and returns the workspace."""

    def go(names=("ball", "egg", "torus", "tube"), **changed):
        workspace = make_workspace({"meshes": MESHES, "fixation": SETTINGS | changed})
        lines = ["dataset,object,living,category"]
        for number, name in enumerate(names):
            mesh = shapes[name]
            write_mesh(workspace.data / f"meshes/{name}.npz", mesh)
            values = np.linspace(0, 1, len(mesh.vertices)).astype(np.float32)
            write_arrays(workspace.data / f"salient_points/{name}.npz", **{"glance.saliency": values})
            lines.append(f"folder,{name},{'yes' if number < 2 else 'no'},{'round' if number < 2 else 'hollow'}")
        ball = shapes["ball"]
        density = np.exp(-20 * ((ball.vertices - [0.5, 0, 0]) ** 2).sum(axis=1))
        path = workspace.data / "weights/ground_truth/ball.npz"
        write_arrays(path, amounts=density, density=density, areas=ball.vertex_areas)
        write_text(workspace.root / SEMANTICS, "\n".join(lines))
        stage.run(workspace)
        return workspace

    return go


def rows_of(workspace):
    return read_rows(workspace.measurements / "fixation.csv.gz")


def test_stage_writes_the_contract_the_same_bytes_twice_without_networks_that_have_no_weights(
    run, shapes, monkeypatch, capsys
):
    build = backbone.build

    def missing(name, *options):
        if name == "resnet101":
            raise FetchError("nobody carries it")
        return build(name, *options)

    monkeypatch.setattr(backbone, "build", missing)
    workspace = run(methods=[METHOD, "resnet101-frozen"])
    captured = capsys.readouterr()
    assert "4 objects, 5 views" in captured.out and "resnet101-frozen is left out: nobody carries it" in captured.err
    folder, rows = workspace.data / "fixation", rows_of(workspace)
    assert rows.loc[rows["method"] == "resnet101-frozen", "note"].tolist() == ["nobody carries it"]
    check_files(folder, rows, len(shapes["ball"].vertices))
    check_judged(rows)
    assert not list(folder.glob(".*"))  # the caches are gone
    before = {path.relative_to(folder): sha256(path) for path in folder.rglob("*") if path.is_file()}
    shutil.rmtree(workspace.build)  # or else all comes from the cache
    run(methods=[METHOD, "resnet101-frozen"])
    assert before == {path.relative_to(folder): sha256(path) for path in folder.rglob("*") if path.is_file()}


def check_files(folder, rows, n):
    """The arrays of the ball, of n vertices, the classes of the objects and the elbow."""
    stored = read_arrays(folder / "ball.npz")
    tasks = ["convexity", "curvature", "eccentricity", "level_1", "level_2", "level_3"]
    kept = [task for task in tasks if f"{METHOD}.{task}" in stored]
    assert kept[-3:] == tasks[-3:] and len(kept) > 3
    names = [f"{METHOD}.{name}" for name in (*kept, "ewigc", "ewigc_l4", "average")]
    for name in names:
        assert stored[name].shape == (n,) and stored[f"{name}.views"].shape == (3, n)
        assert stored[name].min() >= 0 and stored[name].max() <= 1
    assert stored[f"{METHOD}.maps"].shape == (3, len(kept), 2, 2)
    assert stored["visible"].shape == (3, n) and stored["seen"].mean() > 0.9
    assert {key for key, values in stored.items() if values.ndim == 1 and "." in key} == set(names)
    level = rows[(rows["metric"] == "class") & (rows["task"] == "level_2")].set_index("item")["label"]
    assert level.to_dict() == {"ball": "round", "egg": "round", "torus": "hollow", "tube": "hollow"}
    assert rows.loc[rows["metric"] == "ssd", "value"].gt(0).any() and (rows["chosen"].astype(str) == "True").any()


def check_judged(rows):
    """Models, rivals and controls are judged where people looked."""
    judged = rows[rows["metric"] == "pcc"]
    assert set(judged["item"]) == {"ball"} and set(judged["view"]) == {"0", "1", "2", "all"}
    assert {("control", "centre_prior"), ("control", "random"), ("rival", "glance"), (METHOD, "ewigc")} <= set(
        zip(judged["method"], judged["task"], strict=True)
    )
    accuracy = rows[(rows["metric"] == "accuracy") & (rows["method"] == METHOD)]
    assert set(accuracy["split"]) == {"views", "objects"}
    alone = accuracy[(accuracy["task"] == "level_3") & (accuracy["split"] == "objects")].iloc[0]
    assert np.isnan(alone["value"]) and alone["note"] == "each object is a class of its own"


@pytest.mark.parametrize("mode", backbone.TRAINED)
def test_networks_trained_for_each_task_run_beside_the_frozen_way(run, monkeypatch, mode):
    monkeypatch.setitem(backbone.MODES, mode, "random")  # from scratch: no weights are fetched here
    rows = rows_of(run(methods=[f"mobilenet_v2-{mode}"]))
    trained = rows[rows["method"] == f"mobilenet_v2-{mode}"]
    assert {"accuracy", "chance", "views", "entropy", "pcc"} <= set(trained["metric"])
    rates = trained.loc[trained["metric"] == "rate", "value"].tolist()
    assert rates in ([0.01], [0.03]) if mode == "last_block" else not rates


def test_a_network_that_diverges_ends_the_run_and_looks_nowhere_in_no_row(run, monkeypatch):
    monkeypatch.setitem(backbone.MODES, "finetuned", "random")
    with pytest.raises(ValueError, match="diverged: loss is not finite in pass 1: take a lower learning rate"):
        run(methods=["mobilenet_v2-finetuned"], rate=1e30)


@pytest.mark.parametrize("changed", [{"size": 8}, {"folds": 1}, {"methods": []}, {"device": "abacus"}])
def test_settings_that_no_run_can_have_are_refused(changed):
    with pytest.raises(ValueError):
        backbone.check(Params(**SETTINGS | changed))

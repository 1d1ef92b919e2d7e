"""The stage on four shapes, in a folder of its own, with an untrained network: nothing is fetched."""

import sys

import numpy as np
import pytest
import torch
import yaml

from stages.fixation import __main__ as stage
from stages.fixation import options, read_attention
from stages.fixation.backbone import maps_of
from stages.fixation.options import method_named
from stages.fixation.schema import Params
from stages.kit.fetch import FetchError
from stages.kit.files import read_arrays, read_table, sha256, write_arrays, write_mesh
from stages.kit.params import params

METHOD = "mobilenet_v2-random"
SETTINGS = {
    "parallels": 1, "azimuths": 3, "size": 64, "methods": [METHOD], "source": "package", "device": "cpu",
    "penalties": [0.01], "folds": 2, "rate": 0.01, "epochs": 1, "batch": 4, "momentum": 0.9,
}  # fmt: skip


@pytest.fixture
def run(shapes, tmp_path, monkeypatch):
    """A function that runs the stage with some settings changed."""
    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr(sys, "argv", ["stages/fixation/__main__.py"])
    monkeypatch.setattr(sys, "excepthook", sys.excepthook)
    lines = ["dataset,object,living,category"]
    for number, name in enumerate(("ball", "egg", "torus", "tube")):
        mesh = shapes[name]
        write_mesh(f"data/meshes/{name}.npz", mesh)
        values = np.linspace(0, 1, len(mesh.vertices)).astype(np.float32)
        write_arrays(f"data/salient_points/{name}.npz", **{"enhanced.saliency": values})
        lines.append(f"test,{name},{'yes' if number < 2 else 'no'},{'round' if number < 2 else 'hollow'}")
    density = np.exp(-20 * ((shapes["ball"].vertices - [0.5, 0, 0]) ** 2).sum(axis=1))
    write_arrays("data/weights/lessons/ball.npz", amounts=density, density=density, areas=shapes["ball"].vertex_areas)
    (tmp_path / "data/reference").mkdir()
    (tmp_path / "data/reference/semantics.csv").write_text("\n".join(lines) + "\n")

    def go(**changed):
        settings = {"seed": 0, "meshes": {"source": "test"}, "parallel": {"backend": "sequential"}}
        (tmp_path / "params.yaml").write_text(yaml.safe_dump(settings | {"fixation": SETTINGS | changed}))
        params.cache_clear()
        stage.main()

    yield go
    params.cache_clear()


def test_stage_writes_the_contract_the_same_bytes_twice(run, shapes, tmp_path):
    run()
    folder = tmp_path / "data/fixation"
    stored = read_arrays(folder / "ball.npz")
    n = len(shapes["ball"].vertices)
    tasks = ["convexity", "curvature", "eccentricity", "level_1", "level_2", "level_3"]
    kept = [task for task in tasks if f"{METHOD}.{task}" in stored]
    assert kept[-3:] == tasks[-3:] and len(kept) > 3
    for name in (*kept, "ewigc", "ewigc_l4", "average"):
        assert stored[f"{METHOD}.{name}"].shape == (n,) and stored[f"{METHOD}.{name}.views"].shape == (3, n)
        assert stored[f"{METHOD}.{name}"].min() >= 0 and stored[f"{METHOD}.{name}"].max() <= 1
    assert stored[f"{METHOD}.maps"].shape == (3, len(kept), 2, 2)
    assert stored["visible"].shape == (3, n) and stored["seen"].mean() > 0.9
    assert set(read_attention(folder / "ball.npz")) == {
        f"{METHOD}.{name}" for name in (*kept, "ewigc", "ewigc_l4", "average")
    }
    assert len(read_table(folder / "tasks.csv")) == 4
    assert list(read_table(folder / "elbow.csv")) == ["task", "clusters", "ssd", "chosen"]
    assert not list(folder.glob(".*"))  # the caches are gone
    before = {path.relative_to(folder): sha256(path) for path in folder.rglob("*") if path.is_file()}
    run()
    assert before == {path.relative_to(folder): sha256(path) for path in folder.rglob("*") if path.is_file()}


def test_stage_judges_models_rivals_and_controls_where_people_looked(run, capsys):
    run()
    rows = read_table("reports/measurements/fixation.csv")
    judged = rows[rows["metric"] == "pcc"]
    assert set(judged["object"]) == {"ball"} and set(judged["view"]) == {"0", "1", "2", "all"}
    assert {("control", "centre_prior"), ("control", "random"), ("rival", "enhanced"), (METHOD, "ewigc")} <= set(
        zip(judged["method"], judged["task"], strict=True)
    )
    accuracy = rows[rows["metric"] == "accuracy"]
    assert set(accuracy["split"]) == {"views", "objects"}
    alone = accuracy[(accuracy["task"] == "level_3") & (accuracy["split"] == "objects")].iloc[0]
    assert np.isnan(alone["value"]) and alone["note"] == "each object is a class of its own"
    assert "4 objects, 5 views" in capsys.readouterr().out


def test_finetuning_runs_beside_the_frozen_way(run, monkeypatch):
    monkeypatch.setitem(options.MODES, "finetuned", "random")  # from scratch: no weights are fetched here
    run(methods=["mobilenet_v2-finetuned"])
    rows = read_table("reports/measurements/fixation.csv")
    own = rows[rows["method"] == "mobilenet_v2-finetuned"]
    assert {"accuracy", "chance", "views", "entropy", "pcc"} <= set(own["metric"])


def test_a_network_without_weights_is_left_out_with_the_reason(run, monkeypatch, capsys):
    def missing(name, *_):
        if name == "resnet101":
            raise FetchError("nobody carries it")

    monkeypatch.setattr(options, "build", missing)
    run(methods=[METHOD, "resnet101-frozen"])
    rows = read_table("reports/measurements/fixation.csv")
    assert rows.loc[rows["method"] == "resnet101-frozen", "note"].tolist() == ["nobody carries it"]
    assert "resnet101-frozen is left out: nobody carries it" in capsys.readouterr().err


@pytest.mark.parametrize("name", ["mobilenet_v2", "mobilenet_v2-thawed", "-frozen"])
def test_an_unknown_method_is_named(name):
    with pytest.raises(ValueError, match="NETWORK-MODE"):
        method_named(name)


@pytest.mark.parametrize("changed", [{"size": 8}, {"folds": 1}, {"methods": []}, {"device": "abacus"}])
def test_settings_that_no_run_can_have_are_refused(changed):
    with pytest.raises(ValueError):
        options.checked(Params(**SETTINGS | changed))


def test_too_little_memory_names_the_remedy():
    class Hungry:
        convolutions = torch.nn.Conv2d(3, 1, 1)

        def parameters(self):
            return self.convolutions.parameters()

    def too_much(images):
        raise torch.OutOfMemoryError("CUDA out of memory")

    Hungry.convolutions.forward = too_much
    with pytest.raises(ValueError, match="too little memory: take a smaller batch"):
        maps_of(Hungry(), np.zeros((1, 4, 4), dtype=np.uint8))

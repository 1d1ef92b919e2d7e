"""The stage on small objects with marks: what it writes, and which objects are trained again."""

import numpy as np
import pytest

from haptic_glance.base.files import read_arrays, read_json, read_table, write_arrays, write_mesh, write_text
from haptic_glance.look.views import FOUR
from haptic_glance.look.weights import METHODS, read_learned_weights
from haptic_glance.look.weights.weights import read_models
from haptic_glance.mesh.mesh import Mesh
from stages.engine.rows import read_rows
from stages.weights import __main__ as stage
from stages.weights.training import gain_rows, shape_rows, train_object

SECTIONS = {
    "weights": {"method": "fixations", "svm": "object"},
    "meshes": {"source": "folder", "folder": "", "up": "z", "unit": "m", "objects": [], "strict": False, "classes": {}},
}
CHANNELS = ["edge", "symmetry"]


@pytest.fixture
def workspace(make_workspace):
    return make_workspace(SECTIONS)


@pytest.fixture
def add_object(workspace, ball, spot, make_maps):
    """A function that writes the mesh and the maps of an ellipsoid, and marks at the given vertices."""

    def add(name, height, vertices=()):
        mesh = Mesh(ball.vertices * (1, 1, height), ball.faces)
        write_mesh(workspace.data / "meshes" / f"{name}.npz", mesh)
        maps = make_maps(mesh, spot * (1, 1, height), FOUR, channels=CHANNELS)
        arrays = {"maps": np.stack([maps[channel] for channel in CHANNELS], axis=1).astype(np.float16)}
        arrays |= {"mask": arrays["maps"].max(axis=1) > 0, "viewpoints": [viewpoint.name for viewpoint in FOUR]}
        write_arrays(workspace.data / "conspicuity" / f"{name}.npz", **arrays, channels=CHANNELS)
        mark(name, mesh, vertices)

    def mark(name, mesh, vertices):
        lines = [
            f"ann,2026-11-20T10:00:00.000Z,{vertex},{','.join(f'{x:.6f}' for x in mesh.vertices[vertex])}"
            for vertex in vertices
        ]
        if lines:
            path = workspace.root / "data/annotations" / f"{name}.csv"
            write_text(path, "\n".join(["annotator,time,vertex,x,y,z", *lines]))

    return add


@pytest.fixture
def objects(add_object, ball, spot):
    near = np.argsort(np.linalg.norm(ball.vertices - spot, axis=1))
    add_object("ball", 1, near[:6])
    add_object("egg", 0.8, near[2:9])
    add_object("plain", 0.6)
    return near


def run(workspace, monkeypatch):
    """Runs the stage; returns the names that training data was collected for, and those that were trained."""
    collected, trained = [], []
    collect, fit = stage.collect_training_data, stage.train_object

    def noted_collect(name, *rest):
        collected.append(name)
        return collect(name, *rest)

    def noted_train(name, *rest, **more):
        trained.append(name)
        return fit(name, *rest, **more)

    noted_train.__module__, noted_train.__qualname__ = fit.__module__, fit.__qualname__
    with monkeypatch.context() as patch:
        patch.setattr(stage, "collect_training_data", noted_collect)
        patch.setattr(stage, "train_object", noted_train)
        stage.run(workspace)
    return collected, trained


@pytest.mark.slow
def test_the_stage_writes_weights_ground_truth_svms_and_rows_and_trains_again_only_where_data_changed(
    workspace, objects, add_object, monkeypatch, capsys
):
    assert run(workspace, monkeypatch) == (["ball", "egg"], ["ball", "egg"])
    assert "2 of 3 objects have ground truth; the glance takes fixations" in capsys.readouterr().out
    folder = workspace.data / "weights"
    files = {str(path.relative_to(folder)) for path in folder.rglob("*.*")}
    names = {f"{part}/{name}.npz" for part in ("ground_truth", "svm") for name in ("ball", "egg")}
    assert files == {"weights.csv", "convexity.csv", "svm.npz", *names}
    assert set(read_arrays(folder / "ground_truth/ball.npz")["points"]) == set(objects[:6])
    assert list(read_table(folder / "convexity.csv").object) == ["ball", "egg"]
    learned = read_learned_weights(folder, "plain", Mesh(np.eye(3), [(0, 1, 2)]))
    assert "guided_ed" in learned.weights and "svm" in learned.svms
    check_rows(workspace)
    before = (folder / "weights.csv").read_bytes()
    add_object("another", 0.9)
    assert run(workspace, monkeypatch) == ([], [])
    assert (folder / "weights.csv").read_bytes() == before
    add_object("another", 0.9, objects[:5])
    assert run(workspace, monkeypatch) == (["another"], ["another", "ball", "egg"])


def check_rows(workspace):
    """Rows hold points, weights and accuracies of the ball and the egg."""
    rows = read_rows(workspace.measurements / "weights.csv.gz").fillna({"item": ""})
    assert rows[rows.metric == "points"].set_index("item").value.to_dict() == {"ball": 6, "egg": 7}
    weights = rows[rows.metric == "weight"]
    table = read_table(workspace.data / "weights" / "weights.csv").fillna({"left_out": ""})
    keys, stored = weights[["item", "method", "channel"]], table[["left_out", "method", "channel"]]
    assert stored.values.tolist() == keys.values.tolist()
    assert weights.value.tolist() == pytest.approx(table.weight.tolist())
    assert set(weights[weights.method == "glance"].item) == {"", "ball", "egg"}
    gains = rows[rows.metric == "information_gain"]
    assert set(map(tuple, gains[["item", "area", "channel"]].to_numpy())) == {
        (name, area, channel) for name in ("ball", "egg") for area in ("object", "image") for channel in CHANNELS
    }
    convexity = rows[rows.metric == "convexity"].set_index("item").value
    assert convexity.to_dict() == pytest.approx({"ball": 1.0, "egg": 1.0})
    accuracies = rows[rows.metric == "accuracy"]
    assert set(accuracies.item) == {"", "ball", "egg"}
    assert accuracies[["area", "training", "validation"]].notna().all().all()
    assert set(accuracies[accuracies.item == ""].training) == {"one_for_all"}
    metrics = read_json(workspace.metrics / "weights.json")
    means = accuracies.groupby(["area", "training", "validation"]).value.mean()
    expected = {".".join(("svm", *key)): value for key, value in means.items()} | {"objects": 2}
    assert metrics == pytest.approx(expected, abs=1e-5)


@pytest.mark.slow
def test_marks_of_another_mesh_leave_the_object_out_with_a_note(workspace, objects, add_object, capsys):
    path = workspace.root / "data/annotations/egg.csv"
    write_text(path, path.read_text().replace("0.", "0.9"))
    stage.run(workspace)
    assert "weights: egg is left out: " in capsys.readouterr().err
    rows = read_rows(workspace.measurements / "weights.csv.gz")
    points = rows[rows.metric == "points"].set_index("item")
    assert points.value["ball"] == 6 and np.isnan(points.value["egg"]) and "off the mesh" in points.note["egg"]
    assert not (workspace.data / "weights/svm/egg.npz").exists()


def test_without_ground_truth_only_the_published_weights_are_written(add_object, make_workspace):
    add_object("plain", 0.6)
    workspace = make_workspace(SECTIONS | {"weights": {"method": "gaze", "svm": "object"}})
    stage.run(workspace)
    assert [path.name for path in (workspace.data / "weights").iterdir()] == ["weights.csv"]
    rows = read_rows(workspace.measurements / "weights.csv.gz")
    assert set(rows.metric) == {"weight"} and set(rows.method) == {*METHODS} and rows.item.isna().all()
    assert read_json(workspace.metrics / "weights.json") == {"objects": 0}


@pytest.mark.parametrize(("trained_on", "prefix"), [("object", ""), ("picture", "image_")])
@pytest.mark.slow
def test_svms_of_an_object_learn_from_its_own_pixels_or_from_all_of_the_picture(tmp_path, trained_on, prefix):
    generator = np.random.default_rng(0)
    arrays = {"distances": np.zeros((2, 3)), "channels": np.array(["color", "edge", "symmetry"])}
    for kind, shift in (("", 0.0), ("image_", 5.0)):
        labels = np.arange(1400) % 2 == 0
        arrays[f"{kind}pixels"] = generator.normal(shift, 1, (1400, 3)) + labels[:, None]
        arrays |= {f"{kind}labels": labels, f"{kind}views": np.arange(1400) // 700}
    write_arrays(tmp_path / "made/ball.npz", **arrays)
    train_object("ball", tmp_path, tmp_path / "made", 0, trained_on)
    model = read_models(tmp_path / "svm/ball.npz", "object")[0]
    pixels = arrays[f"{prefix}pixels"]
    whole = np.abs(model.center - pixels.mean(axis=0)).max() < 1e-9
    assert np.abs(model.center - pixels.mean(axis=0)).max() < 0.2 and whole == (trained_on == "picture")


def test_the_gain_of_a_channel_that_tells_the_classes_is_one_bit_and_of_noise_none():
    labels = np.arange(4000) % 4 == 0
    noise = np.random.default_rng(0).random(4000)
    pixels = np.stack([labels, noise, np.ones(4000)], axis=1)
    record = {"channels": np.array(["edge", "dkl", "color"]), "pixels": pixels, "labels": labels}
    record |= {"image_pixels": pixels, "image_labels": np.ones(4000, bool)}  # of one class: no gain can be told
    rows = gain_rows("mug", record, 0)
    assert [(row["channel"], row["area"]) for row in rows] == [
        ("edge", "object"),
        ("dkl", "object"),
        ("color", "object"),
    ]
    assert [row["value"] for row in rows] == pytest.approx([1, 0, 0], abs=0.01)  # classes balanced: 0.81 bits otherwise


def test_extremes_and_deviation_of_distances_of_shapes_by_hand(ball):
    def values(mesh):
        return {row["metric"]: row["value"] for row in shape_rows("mug", mesh)}

    assert values(ball) == pytest.approx({"convexity": 1, "extremes": 1, "distances_deviation": 0}, abs=0.01)
    # A needle along x, from 0 to 1: distances from its middle are uniform in 0..0.5.
    xs = np.linspace(0, 1, 400)
    strip = np.concatenate([np.stack([xs, np.full(400, y), np.zeros(400)], axis=1) for y in (0, 1e-3)])
    k = np.arange(399)
    faces = np.concatenate([np.stack([k, k + 1, k + 400], axis=1), np.stack([k + 1, k + 401, k + 400], axis=1)])
    needle = values(Mesh(strip, faces))
    assert needle["extremes"] == pytest.approx(2, rel=0.01)
    assert needle["distances_deviation"] == pytest.approx(3**-0.5, rel=0.01)
    moved = values(Mesh(strip * 7 + 5, faces))
    assert moved == pytest.approx(needle)

"""What the report says of where networks look (T3.3), on rows and maps whose truth is known."""

import shutil
from functools import partial
from itertools import combinations

import matplotlib.pyplot as plt
import numpy as np
import pandas as pd
import pytest

from haptic_glance.base.files import write_arrays
from stages.charts.items import Figure
from stages.charts.results import NotRun
from stages.engine.statistics import interval
from stages.fixation import agreement_report, agreement_rows, attention_pictures
from stages.fixation import report as topic
from stages.fixation.agreement import ALL_VIEWS
from stages.report.parts import build_item
from tests.frames import has_ink, only

NETWORKS = ["mobilenet_v2-frozen", "mobilenet_v2-finetuned", "vgg16-frozen", "resnet50-frozen", "vgg16-last_block",
            "resnet50-last_block", "mobilenet_v2-random", "vgg16-random", "resnet50-random"]  # fmt: skip
TASKS = {"level_1": 0.35, "level_2": 0.35, "level_3": 0.1, "convexity": 0.15, "curvature": 0.35, "eccentricity": 0.35,
         "ewigc": 0.4, "ewigc_l4": 0.3}  # fmt: skip
OTHERS = {("rival", "mesh_saliency"): 0.15, ("rival", "glance"): 0.6, ("control", "centre_prior"): 0.2,
          ("control", "random"): 0.0}  # fmt: skip
DISTANCES = {"ewigc": 0.1, "ewigc_l4": 0.15, "mesh_saliency": 0.2, "glance": 0.08, "centre_prior": 0.2,
             "random": 0.05}  # fmt: skip
ALIKE = {"vgg16-last_block": 0.5, "resnet50-last_block": 0.7}  # mean correlation of two tasks' maps; 0.4 for others
VIEWED = ["figure_3_29", "figure_3_30", "figure_3_34"]


table = partial(build_item, topic, "tables", "fixation")
figure = partial(build_item, topic, "figures")


def rows(dataset="gaze", count=6, resnet=0.0, **means):
    """Rows of objects that differ far more than methods do: each adds its own level to all of them.

    resnet: what ResNet50 gains in PCC, and how much nearer its centres lie.
    """
    random, entries = np.random.default_rng(0), []
    known = {(method, task): mean - 0.3 * method.endswith("-random") for method in NETWORKS
             for task, mean in TASKS.items()} | OTHERS  # fmt: skip
    known |= {(method, task): mean for method in NETWORKS for task, mean in means.items()}
    for level, name in zip(np.linspace(-0.2, 0.2, count), "abcdefgh", strict=False):
        for (method, task), mean in known.items():
            row = {"item": name, "method": method, "task": task, "seconds": 2.0 if "-" in method else None}
            gain = resnet if method == "resnet50-last_block" else 0.0
            value = mean + gain + level + 0.002 * random.normal()
            for view in range(3):
                entries.append(row | {"view": view, "metric": "pcc", "value": value + 0.1 * (view - 1)})
                entries.append(row | {"view": view, "metric": "pcc_masked", "value": value + 0.2})
                if task in DISTANCES:
                    far = DISTANCES[task] - gain + 0.1 * (level + 0.2) + 0.0002 * random.normal()
                    entries.append(row | {"view": view, "metric": "distance", "value": far})
                    entries.append(row | {"view": view, "metric": "distance_mean", "value": 2 * far})
            for metric, whole in {"pcc": 0.9, "nss": 2 * value, "auc": 0.5 + value / 4}.items():
                entries.append(row | {"view": ALL_VIEWS, "metric": metric, "value": whole})
        entries += [entry for method in NETWORKS for entry in of_network(name, method, level)]
    entries += [entry for method in NETWORKS for entry in taught(method)]
    return pd.DataFrame(entries).assign(dataset=dataset, seed=0)


def of_network(name, method, level):
    """Rows of what an object cost, and how alike its maps are."""
    row = {"item": name, "method": method, "view": ALL_VIEWS}
    yield row | {"view": None, "metric": "views", "value": 29, "seconds": 1.0}
    for k, (first, second) in enumerate(combinations(["level_1", "level_2", "convexity"], 2)):
        value = ALIKE.get(method, 0.4) + 0.1 * level + 0.1 * (k - 1)
        yield row | {"task": f"{first}~{second}", "metric": "pcc_tasks", "value": value}


def taught(method):
    """Rows of heads, or of a network for each task, that learned."""
    seconds = 100.0 if method.endswith("-finetuned") else 1.0
    for task in ("level_1", "level_2"):
        row = {"method": method, "task": task, "split": "views"}
        yield row | {"metric": "accuracy", "value": 0.9, "seconds": seconds}
        yield row | {"metric": "chance", "value": 0.5}


@pytest.fixture(scope="module")
def gaze(measure):
    """Results with rows of the meshes with human gaze, and of a run on marked objects."""
    return measure("fixation", pd.concat([rows(), rows("household", 4)]))


@pytest.fixture(scope="module")
def made(gaze):
    return table(gaze)


@pytest.fixture
def written(measure):
    """A function of rows, of a set or of those in their column, to the results."""
    return partial(measure, "fixation")


def test_score_of_an_object_is_the_mean_of_its_three_views_or_of_all_in_one(gaze):
    frame = gaze.rows("fixation", "gaze")
    scores = agreement_rows.scores(frame, "pcc")["vgg16-frozen", "ewigc"]
    assert scores["a"] == pytest.approx(0.4 - 0.2, abs=0.01)  # 0.9, of all views in one, is not among them
    assert agreement_rows.scores(frame, "nss")["vgg16-frozen", "ewigc"]["a"] == pytest.approx(0.4, abs=0.02)
    numbers = frame[frame["view"] != ALL_VIEWS].assign(view=lambda row: row["view"].astype(float))  # without the word
    pd.testing.assert_frame_equal(agreement_rows.scores(numbers, "pcc"), agreement_rows.scores(frame, "pcc"))


@pytest.mark.slow
def test_a_run_without_anyones_attention_still_says_how_alike_tasks_are(written):
    frame = rows("furniture")
    results = written(frame[frame["metric"] != "pcc"])
    assert figure("figure_3_31", results).paths[0].exists()
    with pytest.raises(NotRun, match="ground truth"):
        table(results)


@pytest.mark.slow
def test_gain_over_a_control_is_paired_so_that_hard_objects_do_not_widen_it(made):
    row = only(made.frame, truth="human gaze, 6 meshes", method="vgg16-frozen", task="ewigc", metric="pcc")
    assert row["mean"] == pytest.approx(0.4, abs=0.01)
    assert row["over_weights"] == pytest.approx(0.3, abs=0.01) and row["over_prior"] == pytest.approx(0.2, abs=0.01)
    assert row["over_lee"] == pytest.approx(0.25, abs=0.01)
    assert row["over_lee_high"] - row["over_lee_low"] < 0.05 < row["high"] - row["low"]
    far = only(made.frame, truth="human gaze, 6 meshes", method="vgg16-frozen", task="ewigc", metric="distance")
    assert far["mean"] == pytest.approx(12, abs=0.2) and far["over_lee"] == pytest.approx(-10, abs=0.2)  # per cent


@pytest.mark.slow
def test_no_interval_of_a_correlation_leaves_its_range(written):
    wild = np.array([1.0, 1.0, 1.0, -0.5])
    assert interval(wild)[2] > 1
    frame = rows(count=4)
    alike = frame["metric"] == "pcc_tasks"
    frame.loc[alike, "value"] = frame.loc[alike, "item"].map(dict(zip("abcd", wild, strict=True)))
    drawn = agreement_report.figure_3_31(written(frame)).drawing
    assert drawn.axes[0].get_title().endswith(", 1.00]")
    plt.close(drawn)


@pytest.fixture(scope="module")
def looked(tmp_path_factory, small):
    """Results of a run in which two networks have looked at two balls: attention is highest at their top."""
    root, mesh = small.make_root(tmp_path_factory.mktemp("looked")), small.ball()
    small.write_attention(root)
    classes = [{"item": "ball", "task": task, "metric": "class", "label": "1"} for task in TASKS if "ewigc" not in task]
    small.write_measurements(root, "fixation", pd.concat([rows("test", 4), pd.DataFrame(classes)]), "test")
    visible = mesh.vertices @ np.array([view.axes[2] for view in agreement_rows.VIEWPOINTS]).T > -0.05
    arrays, height = {"visible": visible.T, "seen": visible.any(axis=1)}, mesh.vertices[:, 2] + 0.5
    for method in ("mobilenet_v2-frozen", "mobilenet_v2-random"):
        arrays[f"{method}.maps"] = np.random.default_rng(0).random((3, len(TASKS) - 2, 7, 7)).astype(np.float16)
        for task in TASKS:
            arrays |= {f"{method}.{task}": height.astype(np.float16), f"{method}.{task}.views": np.stack([height] * 3)}
    for name in ("ball", "cube"):
        write_arrays(root / f"data/test/fixation/{name}.npz", **arrays)
    return small.read_results(root)


@pytest.mark.slow
@pytest.mark.parametrize("name", VIEWED)
def test_maps_are_drawn_on_the_object(looked, name):
    made = figure(name, looked)
    assert has_ink(made)


@pytest.mark.slow
def test_fused_attention_stands_beside_models_where_nobody_marked_anything(looked, tmp_path, small):
    root = shutil.copytree(looked.workspace.root, tmp_path / "root")
    shutil.rmtree(root / "data/test/weights/ground_truth")
    made = figure("figure_3_34", small.read_results(root))
    assert has_ink(made)


def test_a_map_is_drawn_where_it_is_high():
    cam = np.zeros((7, 7), dtype=np.float16)
    cam[1, 5] = 3
    picture = attention_pictures.large(cam[None], "mobilenet_v2-frozen")[
        0
    ]  # whose cells lie on pixels 0, 32, 64, ... of 224
    place = (60, 300)
    assert np.unravel_index(picture.argmax(), picture.shape) == pytest.approx(place, abs=3) and picture.max() > 0.98
    assert not attention_pictures.large(np.zeros((1, 7, 7)), "mobilenet_v2-frozen").any()


def test_a_picture_on_gaze_is_kept_with_its_words_where_the_meshes_are_absent(bare, small, monkeypatch):
    def figure_3_34(results, dataset=None):
        drawing, axes = plt.subplots()
        axes.plot([0, 1])
        return Figure(drawing)

    name = "figure_3_34_gaze"
    monkeypatch.setitem(topic.FIGURES, name, partial(attention_pictures.on_gaze, figure_3_34))
    results = small.read_results(bare)
    (bare / "data/gaze/fixation").mkdir(parents=True)
    drawn = figure(name, results)
    content = drawn.paths[0].read_bytes()
    (bare / "data/gaze/fixation").rmdir()
    kept = figure(name, results)
    assert drawn.alt == kept.alt and kept.alt.startswith("Meshes coloured from dark (low)")
    assert kept.paths == drawn.paths and kept.paths[0].read_bytes() == content
    kept.paths[0].unlink()
    with pytest.raises(NotRun, match="figure_3_34_gaze.png"):
        figure(name, results)

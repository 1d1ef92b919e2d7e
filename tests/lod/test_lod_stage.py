"""The stage's cells: nothing is dropped without a word, and the summary is paired."""

import dataclasses
import functools

import numpy as np
import pytest
import trimesh

from haptic_glance.base.files import read_mesh, read_table, write_arrays, write_mesh
from haptic_glance.lod import shrunk_rings, take_pictures
from haptic_glance.lod.export import face_count, file_name
from haptic_glance.lod.simplify import simplify
from haptic_glance.lod.task import Variant, variant
from haptic_glance.look.points.options import Detection
from haptic_glance.look.views import viewpoint_set
from haptic_glance.mesh.mesh import Mesh
from stages.engine.rows import read_rows
from stages.lod import Params
from stages.lod import __main__ as stage
from stages.lod.cell import ObjectInputs, measure_cells, measure_errors
from stages.salient_points.measure import write_points
from stages.weights.ground_truth import spread_on_surface

SETTINGS = Params(
    methods=["qem", "glance", "glance-soft", "itti", "random-area"], targets=["50%", "10%", "4000"], rings=3,
    backend="pymeshlab", samples=500, viewpoints="four", size=[48, 64], shrink=False,
)  # fmt: skip
SHRINKING = dataclasses.replace(SETTINGS, shrink=True)
FEW = dataclasses.replace(SHRINKING, methods=["qem", "glance"], targets=["50%", "10%"], samples=200)


def new_subject():
    ball = trimesh.creation.icosphere(subdivisions=3, radius=0.5)
    mesh = Mesh(ball.vertices, ball.faces)
    pictures = take_pictures(mesh, viewpoint_set("four"), (48, 64))
    points = {"glance": np.array([0, 300]), "random": np.array([5])}
    saliency = {"glance": ((mesh.vertices[:, 2] + 0.5).clip(0, 1)).astype(np.float32)}
    return ObjectInputs("ball", mesh, points, saliency, pictures)


@pytest.fixture(scope="module")
def subject():
    return new_subject()


@pytest.fixture(scope="module")
def rows(subject, tmp_path_factory):
    folder = tmp_path_factory.mktemp("lod")
    return folder, [row for method in SETTINGS.methods for row in measure_cells(subject, method, folder, SETTINGS, 0)]


def cell(rows, method, target):
    return {row["metric"]: row for row in rows if (row["method"], row["target"]) == (method, target)}


def test_a_feasible_cell_has_its_mesh_and_all_metrics(rows):
    folder, rows = rows
    metrics = cell(rows, "glance", "50%")
    assert set(metrics) >= {"faces", "metro_mean", "metro_rms", "metro_max", "ssim_error", "salient_error"}
    mesh = read_mesh(folder / "ball" / "glance_50pct.npz")
    assert len(mesh.faces) == metrics["faces"]["value"] == metrics["ssim_error"]["faces"] <= 640
    areas = trimesh.Trimesh(mesh.vertices, mesh.faces, process=False).area_faces
    assert metrics["area_deviation"]["value"] == pytest.approx(areas.std() / areas.mean())
    assert all(row["value"] > 0 and row["seconds"] > 0 and row["points"] == 2 for row in metrics.values())
    assert all((row["kept"], row["rings"], row["shrunk"]) == (2, 3.0, False) for row in metrics.values())


def test_shrinking_makes_it_feasible_and_says_what_is_kept(subject, tmp_path):
    row = cell(measure_cells(subject, "glance", tmp_path, SHRINKING, 0), "glance", "10%")["faces"]
    assert row["value"] <= 128 < row["smallest_feasible"] and not row["infeasible"] and row["note"] == ""
    assert row["shrunk"] and row["points"] == 2
    rings = shrunk_rings(subject.mesh, 128, subject.points["glance"])
    assert (row["kept"], row["rings"]) == ((rings >= 0).sum(), rings[rings >= 0].mean())


def test_the_soft_variant_keeps_no_point_and_needs_no_room(rows):
    metrics = cell(rows[1], "glance-soft", "10%")
    assert (metrics["faces"]["points"], metrics["faces"]["kept"], metrics["faces"]["rings"]) == (0, 0, None)
    assert metrics["faces"]["value"] == 128
    assert metrics["salient_error"]["value"] < cell(rows[1], "qem", "10%")["salient_error"]["value"]


def test_equal_kept_sets_are_simplified_once(tmp_path, monkeypatch):
    subject, calls = new_subject(), []
    monkeypatch.setattr("stages.lod.cell.simplify", lambda *a, **k: calls.append(a) or simplify(*a, **k))
    settings = dataclasses.replace(SETTINGS, targets=["50%", "640"])
    subject.points["itti"] = subject.points["glance"][::-1]
    rows = [row for method in ("glance", "itti") for row in measure_cells(subject, method, tmp_path, settings, 0)]
    assert len(calls) == 1
    assert len({row["value"] for row in rows if row["metric"] == "metro_mean"}) == 1
    assert len(list((tmp_path / "ball").glob("*.npz"))) == 4


def test_qslim_is_without_the_fit_whoever_simplifies_the_others_and_is_measured_once_where_that_is_the_same(
    tmp_path, monkeypatch
):
    subject, calls = new_subject(), []
    monkeypatch.setattr("stages.lod.cell.measure_errors", lambda *a: calls.append(a) or measure_errors(*a))
    settings = dataclasses.replace(SETTINGS, targets=["50%", "10%"], backend="fast")
    rows = [row for method in ("qem", "qslim") for row in measure_cells(subject, method, tmp_path, settings, 0)]
    assert len(calls) == 3  # at half of the faces nothing is fitted
    mesh = read_mesh(tmp_path / "ball" / "qslim_10pct.npz")
    assert np.array_equal(mesh.vertices, simplify(subject.mesh, 128, backend="qslim").vertices)
    fitted, plain = (cell(rows, method, "10%")["metro_mean"]["value"] for method in ("qem", "qslim"))
    assert fitted < 0.9 * plain


def test_gaze_counts_the_errors_of_the_side_that_people_looked_at():
    subject = new_subject()
    gaze = spread_on_surface(subject.mesh, (subject.mesh.vertices[:, 0] > 0.4).astype(float), 0.025)
    subject = dataclasses.replace(subject, gaze=gaze)

    def errors(side, subject=subject):
        """Of the ball, flattened on one side of the x axis."""
        vertices = subject.mesh.vertices.copy()
        flat = side * vertices[:, 0] > 0.4
        vertices[flat, 0] = side * 0.4
        parts = measure_errors(subject, Mesh(vertices, subject.mesh.faces), SETTINGS, 0)
        return {part["metric"]: part["value"] for part in parts}

    front, back = errors(1), errors(-1)
    assert back["gaze_error"] < 1e-3 * front["gaze_error"] and front["gaze_error"] > 2 * front["metro_mean"]
    assert front["salient_error"] == pytest.approx(back["salient_error"], rel=0.2)  # the model looks up, at neither
    blind = errors(1, dataclasses.replace(subject, saliency={}, gaze=None))
    assert "metro_mean" in blind and not {"salient_error", "gaze_error"} & set(blind)


@pytest.fixture
def workspace(make_workspace):
    """A function of the source of the meshes: a data set of one object, with ground truth."""

    def make(source):
        subject = new_subject()
        settings = {"source": source, "folder": "", "up": "z", "unit": "m", "strict": False}
        settings |= {"objects": [], "classes": {}}
        workspace = make_workspace({"lod": dataclasses.asdict(FEW), "meshes": settings})
        write_mesh(workspace.data / "meshes/ball.npz", subject.mesh)
        detections = {
            name: Detection(points, len(points), subject.saliency.get(name)) for name, points in subject.points.items()
        }
        write_points(workspace.data / "salient_points/ball.npz", detections)
        density = 0.6 + subject.mesh.vertices[:, 0]
        write_arrays(workspace.data / "weights/ground_truth/ball.npz", density=density)
        return workspace

    return make


@pytest.mark.slow
@pytest.mark.parametrize(("source", "measured"), [("gaze", True), ("gaze_clouds", True), ("household", False)])
def test_only_recorded_gaze_is_human_gaze(workspace, source, measured):
    workspace = workspace(source)
    stage.run(workspace)
    rows = read_rows(workspace.measurements / "lod.csv.gz")
    assert "salient_error" in set(rows["metric"]) and ("gaze_error" in set(rows["metric"])) == measured
    assert set(rows["item"]) == {"ball"} and rows["split"].isna().all()
    assert stage.human_gaze(workspace.data / "cube.npz") is None


@pytest.mark.slow
def test_curve_has_the_rows_without_what_differs_from_run_to_run(workspace):
    workspace = workspace("household")
    work = functools.partial(stage.process, data=workspace.data, settings=FEW, seed=0, gaze=False)
    folder = workspace.root
    rows = [work("ball", folder / turn) for turn in ("one", "two")][0]
    curves = [(folder / turn / "ball" / "curve.csv").read_bytes() for turn in ("one", "two")]
    assert curves[0] == curves[1]
    table = read_table(folder / "one" / "ball" / "curve.csv")
    assert "salient_error" in set(table["metric"]) and "gaze_error" not in set(table["metric"])
    assert list(table) == [name for name in rows[0] if name not in ("seconds", "note")] and len(table) == len(rows)
    meshes = [sorted((folder / turn / "ball").glob("*.npz")) for turn in ("one", "two")]
    assert [path.read_bytes() for path in meshes[0]] == [path.read_bytes() for path in meshes[1]]


def test_an_infeasible_cell_says_so_and_names_the_smallest_count(rows):
    folder, rows = rows
    row = cell(rows, "glance", "10%")["faces"]
    assert row["value"] is None and row["infeasible"]
    assert row["smallest_feasible"] > 128 and str(row["smallest_feasible"]) in row["note"]
    assert not (folder / "ball" / "glance_10pct.npz").exists()


def test_every_cell_has_a_row_and_one_without_a_mesh_a_note(rows):
    rows = rows[1]
    cells = {(row["method"], row["target"]) for row in rows if row["metric"] == "faces"}
    assert cells == {(method, target) for method in SETTINGS.methods for target in SETTINGS.targets}
    assert cell(rows, "qem", "4000")["faces"]["note"] == "the object has only 1280 faces"
    assert cell(rows, "itti", "50%")["faces"]["note"] == "salient_points has no itti"
    assert "saliency of random" in cell(rows, "random-area", "50%")["faces"]["note"]


def test_summary_compares_only_cells_that_all_methods_reach():
    def row(method, target, metric, value, infeasible=False):
        return {"item": "a", "method": method, "target": target, "metric": metric, "value": value,
                "infeasible": infeasible, "shrunk": method == "itti"}  # fmt: skip

    rows = [row("svm", "50%", "faces", None)]
    for method, values in (("qem", (1.0, 9.0)), ("itti", (2.0, None))):
        for target, value in zip(("50%", "10%"), values, strict=True):
            rows.append(row(method, target, "faces", value and 100, value is None))
            if value is not None:
                rows += [row(method, target, "metro_mean", value), row(method, target, "ssim_error", value / 10)]
    summary = stage.summarise(rows)
    assert (summary["metro_mean_qem"], summary["metro_mean_itti"], summary["paired_cells"]) == (1.0, 2.0, 1)
    assert summary["metro_mean_svm"] is None  # no mesh at all: it leaves the others their pairs
    assert (summary["share_infeasible"], summary["infeasible_itti"], summary["meshes"]) == (0.25, 0.5, 3)
    assert (summary["share_shrunk"], summary["shrunk_itti"], summary["shrunk_qem"]) == (0.5, 1.0, 0.0)


@pytest.mark.parametrize(
    ("name", "method", "way"),
    [
        ("qem", None, None), ("glance", "glance", "fixed"), ("guided_ssim-adaptive", "guided_ssim", "adaptive"),
        ("glance-area", "glance", "area"), ("2Sym-soft", "2Sym", "soft"),
    ],
)  # fmt: skip
def test_names_of_methods_mean_points_and_a_way(name, method, way):
    assert variant(name) == Variant(name, method, way)


@pytest.mark.parametrize(
    ("target", "count"), [("50%", 500), ("12.5%", 125), ("32.3%", 323), ("32.39%", 323), ("1500", 1500), ("0.01%", 1)]
)
def test_targets_mean_face_counts_and_files(target, count):
    assert face_count(target, 1000) == count
    assert file_name("glance", target) == f"glance_{target.replace('%', 'pct')}.npz"


@pytest.mark.parametrize(
    ("name", "message"),
    [
        ("glanc", "unknown method 'glanc'"), ("glance-fixed", "endings are -adaptive, -area, -soft"),
        ("glance-soft-area", "ends in 'soft-area'"), ("qem-soft", "unknown method 'qem'"),
        ("-area", "unknown method ''"),
    ],
)  # fmt: skip
def test_bad_names_of_methods_are_named(name, message):
    with pytest.raises(ValueError, match=message):
        variant(name)

"""Commands, functions and studio give the same places, values and imprints, for a mesh in any form."""

import inspect
import json
import pickle
import re
import warnings

import numpy as np
import pytest
import trimesh

import haptic_glance
from haptic_glance import Mesh, detect, find_points, know, load, press, press_many, public, saliency, simplify
from haptic_glance.__main__ import run
from haptic_glance.lod.export import write_any
from haptic_glance.studio.specimen import open_content, open_file
from tests.shapes import flat_grid

COUNT = 5


@pytest.fixture(scope="module")
def body():
    """An egg with a nose and a tail, 40 across, far from the origin: arrays of a closed surface."""
    ball = trimesh.creation.icosphere(3)
    x, y, z = ball.vertices.T
    bumps = 0.5 * np.exp(-12 * ((y + 1) ** 2 + (z - 0.3) ** 2)) + 0.3 * np.exp(-12 * ((y - 1) ** 2 + (x - 0.2) ** 2))
    vertices = (1 + bumps)[:, None] * ball.vertices * [1, 1.2, 0.8]
    return 20 * vertices + [100, -30, 7], np.asarray(ball.faces)


@pytest.fixture
def file(body, tmp_path, request):
    """The body in a file of the format that a test names."""
    path = tmp_path / f"body{request.param}"
    trimesh.Trimesh(*body, process=False).export(path)
    return path


@pytest.mark.slow
@pytest.mark.filterwarnings("ignore:assuming")
@pytest.mark.parametrize("file", [".glb"], indirect=True)
def test_commands_functions_and_studio_give_the_same_places_values_and_imprints(file, tmp_path, capsys):
    mesh = load(file)
    detection = detect(mesh, count=COUNT)
    assert (np.diff(detection.scores) <= 0).all() and len(detection.scores) == COUNT
    assert find_points(mesh, COUNT).tolist() == find_points(mesh, count=COUNT).tolist() == detection.points.tolist()
    assert (detection.saliency == saliency(mesh)).all()
    for command in ("saliency", "points"):
        run(command, [str(file), "--count", str(COUNT), "--json"])
        rows = json.loads(capsys.readouterr().out)
        assert [row["vertex"] for row in rows] == detection.points.tolist()
        assert [row["score"] for row in rows] == detection.scores.tolist()
    run("touch", [str(file), "--count", str(COUNT), "--out", str(tmp_path / "touched"), "--json"])
    assert [row["vertex"] for row in json.loads(capsys.readouterr().out)] == detection.points.tolist()
    stored = np.load(tmp_path / "touched/imprints.npz")
    assert np.allclose(stored["images"], press_many(mesh, detection.points), atol=1e-5)
    look = open_file(file).look("glance", COUNT)
    assert [row[1] for row in look.points] == detection.points.tolist()
    assert [row[-1] for row in look.points] == detection.scores.tolist()


@pytest.mark.slow
def test_an_array_stands_upright_on_the_axis_of_the_mesh(body):
    mesh = Mesh(*body)
    point = find_points(mesh, 1)[0]
    turned = Mesh(mesh.vertices[:, [1, 2, 0]], mesh.faces, up="y")  # x, y, z become z, x, y
    assert np.allclose(press(mesh, point), press(turned, point), atol=1e-6)
    assert not np.allclose(press(mesh, point), press(Mesh(turned.vertices, turned.faces), point), atol=0.1)


@pytest.mark.parametrize("scale", [1e-3, 1000.0])
def test_lengths_are_shares_of_the_diameter_or_have_a_unit(body, scale):
    mesh = Mesh(*body)
    image = press(Mesh(scale * mesh.vertices, mesh.faces), 7)
    assert np.allclose(image, press(mesh, 7), atol=1e-5)
    millimetres = press(mesh, 7, pitch=f"{0.01 * public.centre_and_radius(mesh)[1] / 0.5}mm", unit="mm")
    assert np.allclose(millimetres, image, atol=1e-5)
    with pytest.raises(ValueError, match="pitch='1mm' needs unit"):
        press(mesh, 7, pitch="1mm")
    with pytest.raises(ValueError, match="pitch='wide': give a share"):
        press(mesh, 7, pitch="wide")
    with pytest.raises(ValueError, match="unit='mm' applies to lengths"):
        press(mesh, 7, pitch=0.5, unit="mm")
    with pytest.raises(ValueError, match="mm, cm, in, m, not 'yd'"):
        press(mesh, 7, pitch="1mm", unit="yd")


def test_a_length_that_does_not_fit_the_mesh_is_warned_of(body):
    mesh = haptic_glance.normalise(Mesh(*body))  # 1 across, so no longer in mm
    with pytest.warns(UserWarning, match="pitch='1mm': the array is .* is the unit of length right?"):
        press(mesh, 7, pitch="1mm", unit="mm")
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        press(Mesh(100 * mesh.vertices, mesh.faces), 7, pitch="1mm", unit="mm")
    with pytest.raises(ValueError, match="cells must be two whole numbers"):
        press(mesh, 7, cells=16, pitch="1mm", unit="mm")
    with pytest.raises(ValueError, match=r"cells=\(100000, 100000\): an array has at most 16,777,216 cells"):
        press(mesh, 7, cells=(100_000, 100_000))
    for pitch in (1, -0.01, np.nan):
        with pytest.raises(ValueError, match=f"pitch={pitch}: give a share of the object's diameter between 0 and 1"):
            press(mesh, 7, pitch=pitch)


def test_forces_take_lengths_as_texts(body):
    mesh, layer = Mesh(*body), haptic_glance.Layer()
    place = mesh.vertices[[7]], haptic_glance.sensor_axes(haptic_glance.sensor_normals(mesh, [7]))
    felt = haptic_glance.press_forces(mesh, *place, layer, pitch="1.5mm", depth="2mm", unit="mm")
    numbers = haptic_glance.press_forces(mesh, *place, layer, pitch=1.5, depth=0.002, unit=0.001)
    assert felt.any() and (felt == numbers).all()
    gaps = haptic_glance.gaps_at(mesh, *place, within="2mm", pitch="0.15cm", unit="mm")
    assert np.allclose(gaps, haptic_glance.gaps_at(mesh, *place, within=0.002, pitch=1.5, unit=0.001))
    for text, number in (("2mm", 0.002), ("0.05cm", 0.0005)):
        felt = haptic_glance.forces(gaps, layer, 1e-6, depth=text)
        assert (felt == haptic_glance.forces(gaps, layer, 1e-6, depth=number)).all()
    with pytest.raises(ValueError, match="depth='deep': give a number"):
        haptic_glance.forces(gaps, layer, 1e-6, depth="deep")
    for wrong, message in (
        ({"unit": "yd"}, "unit='yd': give a number"),
        ({"pitch": "wide"}, "pitch='wide': give a number"),
    ):
        with pytest.raises(ValueError, match=message):
            haptic_glance.press_forces(mesh, *place, layer, depth=0.002, **wrong)


@pytest.mark.parametrize("sizes, words", [
    ({}, "it feels one point; is the unit of length right?"),
    ({"pitch": 0.4}, "the array is 6.4 m long under a layer of 0.002 m, the object 6"),
    ({"pitch": 0.4, "unit": 1e-5}, "more than the object, 0.0006"),
    ({"pitch": 9.0, "unit": "mm"}, "is the unit of length right?"),
    ({"pitch": "1mm", "unit": "mm"}, ""), ({"pitch": 0.4, "unit": 0.001}, ""),
])  # fmt: skip
def test_units_of_forces_that_do_not_fit_are_warned_of(body, sizes, words):
    mesh = Mesh(*body)
    place = mesh.vertices[[7]], haptic_glance.sensor_axes(haptic_glance.sensor_normals(mesh, [7]))
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always")
        haptic_glance.press_forces(body, *place, haptic_glance.Layer(), depth=1e-4, **sizes)
    assert len(caught) == bool(words) and all(words in str(warning.message) for warning in caught)
    assert all(warning.filename == __file__ for warning in caught)


FORMS = {
    "path": lambda mesh, path: path,
    "arrays": lambda mesh, path: (mesh.vertices, mesh.faces),
    "trimesh": lambda mesh, path: trimesh.Trimesh(mesh.vertices, mesh.faces, process=False),
    "mesh": lambda mesh, path: mesh,
}
CALLS = {
    "conspicuity": lambda f, m: f(m, haptic_glance.render(m, haptic_glance.Viewpoint(0, 0), (90, 120)), ["edge"]),
    "detect": lambda f, m: f(m, count=2), "find_points": lambda f, m: f(m, 2),
    "follow": lambda f, m: f(m, np.array([[100, -30, 7], [120, -30, 7], [100, -10, 7.0]]), 3, (4, 4)),
    "gaps_at": lambda f, m: f(m, *PLACE, within=1.0, pitch=0.1),
    "metro": lambda f, m: f(m, m, 100), "normalise": lambda f, m: f(m),
    "perceptual": lambda f, m: f(m, m, [haptic_glance.Viewpoint(0, 0)], (45, 60)),
    "press": lambda f, m: f(m, 7), "press_forces": lambda f, m: f(m, *PLACE, haptic_glance.Layer(), depth=0.001),
    "press_many": lambda f, m: f(m, [7]), "render": lambda f, m: f(m, haptic_glance.Viewpoint(0, 0), (45, 60)),
    "saliency": lambda f, m: f(m), "sensor_normals": lambda f, m: f(m, [7]), "simplify": lambda f, m: f(m, "25%"),
    "to_trimesh": lambda f, m: f(m), "write_any": lambda f, m: f("out.ply", m), "repair": lambda f, m: f(m),
    "show": lambda f, m: f(m), "as_mesh": lambda f, m: f(m), "Surface": lambda f, m: f(m), "clean": lambda f, m: f(m),
    "rotate_to_z_up": lambda f, m: f(m),
}  # fmt: skip
PLACE = np.array([[100.0, -30.0, 40.0]]), haptic_glance.sensor_axes([[0.0, 0.0, 1.0]])


def test_every_function_with_a_mesh_is_called_here():
    taking = {"mesh", "surface", "mesh_or_surface", "reference", "given"}
    for name in haptic_glance.__all__:
        function = getattr(haptic_glance, name)
        if inspect.isfunction(function) and taking & set(inspect.signature(function).parameters):
            assert name in CALLS, name


@pytest.mark.slow
@pytest.mark.filterwarnings("ignore::UserWarning")
@pytest.mark.parametrize(("name", "form"), [(name, "path") for name in CALLS] + [("saliency", form) for form in FORMS])
def test_every_function_takes_a_mesh_in_every_form(body, tmp_path, monkeypatch, name, form):
    monkeypatch.chdir(tmp_path)
    mesh = Mesh(*body)
    mesh = haptic_glance.normalise(mesh) if name in ("conspicuity", "perceptual", "render") else mesh
    path = tmp_path / "body.ply"
    write_any(path, mesh)
    assert CALLS[name](getattr(haptic_glance, name), FORMS[form](mesh, path)) is not False


def test_faces_are_a_count_or_a_share(body):
    for faces in ("25%", 0.25, np.float32(0.25), 320, np.int64(320), "320"):
        assert len(simplify(Mesh(*body), faces).faces) == 320
    with pytest.raises(ValueError, match="faces='None' is not a face count"):
        simplify(Mesh(*body), None)
    assert simplify(body, 1.0) == Mesh(*body, up="auto")


@pytest.mark.slow
def test_an_axis_that_nobody_said_is_warned_of_where_it_first_matters(body):
    for passing in (
        haptic_glance.normalise, haptic_glance.repair,
        lambda m: haptic_glance.clean(m)[0], lambda m: simplify(m, "50%"),
    ):  # fmt: skip
        with warnings.catch_warnings(action="error"):
            mesh = passing(body)
        with pytest.warns(UserWarning, match="does not say which axis points up"):
            find_points(mesh, 1)
    small = haptic_glance.normalise(body)
    for looking in (
        haptic_glance.as_mesh, haptic_glance.Surface, lambda m: know.learn(know.primitives() | {"a": m}),
        know.stand, know.learn(know.primitives()).line(0).feel,
    ):  # fmt: skip
        with pytest.warns(UserWarning, match="(the mesh|a) does not say which axis points up"):
            looking(small)


@pytest.mark.parametrize("name", public.PATH_ARGUMENTS)
def test_functions_travel_to_other_processes(name):
    assert pickle.loads(pickle.dumps(getattr(haptic_glance, name))) is getattr(haptic_glance, name)


def test_a_layer_that_is_none_is_named(body):
    with pytest.raises(TypeError, match=r"layer must be a Layer .*got 0\.002"):
        haptic_glance.press_forces(Mesh(*body), [[0, 0, 0]], [np.eye(3)], 0.002, load=1)


def test_values_that_colour_a_mesh_are_one_per_vertex_and_finite(body):
    mesh = Mesh(*body)
    assert "iframe" in haptic_glance.show(mesh, np.arange(len(mesh.vertices)))._repr_html_()
    for values in (np.ones(3), np.full(len(mesh.vertices), np.nan), np.full(len(mesh.vertices), -1)):
        with pytest.raises(ValueError, match="values must be one per vertex"):
            haptic_glance.show(mesh, values)


def test_a_mistyped_method_is_answered_by_its_neighbour_alone(body):
    with pytest.raises(ValueError, match=r"unknown method 'glanse' \(did you mean glance\?\)$"):
        find_points(Mesh(*body), "glanse")
    with pytest.raises(ValueError, match="choose one of glance, ") as error:
        find_points(Mesh(*body), "zzzz")
    assert len(str(error.value)) < 150


def test_a_mesh_compares_by_content_and_keeps_its_arrays_to_itself(body):
    vertices, faces = body[0].copy(), body[1].copy()
    mesh, diagonal = Mesh(vertices, faces), Mesh(*body).diagonal
    vertices[:] = 0
    assert mesh.diagonal == diagonal and mesh == Mesh(*body) and hash(mesh) == hash(Mesh(*body))
    assert mesh != Mesh(body[0] + 1, body[1]) and mesh != Mesh(*body, up="y") and mesh != "mesh"
    small = len(pickle.dumps(Mesh(*body)))
    assert mesh.adjacency.nnz and len(pickle.dumps(mesh)) == small and pickle.loads(pickle.dumps(mesh)) == mesh


def test_warnings_name_the_line_that_called_and_the_studio_notes_them(body, tmp_path):
    ball = trimesh.creation.icosphere(subdivisions=2)
    inwards = Mesh(np.asarray(ball.vertices), np.asarray(ball.faces)[:, ::-1])
    ball.apply_translation([2e5, 0, 0])
    ball.export(path := tmp_path / "far (1).stl")
    calls = [
        lambda: load(path), lambda: load(path, up="z"), lambda: haptic_glance.as_mesh(path),
        lambda: haptic_glance.normalise(path), lambda: haptic_glance.Surface(inwards), lambda: press(inwards, 7),
        lambda: press_many(inwards, [7, 9]), lambda: press(Mesh(*body), 7, pitch="1m", unit="mm"),
        lambda: saliency(body),
    ]  # fmt: skip
    for call in calls:
        with pytest.warns(UserWarning) as caught:
            call()
        assert {warning.filename for warning in caught} == {__file__}
    with pytest.warns(UserWarning, match="far"):
        opened = open_file(path)
    for specimen in (opened, open_content(path.name, path.read_bytes())):
        assert specimen.note.startswith("its coordinates have steps of 0.45 % of the diagonal: move the object")


@pytest.mark.slow
def test_a_guess_of_the_axis_is_said_once_and_no_other(body, tmp_path):
    mesh = Mesh(*body)
    write_any(tmp_path / "body.ply", mesh)
    trimesh.Trimesh(*body, process=False).export(tmp_path / "plain.ply")
    with pytest.warns(UserWarning, match=r"assuming z is up.*plain.ply does not say.*load\(path, up='y'\)") as caught:
        load(tmp_path / "plain.ply")
    with pytest.warns(UserWarning, match=r"assuming z is up.*plain.ply does not say.* up='y'"):
        saliency(tmp_path / "plain.ply")
    for guess in (find_points, press):  # the rows of an array stand upright
        with pytest.warns(UserWarning, match="the mesh does not say which axis points up"):
            guess(body, 1)
    with pytest.warns(UserWarning, match="by the shape of body.ply"):
        load(tmp_path / "body.ply", up="auto")
    assert [warning.filename for warning in caught] == [__file__]
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        assert load(tmp_path / "body.ply").up == "z"  # as its comment says
        assert len(load(tmp_path / "plain.ply", up="z").faces) == len(mesh.faces)
        saliency(tmp_path / "plain.ply", up="z")


@pytest.mark.filterwarnings("ignore:assuming")
@pytest.mark.slow
def test_a_file_its_arrays_and_its_command_have_one_axis(body, tmp_path, capsys):
    lying = body[0][:, [1, 2, 0]], body[1]  # y up
    trimesh.Trimesh(*lying, process=False).export(tmp_path / "lying.obj")
    expected = find_points(Mesh(*lying, up="y"), COUNT).tolist()
    forms = tmp_path / "lying.obj", lying, trimesh.Trimesh(*lying, process=False), load(tmp_path / "lying.obj")
    assert all(find_points(form, COUNT).tolist() == expected for form in forms)
    assert find_points(Mesh(*lying), COUNT, up="auto").tolist() == expected
    assert find_points(Mesh(*lying), COUNT).tolist() != expected  # a Mesh is z up unless it is told
    run("points", [str(tmp_path / "lying.obj"), "--count", str(COUNT), "--json"])
    out, progress = capsys.readouterr()
    assert [row["vertex"] for row in json.loads(out)] == expected
    assert re.search(r"assuming y is up.*\(probability 0\.\d\d; OBJ files do not store it; .*--up z", progress)
    run("points", [str(tmp_path / "lying.obj"), "--count", str(COUNT), "--json", "--up", "-Y"])
    turned = capsys.readouterr()
    assert "-y up" in turned.err
    upside_down = find_points(Mesh(*lying), COUNT, up=(0, -2, 0)).tolist()
    assert [row["vertex"] for row in json.loads(turned.out)] == upside_down != expected


def test_a_triangle_soup_and_an_open_patch_are_simplified(body):
    mesh = Mesh(*body)
    soup = Mesh(mesh.vertices[mesh.faces].reshape(-1, 3), np.arange(3 * len(mesh.faces)).reshape(-1, 3))
    values = np.linspace(0, 1, len(soup.vertices))
    assert len(simplify(soup, "25%", weights=values).faces) <= 320
    patch = _sheet()
    assert len(simplify(patch, 0.1).faces) <= 0.1 * len(patch.faces)
    with pytest.raises(haptic_glance.InfeasibleTarget) as error:
        simplify(patch, 0.1, free_borders=False)
    assert len(simplify(patch, error.value.smallest, free_borders=False).faces) <= error.value.smallest


def _torus(turn):
    """A torus of a grid whose last row and column repeat the first; turn: the angle of the last ones."""
    angles = np.append(np.linspace(0, 2 * np.pi, 25)[:-1], turn)
    a, b = (angle.ravel() for angle in np.meshgrid(angles, angles, indexing="ij"))
    around = 0.5 + 0.2 * np.cos(b)
    return Mesh(np.stack([around * np.cos(a), around * np.sin(a), 0.2 * np.sin(b)], axis=1), flat_grid(25, 25).faces)


@pytest.mark.parametrize("turn", [0.0, 2 * np.pi])
def test_a_seam_is_closed_before_borders_are_freed_though_its_sides_differ_by_rounding(turn):
    mesh = _torus(turn)
    assert not mesh.watertight
    small = simplify(mesh, "15%")
    assert small.watertight and len(small.faces) <= 0.15 * len(mesh.faces)


def test_a_mesh_that_cannot_be_repaired_and_colours_that_a_repair_makes_a_texture_give_the_feasible_count(body):
    wire = Mesh(Mesh(*body).vertices * [1, 1e-6, 1e-6], body[1])
    with pytest.raises(haptic_glance.InfeasibleTarget):
        simplify(wire, 2)
    vertices, faces = body
    colors = np.repeat(np.arange(len(faces)) % 256, 9).reshape(-1, 3).astype(np.uint8)
    soup = Mesh(vertices[faces].reshape(-1, 3), np.arange(3 * len(faces)).reshape(-1, 3), colors)
    with pytest.raises(haptic_glance.InfeasibleTarget):
        simplify(soup, "25%", attributes={"colors": 1.0})
    with pytest.raises(ValueError, match="no colors of vertices: weigh those of its texture by uv"):
        simplify(haptic_glance.repair(soup), "25%", attributes={"colors": 1.0})


def test_any_share_is_a_count_and_borders_may_be_a_list(body):
    patch = _sheet()
    with pytest.raises(haptic_glance.InfeasibleTarget, match="a count of 1 faces"):
        simplify(Mesh(*body), 1e-7)
    soup = Mesh(patch.vertices[patch.faces].reshape(-1, 3), np.arange(3 * len(patch.faces)).reshape(-1, 3))
    with pytest.raises(haptic_glance.InfeasibleTarget):
        simplify(soup, "25%", free_borders=[True] * len(soup.vertices))


def test_a_count_that_leaves_a_fold_is_answered_by_one_nearby(body, monkeypatch):
    import haptic_glance.lod

    inner, counts = haptic_glance.lod.simplify, []

    def folding(mesh, faces, **options):
        counts.append(faces)
        if faces > 316:
            raise haptic_glance.SimplifyError(f"{faces} faces leave 1 new folded pairs of faces: ask for more faces")
        return inner(mesh, faces, **options)

    monkeypatch.setattr(haptic_glance.lod, "simplify", folding)
    assert len(simplify(Mesh(*body), 320).faces) == 316 and counts == [320, 318, 316]
    with pytest.raises(haptic_glance.SimplifyError, match="400 faces leave"):
        simplify(Mesh(*body), 400)


def _sheet():
    """A flat sheet of 20 x 2 squares, nearly all of it border."""
    flat = flat_grid(21, 3)
    return Mesh(flat.vertices + [[0, 0, 0.1]] * np.sin(flat.vertices[:, :1]), flat.faces)


def test_one_vertex_may_be_kept_and_borders_that_are_no_truth_value_are_named(body):
    mesh = Mesh(*body)
    assert simplify(mesh, "50%", keep=5) == simplify(mesh, "50%", keep=[5])
    with pytest.raises(ValueError, match="free_borders must be True, False, or one per vertex"):
        simplify(mesh, "50%", free_borders="no")

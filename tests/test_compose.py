"""Configuration: what conf/ composes is what params.yaml holds, a slip of the pen is named, and where results go."""

import re
import shlex
import subprocess
import sys
from contextlib import nullcontext
from dataclasses import fields
from importlib import import_module
from itertools import zip_longest
from pathlib import Path

import pytest
from omegaconf import OmegaConf

from stages.compose import CONF, _sections, compose, composed, groups, main, own_folder
from stages.engine.settings import (
    ParamsError,
    Workspace,
    check_common,
    check_names,
    check_section,
    load_params,
    workspace_of_arguments,
)
from stages.pipeline import STAGES, schema_of
from stages.views import Params

ROOT = Path(__file__).parents[1]
README = (ROOT / "README.md").read_text(encoding="utf-8")
COMMANDS = re.findall(r"^(python -m stages\.compose .*?)(?: &&|  |$)", README, re.M)
IN_README = [[word.replace("=FOLDER", "=somewhere") for word in shlex.split(command)[3:]] for command in COMMANDS]


@pytest.mark.slow
def test_params_yaml_is_the_composed_default():
    assert (ROOT / "params.yaml").read_text() == OmegaConf.to_yaml(OmegaConf.create(compose()))


def covering():
    """(data set, overrides) that name each option of conf/ at least once; an experiment goes with a set of its own."""
    options, cases = groups(), []
    sets = set(options.pop("data"))
    for experiment in options.pop("experiment"):
        names = OmegaConf.load(CONF / f"experiment/{experiment}.yaml").sets
        chosen = next((name for name in names if name in sets), names[0])
        sets.discard(chosen)
        cases.append((chosen, [f"experiment={experiment}"]))
    cases += [(name, []) for name in sorted(sets)]
    for row in zip_longest(*options.values()):
        chosen = [f"{group}={option}" for group, option in zip(options, row, strict=True) if option]
        cases.append(("household", chosen))
    return cases


@pytest.mark.slow
@pytest.mark.parametrize(("dataset", "overrides"), covering(), ids=str)
def test_every_option_composes_and_fits_the_schemas(dataset, overrides):
    if "folder: ???" in (CONF / f"data/{dataset}.yaml").read_text():
        overrides = [*overrides, "meshes.folder=somewhere"]
    sections = _sections(composed([f"data={dataset}", *overrides]), dataset)
    assert sections
    for section, values in sections.items():
        check_names(schema_of(section), values)


NAMED = [f"{name}.{each.name}" for name in STAGES for each in fields(schema_of(name)) if each.metadata.get("names")]


@pytest.mark.parametrize("setting", NAMED)
def test_a_name_that_a_setting_does_not_know_is_refused(setting):
    section, key = setting.split(".")
    for value, words in ((["xyzzy"], "xyzzy"), (12.5, "12.5"), (True, "True")):
        with pytest.raises(ParamsError, match=f"^{setting}: .*{words}"):
            check_names(schema_of(section), {key: value})


@pytest.mark.parametrize("command", ["claim x", "code", "compose", "gate", "sweep classifier=knn", "engine.settings"])
def test_outside_a_clone_every_command_says_so_and_writes_nothing(tmp_path, monkeypatch, command):
    name, *arguments = command.split()
    module = import_module(f"stages.{name}")
    monkeypatch.setattr("sys.argv", [name, *arguments])
    monkeypatch.setattr("sys.excepthook", sys.excepthook)
    monkeypatch.chdir(tmp_path)
    with pytest.raises(ValueError, match="run it in a clone of the project"):
        if name == "engine.settings":  # as every stage asks for the workspace
            module.workspace_of_arguments("", "lod")
        else:
            module.run(arguments) if name == "claim" else module.main()
    assert not list(tmp_path.iterdir())


def test_a_stage_about_all_sets_takes_the_name_of_none(make_workspace, monkeypatch):
    root = make_workspace({"lod": {}}).root
    (root / "dvc.yaml").touch()
    monkeypatch.setattr("sys.excepthook", sys.excepthook)
    for stage, words in (("report", "about all sets that params.yaml names: leave toys out"), ("lod", "")):
        monkeypatch.setattr("sys.argv", [stage, "toys", "--root", str(root)])
        with pytest.raises(ValueError, match=words) if words else nullcontext():
            assert workspace_of_arguments("", stage).dataset == "toys"


def test_a_stage_that_would_read_a_folder_which_dvc_does_not_watch_is_refused(make_workspace, monkeypatch):
    graph = {"meshes": {"toys": "old"}, "lod": ["toys"]}
    root = make_workspace({"meshes": {"folder": "new"}, "lod": {}}, graph=graph).root
    (root / "dvc.yaml").touch()
    monkeypatch.setattr("sys.excepthook", sys.excepthook)
    for stage, words in (("meshes", "would read new, but graph.meshes.toys is old"), ("lod", "")):
        monkeypatch.setattr("sys.argv", [stage, "--root", str(root)])
        with pytest.raises(ParamsError, match=words) if words else nullcontext():
            workspace_of_arguments("", stage)


@pytest.mark.slow
def test_a_set_runs_only_its_stages_and_its_path_may_be_any():
    folder = 'x=y, my "scäns"'
    values = compose(["sets=[folder]", f"meshes.folder={folder}"])
    assert values["sets"] == ["folder"] and "transfer" not in values["folder"]
    assert values["graph"]["meshes"] == {"folder": folder} and values["graph"]["transfer"] == []
    assert values["folder"]["meshes"]["folder"] == folder


@pytest.mark.slow
def test_changed_gaze_in_an_archive_of_meshes_is_learned_anew():
    graph = compose(["sets=[gaze]", "gaze.meshes.folder=gaze.zip"])["graph"]
    assert graph["weights"] == graph["meshes"] == {"gaze": "gaze.zip"}


@pytest.mark.slow
def test_a_setting_holds_for_all_sets_or_for_the_one_that_it_names():
    values = compose(["sets=[household,princeton]", "lod.rings=2", "princeton.lod.samples=7"])
    assert [values[name]["lod"]["rings"] for name in values["sets"]] == [2, 2]
    assert [values[name]["lod"]["samples"] for name in values["sets"]] == [10000, 7]


@pytest.mark.slow
def test_a_set_whose_files_are_absent_is_named_and_left_out(tmp_path, monkeypatch, capsys):
    monkeypatch.setattr("stages.compose.FILE", tmp_path / "params.yaml")
    monkeypatch.setattr("sys.argv", ["compose", "sets=[household,gaze]", "gaze.meshes.folder=/nowhere/gaze.zip"])
    main()
    assert "gaze is left out, /nowhere/gaze.zip is not there: get Models_3D" in capsys.readouterr().err
    values = OmegaConf.to_container(OmegaConf.load(tmp_path / "params.yaml"))
    assert values["sets"] == ["household"] and "gaze" not in values and list(values["graph"]["meshes"]) == ["household"]


@pytest.mark.slow
def test_a_link_to_nowhere_in_a_folder_of_meshes_is_named(tmp_path, monkeypatch):
    (tmp_path / "scans").mkdir()
    (tmp_path / "scans/cup.stl").symlink_to("nowhere.stl")
    monkeypatch.setattr("sys.argv", ["compose", "sets=[folder]", f"meshes.folder={tmp_path}/scans"])
    monkeypatch.setattr("stages.compose.FILE", tmp_path / "params.yaml")
    with pytest.raises(ParamsError, match=r"cup\.stl is a link to a file that is not there"):
        main()
    assert not (tmp_path / "params.yaml").exists()


@pytest.mark.slow
def test_results_go_to_reports_for_the_published_configuration_alone():
    assert IN_README
    outs = [own_folder(overrides) for overrides in [*IN_README, ["profile=smoke"], ["experiment=attention"]]]
    outs += [compose(["lod.rings=2"])["out"], compose(["sets=[household]", "out=runs/mine"])["out"]]
    assert outs[-2:] == ["runs/own", "runs/mine"] and "reports" not in outs
    assert compose(["parallel=sequential"])["out"] == compose()["out"] == "reports"
    paths = [f"{out}/{name}" for out in outs for name in ("index.html", "tables/a.csv")]
    ignored = subprocess.run(["git", "check-ignore", *paths], cwd=ROOT, capture_output=True, text=True).stdout
    assert ignored.splitlines() == paths


def test_git_sees_the_headline_numbers_of_a_run_so_that_experiments_of_dvc_keep_them():
    paths = ["runs/folder/headlines.json", "runs/folder/metrics/report.json"]
    ignored = subprocess.run(["git", "check-ignore", *paths], cwd=ROOT, capture_output=True, text=True).stdout
    assert ignored.splitlines() == paths[1:]


@pytest.mark.slow
@pytest.mark.parametrize(
    ("override", "hint"),
    [
        ("lod.target=[10%]", "lod.targets"),
        ("profiel=smoke", "did you mean profile"),
        ("classifier=knn,svm", "stages.sweep -m"),
        ("classification.sets.mine=[a,b]", "+classification.sets.mine"),
        ("classification.sets={mine:[a,b]}", "write +classification.sets.NAME="),
        ("views.material.speculr=1", "did you mean views.material.specular"),
        ("salient_points.methods=[glanse]", "salient_points.methods: unknown method 'glanse' (did you mean glance?)"),
        ("lod.methods=[qem,bendng]", "lod.methods: 'bendng': unknown method 'bendng'; methods are qem"),
        ("lod.methods=[qem,glanse-soft]", "(did you mean glance?)"),
        ("lod.targets=[50%,half]", "lod.targets: 'half' is not a face count: write one like 1500 or 25%"),
        ("sets=[]", "sets=[] names no set: write sets=[household]"),
        ("sets=[gaze,houshold_four]", "sets: unknown set houshold_four: did you mean household_four?"),
        ("gaze.lod.rings=2", "gaze is not switched on: add 'sets=[household,gaze]'"),
        ("nope=1", "unknown setting nope: known: "),
        ("", "'' has no name: write group=option or section.key=value"),
        ("parallel.workers=0", "parallel.workers=0 must be 1 or more, or -1"),
        ("out=/", "out=/ is no folder for results"),
        ("stages=[meshes,report]", "stages=['meshes', 'report'] must name stages: classification, "),
        ("out=reports/../stages/new", "out=stages/new is no folder for results"),
        ("household.lod.targets=[50%,1500,1500]", "lod.targets names 1500 twice"),
        ("classification.classifiers=[knnn]", "unknown name 'knnn': did you mean knn?"),
        ("views.renderer=foo", "views.renderer: unknown renderer 'foo': choose auto or one of raster, pyrender"),
        ("weights.method=guess", "weights.method: unknown name 'guess': known: gaze, fixations"),
        ("parallel.backend=foo", "parallel.backend=foo is none of loky, sequential, dask"),
        ("meshes.folder=scans", "household reads no meshes.folder: with several sets write SET.meshes.folder=..."),
        ("+meshes.classes.Löffel=[a]", "+meshes.classes.Löffel: the command line takes names of plain letters"),
        ("conspicuity.channels=[color]", "needs the channels intensity, orientation: add them to conspicuity.channels"),
    ],
)
def test_a_mistyped_setting_names_the_nearest_right_one(override, hint):
    with pytest.raises(ParamsError) as error:
        compose(["sets=[household]", override])
    assert hint in str(error.value)


@pytest.mark.slow
def test_names_in_a_list_may_have_blanks_accents_and_brackets():
    names = ["boule à vis", "cône (2)", "anneau#1", "caisse", "0012"]
    values = compose(["sets=[folder]", "meshes.folder=scans", f"meshes.objects=[{','.join(names)}]", "lod.rings=2"])
    assert values["folder"]["meshes"]["objects"] == names
    unquoted = values["folder"]["meshes"] | {"objects": [float("nan")]}  # as YAML reads a name without quotes
    assert check_section(schema_of("meshes"), unquoted).objects == ["nan"]
    assert compose(["sets=[folder]", 'meshes.folder=a"b c'])["folder"]["meshes"]["folder"] == 'a"b c'


@pytest.fixture(scope="module")
def params():
    return load_params(ROOT / "params.yaml")


@pytest.mark.parametrize(
    ("setting", "value", "hint"),
    [
        ("seed", "many", "'many' is not of type int: give a whole number"),
        ("seed", -1, "negative"),
        ("sets", "folder", "sets: 'folder' is not of type list: write sets=[folder]"),
        ("salient_points.count", "many", "give a whole number"),
        ("lod.shrink", "perhaps", "write true or false"),
        ("lod.rings", -3, "lod.rings: -3 must be 0 or more"),
        ("meshes.objects", ["cup", None], "write such a name in quotes"),
        ("meshes.objects", ["cup", 1e5], "meshes.objects: 100000.0 is how YAML reads a name: write such a name in q"),
        ("views.size", [900, 0], "views.size: 0 must be 1 or more"),
        ("salient_points.radius", 0, "salient_points.radius: 0 must be above 0"),
        ("look_and_touch.poses", 0, "look_and_touch.poses: 0 must be 1 or more"),
        ("fixation.folds", 1, "fixation.folds: 1 must be 2 or more"),
        ("views.material", {"specular": 2}, "views: specular=2.0 of a material must be between 0 and 1"),
    ],
)
def test_a_value_that_a_setting_cannot_have_is_named(params, setting, value, hint):
    section, _, key = setting.rpartition(".")
    with pytest.raises(ParamsError) as error:
        if section:
            check_section(schema_of(section), params["household"].get(section, {}) | {key: value})
        else:
            check_common(params | {key: value})
    assert hint in str(error.value)


@pytest.mark.parametrize(
    ("old", "new", "reason"),
    [
        ("  views:\n", "  views: 3\n  other:\n", "views: 3 is not a section of settings"),
        ("seed: 0", "- a", "is not valid YAML"),
        ("  views:\n", "  other:\n", "household.views: .* with views among the stages of conf/data/household.yaml"),
        ("parallel:", "paralel:", "did you mean parallel"),
        ("sets:", "data:", "lacks the section graph or sets: run `python -m stages.compose`"),
        ("    renderer: ", "    rendrer: ", "unknown setting views.rendrer: did you mean views.renderer"),
        (
            "    background: black\n",
            "    background: blak\n",
            "views.background: unknown name 'blak': did you mean black?",
        ),
    ],
)
def test_a_fault_in_params_yaml_is_named(tmp_path, old, new, reason):
    text = (ROOT / "params.yaml").read_text()
    text = text[: text.index("\nfurniture:")]  # half of it takes half of the time
    assert old in text
    (tmp_path / "params.yaml").write_text(text.replace(old, new))
    with pytest.raises(ParamsError, match=reason):
        Workspace(tmp_path, "household").settings(Params)


def test_a_setting_that_is_absent_has_its_default_and_one_without_default_is_named(params):
    values = {"imprints": dict(params["household"]["imprints"]), "views": dict(params["household"]["views"])}
    del values["views"]["renderer"], values["imprints"]["cells"]
    assert check_section(schema_of("views"), values["views"]).renderer == "raster"
    few = params["household"]["stability"] | {"severities": {"tilt": [45.0]}}
    assert check_section(schema_of("stability"), few).severities == {"tilt": [45.0]}  # none of the default
    with pytest.raises(ParamsError, match=r"^imprints\.cells: "):
        check_section(schema_of("imprints"), values["imprints"])


def test_a_set_that_is_not_switched_on_and_a_missing_params_yaml_are_named(tmp_path):
    with pytest.raises(ParamsError, match="gaze is not switched on; params.yaml names household, furniture"):
        Workspace(ROOT, "gaze").settings(Params)
    with pytest.raises(ParamsError, match=r"stages\.compose"):
        Workspace(tmp_path, "household").settings(Params)

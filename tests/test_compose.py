"""Configuration: what conf/ composes is what params.yaml holds, and a slip of the pen is named."""

import sys
from importlib import import_module
from pathlib import Path

import pytest
from omegaconf import OmegaConf

from stages.compose import CONF, compose, main
from stages.engine.settings import ParamsError, Workspace
from stages.views import Params

ROOT = Path(__file__).parents[1]
GROUPS = sorted(path.name for path in CONF.iterdir() if path.is_dir())
DEFAULTS = OmegaConf.to_container(OmegaConf.load(CONF / "config.yaml"))["defaults"]
KIND = {}  # of sets that do not begin with meshes: the stage that does
OPTIONS = [(path.parent.name, path.stem) for path in sorted(CONF.glob("*/*.yaml"))]


@pytest.fixture(scope="module")
def composed():
    """What conf/ composes where nothing is chosen."""
    return compose()


@pytest.mark.slow
def test_params_yaml_is_the_composed_default(composed):
    assert (ROOT / "params.yaml").read_text() == OmegaConf.to_yaml(OmegaConf.create(composed))


@pytest.mark.slow
@pytest.mark.parametrize(("group", "option"), OPTIONS)
def test_every_option_composes_and_fits_the_schemas(composed, group, option):
    chosen = [f"sets=[{option}]"] if group == "data" else [f"{group}={option}"]
    if group == "data" and "folder: ???" in (CONF / f"data/{option}.yaml").read_text():
        chosen.append(f"{option}.{KIND.get(option, 'meshes')}.folder=somewhere")
    defaults = {next(iter(entry.items())) for entry in DEFAULTS if isinstance(entry, dict)}
    assert (compose(chosen) == composed) == ((group, option) in defaults and group != "data")


COMMANDS = ("claim x", "code", "compose", "gate", "repro", "sweep classifier=knn", "front.__main__",
            "lod.__main__ household", "report.__main__")  # fmt: skip


@pytest.mark.parametrize("command", COMMANDS)
def test_outside_a_clone_every_command_says_so_and_writes_nothing(tmp_path, monkeypatch, command):
    name, *arguments = command.split()
    module = import_module(f"stages.{name}")
    monkeypatch.setattr("sys.argv", [name, *arguments])
    monkeypatch.setattr("sys.excepthook", sys.excepthook)
    monkeypatch.chdir(tmp_path)
    with pytest.raises(ValueError, match="run it in a clone of the project"):
        module.run(arguments) if name == "claim" else module.main()
    assert not list(tmp_path.iterdir())


@pytest.mark.slow
def test_a_set_runs_only_its_stages():
    values = compose(["sets=[folder]", "meshes.folder=scans"])
    assert values["sets"] == ["folder"] and "transfer" not in values["folder"]
    assert values["graph"]["meshes"] == {"folder": "scans"} and values["graph"]["transfer"] == []


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
@pytest.mark.parametrize(
    ("override", "hint"),
    [
        ("lod.target=[10%]", "lod.targets"),
        ("profile=smok", "did you mean smoke"),
        ("profiel=smoke", "did you mean profile"),
        ("seed=many", "'many' is not of type int: give a whole number"),
        ("sets=folder", "sets: 'folder' is not of type list: write sets=[folder]"),
        ("salient_points.count=many", "give a whole number"),
        ("lod.samples=1.5", "give a whole number"),
        ("salient_points.radius=wide", "give a number"),
        ("lod.shrink=perhaps", "write true or false"),
        ("salient_points.methods=[glanse]", "salient_points.methods: unknown method 'glanse' (did you mean glance?)"),
        ("lod.methods=[qem,bendng]", "lod.methods: 'bendng': unknown method 'bendng'; methods are qem"),
        ("lod.methods=[qem,glanse-soft]", "(did you mean glance?)"),
        ("seed=-1", "negative"),
        ("experiment=table_4_8", "did you mean table_4_9"),
        ("classifier=knn,svm", "stages.sweep -m"),
        ("classification.sets.mine=[a,b]", "+classification.sets.mine"),
        ("views.size=big", "views.size"),
        ("lod.rings=-3", "lod.rings: -3 must be 0 or more"),
        ("views.size=[900,0]", "views.size: 0 must be 1 or more"),
        ("salient_points.radius=0", "salient_points.radius: 0 must be above 0"),
        ("exploration.confidences=[0.5,1.5]", "exploration.confidences: 1.5 must be between 0 and 1"),
        ("views.size=[900,-1]", "views.size: -1 must be 1 or more"),
        ("fixation.folds=1", "fixation.folds: 1 must be 2 or more"),
        ("views.material.speculr=1", "did you mean views.material.specular"),
        ("views.material.specular=2", "views: specular=2.0 of a material must be between 0 and 1"),
    ],
)
def test_a_mistyped_setting_names_the_nearest_right_one(override, hint):
    with pytest.raises(ParamsError) as error:
        compose([override])
    assert hint in str(error.value)


@pytest.mark.slow
@pytest.mark.parametrize("folder", ["scans", "/data/my scäns", 'a "b" c', "x=y,z"])
def test_any_path_can_be_given_as_it_is(folder):
    values = compose(["sets=[folder]", f"meshes.folder={folder}"])
    assert values["folder"]["meshes"]["folder"] == folder == values["graph"]["meshes"]["folder"]


@pytest.mark.slow
@pytest.mark.parametrize(
    ("old", "new", "reason"),
    [
        ("  views:\n", "  views: 3\n  other:\n", "views: 3 is not a section of settings"),
        ("seed: 0", "- a", "is not valid YAML"),
        ("seed: 0", "seed: -1", "seed: -1 is negative"),
        ("  views:\n", "  other:\n", "no section household.views"),
        ("parallel:", "paralel:", "did you mean parallel"),
        ("sets:", "data:", "lacks the section graph or sets: run `python -m stages.compose`"),
        ("    renderer: ", "    rendrer: ", "unknown setting views.rendrer: did you mean views.renderer"),
        ("    renderer: raster\n", "", "views.renderer"),
    ],
)
def test_a_fault_in_params_yaml_is_named(tmp_path, old, new, reason):
    text = (ROOT / "params.yaml").read_text()
    assert old in text
    (tmp_path / "params.yaml").write_text(text.replace(old, new))
    with pytest.raises(ParamsError, match=reason):
        Workspace(tmp_path, "household").settings(Params)


def test_a_set_that_is_not_switched_on_is_named():
    with pytest.raises(ParamsError, match="gaze is not switched on; params.yaml names household, furniture"):
        Workspace(ROOT, "gaze").settings(Params)


def test_no_params_yaml_says_what_to_do(tmp_path):
    with pytest.raises(ParamsError, match=r"stages\.compose"):
        Workspace(tmp_path, "household").settings(Params)

"""Configuration: what conf/ composes is what params.yaml holds, and a slip of the pen is named."""

from pathlib import Path

import pytest
from omegaconf import OmegaConf

from stages.compose import CONF, compose
from stages.kit.params import ParamsError, check, params

ROOT = Path(__file__).parents[1]
GROUPS = sorted(path.name for path in CONF.iterdir() if path.is_dir())
DEFAULTS = OmegaConf.to_container(OmegaConf.load(CONF / "config.yaml"))["defaults"]
OPTIONS = [(path.parent.name, path.stem) for path in sorted(CONF.glob("*/*.yaml"))]


def test_params_yaml_is_the_composed_default():
    assert (ROOT / "params.yaml").read_text() == OmegaConf.to_yaml(compose())


def test_dvc_composes_the_same(tmp_path):
    from dvc.utils.hydra import compose_and_dump

    for overrides in ([], ["profile=smoke", "seed=3"]):
        compose_and_dump(tmp_path / "params.yaml", str(CONF), None, "config", str(tmp_path), overrides)
        assert (tmp_path / "params.yaml").read_text() == OmegaConf.to_yaml(compose(overrides))


@pytest.mark.parametrize(("group", "option"), OPTIONS)
def test_every_option_composes_and_fits_the_schemas(group, option):
    chosen = [f"{group}={option}"]
    if option == "folder":
        chosen.append("meshes.folder=somewhere")
    defaults = {next(iter(entry.items())) for entry in DEFAULTS if isinstance(entry, dict)}
    assert (compose(chosen) == compose()) == ((group, option) in defaults)


@pytest.mark.parametrize(
    ("override", "hint"),
    [
        ("lod.target=[10%]", "lod.targets"),
        ("profile=smok", "did you mean smoke"),
        ("profiel=smoke", "did you mean profile"),
        ("seed=many", "seed"),
        ("seed=-1", "negative"),
        ("experiment=table_4_8", "did you mean table_4_9"),
        ("classifier=knn,svm", "stages.sweep -m"),
        ("classification.sets.mine=[a,b]", "+classification.sets.mine"),
        ("views.size=big", "views.size"),
    ],
)
def test_a_mistyped_setting_names_the_nearest_right_one(override, hint):
    with pytest.raises(ParamsError) as error:
        compose([override])
    assert hint in str(error.value)


@pytest.mark.parametrize("folder", ["~/scans", "/data/my scäns", 'a "b" c', "x=y,z"])
def test_any_path_can_be_given_as_it_is(folder):
    assert compose(["data=folder", f"meshes.folder={folder}"]).meshes.folder == folder


@pytest.mark.parametrize(
    ("text", "reason"),
    [
        ("views: 3\n", "no section of settings"),
        ("- a\n", "must hold sections"),
        ("views: [unclosed\n", "no YAML"),
        ("seed: 0\n", "no section views"),
        ("paralel: {}\nviews: {}\n", "did you mean parallel"),
    ],
)
def test_a_broken_params_yaml_is_named(tmp_path, text, reason):
    path = tmp_path / "params.yaml"
    path.write_text(text)
    with pytest.raises(ParamsError, match=reason):
        params("views", path)


def test_a_mistyped_key_in_params_yaml_names_the_nearest(tmp_path):
    text = (ROOT / "params.yaml").read_text()
    path = tmp_path / "params.yaml"
    path.write_text(text.replace("renderer:", "rendrer:"))
    with pytest.raises(ParamsError, match="unknown setting views.rendrer: did you mean views.renderer"):
        params("views", path)


def test_a_missing_key_is_named(tmp_path):
    path = tmp_path / "params.yaml"
    path.write_text("".join(line for line in (ROOT / "params.yaml").open() if "renderer:" not in line))
    with pytest.raises(ParamsError, match="views.renderer"):
        params("views", path)


def test_an_unknown_section_is_named():
    with pytest.raises(ParamsError, match="unknown setting veiws: did you mean views"):
        check({**OmegaConf.to_container(compose()), "veiws": {}})


def test_no_params_yaml_says_what_to_do(tmp_path):
    with pytest.raises(ParamsError, match=r"stages\.compose"):
        params("views", tmp_path / "none.yaml")

"""Names that went in 2.0: the message says what to use, and what it names is there."""

import re

import pytest

import haptic_glance
from haptic_glance.base.gone import GONE, went
from haptic_glance.look.points import methods
from stages.compose import compose, groups
from stages.engine.gone import GONE as GONE_OF_PIPELINE
from stages.engine.settings import ParamsError, Workspace
from stages.pipeline import STAGES, schema_of


def test_a_name_that_went_says_what_to_use_and_any_other_says_nothing():
    assert went("VisAttAllSummed") == went("visattallsummed") == "VisAttAllSummed went in 2.0; use VisAttAll+sums"
    assert went("VisAttAll") == went("") == ""
    assert not {*GONE, *GONE_OF_PIPELINE} & {*groups()["data"], *STAGES, *haptic_glance.__all__}


@pytest.mark.parametrize("name, use", [("random_2", "random+2"), ("svm_object", "svm+object")])
def test_a_method_that_went_is_refused_with_the_one_to_use(monkeypatch, name, use):
    monkeypatch.delitem(methods.METHODS, name, raising=False)
    with pytest.raises(ValueError, match=re.escape(f"unknown method '{name}': {name} went in 2.0; use {use}")):
        methods.method_named(name)


def test_a_function_that_went_is_refused_with_the_one_to_use():
    with pytest.raises(AttributeError, match="read_layout went in 2.0; use press_forces, whose array is a grid"):
        haptic_glance.read_layout  # noqa: B018


@pytest.mark.parametrize(
    "override, message",
    [
        (
            "sets=[furniture_hands]",
            "sets: unknown set furniture_hands: furniture_hands went in 2.0; use princeton_",
        ),
        ("experiment=scenes", "experiment=scenes went in 2.0; use the set household with scene="),
        ("scene.random=3", "scene.random went in 2.0; use scene=shelf, table or hall"),
        ("household.stability.broken=[]", "stability.broken went in 2.0; leave it out: "),
        ("face_needs.touches=3", "face_needs went in 2.0; use the stage scene, "),
        ("touch_stability.denoisers=[median]", "median went in 2.0; use touch_stability.denoisers=[autoencoder]"),
    ],
)
def test_a_setting_that_went_is_refused_with_the_one_to_use(override, message):
    with pytest.raises(ParamsError, match=re.escape(message)):
        compose([override])


def test_every_setting_to_use_is_there():
    for words in GONE_OF_PIPELINE.values():
        for section, key in re.findall(r"\b(\w+)\.(\w+)", words.replace("haptic_glance.know", "")):
            assert key in schema_of(section).__dataclass_fields__


def test_params_of_version_1_are_refused_with_the_command_that_writes_them_anew(tmp_path):
    (tmp_path / "params.yaml").write_text("sets: [household]\ngraph: {annotations: [household], views: [household]}\n")
    with pytest.raises(ParamsError, match="is of version 1: run `python -m stages.compose` with your settings"):
        Workspace(tmp_path).params  # noqa: B018

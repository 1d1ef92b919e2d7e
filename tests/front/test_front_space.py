"""A choice is an option at every stage, which Hydra composes and checks."""

from dataclasses import asdict, replace
from pathlib import Path

import pytest

from haptic_glance.look.points.methods import METHODS
from haptic_glance.look.views.viewpoints import VIEWPOINTS
from stages.engine.settings import ParamsError
from stages.front.space import DEFAULT, SPACE, WIDTH, choice_of, one_choice_changed, settings_of
from stages.imprints import Params as Imprints

ROOT = Path(__file__).parents[2]
OPTIONS = {name: options[0] for name, options in SPACE.items()}
BLIND, ITTI = (choice_of(OPTIONS | {"method": method}) for method in ("random", "itti"))


def test_a_method_without_channels_looks_at_no_picture():
    assert (BLIND.viewpoints, BLIND.image_rows) == ("", 0) and ITTI.image_rows == 450
    assert choice_of(OPTIONS | {"method": "random", "viewpoints": "four"}) == BLIND
    assert BLIND.columns["image_rows"] is None and BLIND.columns["cells"] == 16
    assert BLIND.name == "random-60-16-100pct-1-knn"


def test_every_option_is_one_of_its_stage():
    assert set(SPACE["method"]) <= set(METHODS) and set(SPACE["viewpoints"]) <= set(VIEWPOINTS)
    assert set(SPACE["classifier"]) <= {path.stem for path in (ROOT / "conf/classifier").glob("*.yaml")}


@pytest.mark.slow
def test_settings_are_those_of_the_choice():
    choice = replace(ITTI, viewpoints="four", image_rows=225, cells=8, level="500", touches=3, classifier="svm")
    settings = settings_of(choice)
    assert (settings.views.viewpoints, settings.views.size, settings.conspicuity.size) == ("four", [225, 300], [56, 75])
    assert settings.lod.targets == ["500"] and settings.classification.touches == [3]
    assert settings.classification.classifiers == ["svm"] and settings.salient_points.count == 60
    assert isinstance(settings.imprints, Imprints) and settings.imprints.cells == [8, 8]
    assert settings.imprints.cells[0] * settings.imprints.pitch == pytest.approx(WIDTH)


def test_an_option_that_the_settings_do_not_know_is_named():
    with pytest.raises(ParamsError, match="unknown option classifier=nn"):
        settings_of(replace(DEFAULT, classifier="nn"))
    with pytest.raises(ValueError, match="unknown method 'attention'"):
        choice_of(OPTIONS | {"method": "attention"})


def test_one_choice_changed_differs_in_one_stage():
    choices = list(one_choice_changed(BLIND))
    assert len(choices) == len(set(choices)) and BLIND not in choices
    for other in choices:
        changed = {key for key, value in asdict(other).items() if value != asdict(BLIND)[key]}
        assert len(changed - {"viewpoints", "image_rows"}) == 1
    pictures = [other for other in choices if other.image_rows]
    assert {other.method for other in pictures} == {"thesis_ssim", "itti"}
    assert {(other.viewpoints, other.image_rows) for other in pictures} == {("twelve", 450)}
    assert len(choices) == sum(map(len, SPACE.values())) - len(SPACE) - (2 + 2 - 2)

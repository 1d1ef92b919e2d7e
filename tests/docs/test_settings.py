"""Each setting is documented once: in conf/config.yaml, or beside its type where a group of conf/ sets it."""

import re
from pathlib import Path

import pytest

pytest.importorskip("sphinx")
from _extensions.settings import settings

from stages.engine.code import stage_names
from stages.engine.settings import schema_of

ROOT = Path(__file__).parents[2]


def test_each_setting_is_documented_once():
    documented = settings()
    for section in stage_names():
        text = (ROOT / "stages" / section / "__init__.py").read_text(encoding="utf-8")
        beside = re.findall(r"^    (\w+): [^#\n]+# \S", text[text.index("class Params") :], re.M)
        in_conf = [name for name, (_, meaning) in documented.get(section, {}).items() if meaning]
        assert sorted(beside + in_conf) == sorted(schema_of(section).__dataclass_fields__), section


def test_each_default_is_shown_and_the_section_of_hydra_is_not():
    listed = settings()
    assert listed["report"]["viewer_objects"][0].startswith("[") and "hydra" not in listed
    assert not [name for section in listed.values() for name, (default, _) in section.items() if not default]


def test_a_default_and_its_meaning_are_read():
    assert settings()["lod"]["rings"] == ("3", "edges around a kept point within which every face is frozen (T3.1.3)")

"""The table of settings in the documentation: every setting of every stage, with its default and its meaning."""

import pytest

pytest.importorskip("sphinx")
from _extensions.settings import BY_OPTION, settings


def test_each_setting_has_a_meaning_and_a_default_or_says_who_sets_it():
    listed = settings()
    assert all(meaning and default for section in listed.values() for default, meaning in section.values())
    assert listed["report"]["viewer_objects"][0].startswith("[") and listed["imprints"]["cells"][0] == BY_OPTION


def test_a_default_and_its_meaning_are_read():
    assert settings()["lod"]["rings"] == ("3", "edges around a kept point within which every face is frozen (T3.1.3)")

"""Checks of attention on meshes with human gaze: the thesis's best viewpoints, and choices made without the object."""

from dataclasses import dataclass

from stages.engine.settings import setting

COLUMNS = {
    "views": "set of viewpoints: a name of VIEWS in stages/attention_checks/__main__.py",
    "chosen": "the features that the glance has, of methods `_once` and `_nested`",
}


def _views():
    from stages.attention_checks.__main__ import VIEWS

    return VIEWS


@dataclass
class Params:
    """Section `attention_checks` of params.yaml."""

    views: list[str] = setting(
        ["best", "four", "twelve"],
        "sets of viewpoints that equal weights look from: best has four to eight of 62 (T3.2.4)",
        least=1,
        names=_views,
    )

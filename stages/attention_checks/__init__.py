"""Checks of attention on meshes with human gaze: the thesis's best viewpoints, and choices made without the object."""

from dataclasses import dataclass

COLUMNS = {
    "views": "set of viewpoints: a name of VIEWS in stages/attention_checks/__main__.py",
    "chosen": "the features that the glance has, of methods `_once` and `_nested`",
}


@dataclass
class Params:
    """Section `attention_checks` of params.yaml."""

    views: list[str]

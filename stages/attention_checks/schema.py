"""The settings of the attention_checks stage, and what its rows hold."""

from dataclasses import dataclass

COLUMNS = {
    "views": "set of viewpoints: a name of stages.attention_checks.viewpoints.VIEWS",
    "chosen": "the features that the glance has, of methods `_once` and `_nested`",
}


@dataclass
class Params:
    """Section `attention_checks` of params.yaml."""

    views: list[str]  # sets of viewpoints: best (T3.2.4), four or twelve

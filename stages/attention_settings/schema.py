"""The settings of the attention_settings stage, and what its rows hold."""

from dataclasses import dataclass

COLUMNS = {
    "views": "set of viewpoints: a name of stages.attention_settings.measure.VIEWS",
    "rows": "rows of an image",
    "channels": "a name of stages.attention_settings.judge.CHOICES; of methods `_once` and `_nested` the features",
}


@dataclass
class Params:
    """Section `attention_settings` of params.yaml."""

    pictures: list[str]  # VIEWS-ROWS: sets of viewpoints and rows of an image
    full: list[str]  # those of `pictures` that are judged with every choice of channels
    channels: list[str]  # choices of channels that the others are judged with

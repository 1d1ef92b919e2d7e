"""The shell command that measures rows which are missing, or measures them again."""

from collections.abc import Iterable
from functools import cache
from pathlib import Path

import yaml

COMPOSE = "python -m stages.compose"


@cache
def switch(conf: Path, dataset: str, stage: str) -> str:
    """Arguments of compose that run a stage on a set: nothing for the default run, an experiment, or the set alone.

    conf: the folder of the configuration; what it lacks is not known.
    """
    defaults = _read(conf / "config.yaml").get("sets", ())
    if dataset in defaults and stage in _read(conf / f"data/{dataset}.yaml").get("stages", ()):
        return ""
    for path in sorted((conf / "experiment").glob("*.yaml")):
        experiment = _read(path)
        if dataset in experiment.get("sets", ()) and stage in experiment.get("stages", [stage]):
            return f"experiment={path.stem}"
    return f"'sets=[{dataset}]'"


def command(conf: Path, stage: str, sets: Iterable[str]) -> str:
    """The command that measures a stage on all of the sets, and draws the report again."""
    conf = conf.resolve()  # `switch` remembers folders, and the same relative one may be another folder later
    together: dict[str, list[str]] = {}
    for name in sets:
        together.setdefault(switch(conf, name, stage), []).append(f"{stage}@{name}")
    parts = (f"{COMPOSE} {option}".rstrip() + f" && dvc repro {' '.join(names)}" for option, names in together.items())
    return " && ".join(parts) + " report"


@cache
def _read(path: Path) -> dict:
    """The content of a file of the configuration, which one run of the report asks for some hundred times."""
    return yaml.safe_load(path.read_text(encoding="utf-8")) or {} if path.is_file() else {}

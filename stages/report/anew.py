"""What to type to measure the rows of a claim anew."""

from collections.abc import Iterable
from functools import cache
from pathlib import Path

import yaml

COMPOSE = "python -m stages.compose"


@cache
def switch(conf: Path, dataset: str, stage: str) -> str:
    """What to compose so that a stage runs on a set: nothing for the default run, an experiment, or the set alone.

    conf: the folder of the configuration; what it lacks is not known.
    """
    defaults = _read(conf / "config.yaml").get("sets", ())
    if dataset in defaults and stage in _read(conf / f"data/{dataset}.yaml").get("stages", ()):
        return ""
    for path in sorted((conf / "experiment").glob("*.yaml")):
        chosen = _read(path)
        if dataset in chosen.get("sets", ()) and stage in chosen.get("stages", [stage]):
            return f"experiment={path.stem}"
    return f"'sets=[{dataset}]'"


def command(conf: Path, stage: str, sets: Iterable[str]) -> str:
    """What measures a stage on all of the sets, and judges again."""
    conf = conf.resolve()  # `switch` remembers folders, and the same relative one may be another folder later
    together: dict[str, list[str]] = {}
    for name in sets:
        together.setdefault(switch(conf, name, stage), []).append(f"{stage}@{name}")
    parts = (f"{COMPOSE} {chosen}".rstrip() + f" && dvc repro {' '.join(names)}" for chosen, names in together.items())
    return " && ".join(parts) + " report"


def _read(path: Path) -> dict:
    return yaml.safe_load(path.read_text(encoding="utf-8")) or {} if path.is_file() else {}

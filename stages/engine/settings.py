"""Settings of the stages (params.yaml, checked against the typed schema of each section), and the workspace of a run.

The workspace has the repository root, its settings, and the data set that a stage runs on.
"""

import argparse
import copy
import difflib
from collections.abc import Callable, Container, Iterator
from dataclasses import dataclass, field, fields
from functools import cached_property
from pathlib import Path
from typing import Any, TypeVar, get_type_hints

import numpy as np
from omegaconf import MISSING, OmegaConf
from omegaconf.errors import OmegaConfBaseException
from yaml import YAMLError

from haptic_glance.base.errors import errors_in_one_line

from .gone import went_of

FILE = Path("params.yaml")
CODE = Path("code.yaml")  # {stage: digest of its code}, by stages.code
COMMON = {"profile": str, "out": str, "seed": int, "parallel": dict, "sets": list, "graph": dict, "report": dict}

REMEDIES = {"Integer": "give a whole number", "Float": "give a number", "bool": "write true or false",
            "ListConfig": "write a list in brackets", "subclass of str": "write such a name in quotes"}  # fmt: skip
Settings = TypeVar("Settings")


REQUIRED: Any = MISSING  # in place of a default: an option of conf/ or a data set gives the value
Names = Callable[[], Container[str] | Callable[[str], object]]  # imports names late, or a function that refuses others


def setting(
    default: Any,
    meaning: str,
    least: float | None = None,
    above: float | None = None,
    most: float | None = None,
    names: Names | None = None,
) -> Any:
    """A field of a stage's `Params`: its default and its meaning, a sentence that the documentation shows.

    least, above, most: bounds of its numbers, which may stand in lists or by name; names: what its texts may be.
    """
    rules = {"meaning": meaning, "least": least, "above": above, "most": most, "names": names}
    if isinstance(default, list | dict):
        return field(default_factory=lambda: copy.deepcopy(default), metadata=rules)
    return field(default=default, metadata=rules)


def defaults_of(schema: type) -> dict[str, Any]:
    """{setting: default} of a schema, without those that are REQUIRED, as plain dicts and lists."""
    values: Any = OmegaConf.to_container(OmegaConf.structured(schema))
    return {key: value for key, value in values.items() if value != MISSING}


class ParamsError(ValueError):
    """A setting that no schema knows, or of the wrong type; the message names the nearest right one."""


def load_params(path: str | Path = FILE) -> dict[str, Any]:
    """The whole params.yaml as plain dicts; {} where there is none."""
    path = Path(path)
    if not path.exists():
        return {}
    try:
        values = OmegaConf.to_container(OmegaConf.load(path))
    except (YAMLError, OmegaConfBaseException, ValueError, RecursionError) as error:
        raise ParamsError(f"{path} is not valid YAML: {' '.join(str(error).split())}") from None
    if not isinstance(values, dict):
        raise ParamsError(f"{path} must hold sections, not a {type(values).__name__}")
    return {str(key): value for key, value in values.items()}


def section_of(schema: type) -> str:
    """The section that a schema belongs to: `lod` for stages.lod.Params."""
    return schema.__module__.split(".")[-1]


def check_section(schema: type[Settings], values: Any) -> Settings:
    """Checks the values of a section against its schema and returns them as an instance of it."""
    section = section_of(schema)
    if not isinstance(values, dict):
        raise ParamsError(f"{section}: {values!r} is not a section of settings")
    typed = OmegaConf.structured(schema)
    defaults: Any = OmegaConf.to_container(typed, throw_on_missing=False)
    _check_keys(section, values, list(defaults))
    _check_texts(schema, values)
    for key, value in values.items():
        if isinstance(value, dict) and OmegaConf.get_type(typed, key) is dict:
            typed[key] = {}  # the names that a person gives are all: those of the default do not come back
    try:
        merged = OmegaConf.merge(typed, values)
        _check_bounds(schema, OmegaConf.to_container(merged))  # type: ignore[arg-type]  # a dict; `nan` may be a name
        return OmegaConf.to_object(merged)  # type: ignore[return-value]  # of the schema's type
    except OmegaConfBaseException as error:
        key = f"{section}.{error.full_key}" if error.full_key else section
        reason = str(error).splitlines()[0].rstrip(".")
        remedy = next((f": {words}" for kind, words in REMEDIES.items() if f" {kind}" in reason), "")
        raise ParamsError(f"{key}: {reason}{remedy}") from None
    except ValueError as error:  # a schema's own check
        raise ParamsError(f"{section}: {error}") from None


def _check_texts(schema: type, values: dict[str, Any]) -> None:
    """ParamsError for a name in a list that YAML reads as another text: 1e5 as 100000.0, true as True."""
    for key, kind in get_type_hints(schema).items():
        parts = values.get(key) if kind == list[str] else None
        for part in parts if isinstance(parts, list) else ():
            if isinstance(part, bool) or (isinstance(part, float) and np.isfinite(part)):  # nan stays the name nan
                remedy = REMEDIES["subclass of str"]
                raise ParamsError(f"{section_of(schema)}.{key}: {part} is how YAML reads a name: {remedy}")


def check_common(values: dict[str, Any]) -> None:
    """Checks the names of the sections and the settings that all stages share."""
    if "graph" not in values or "sets" not in values:
        raise ParamsError(f"{FILE} lacks the section graph or sets: run `python -m stages.compose` to make it anew")
    for key, kind in COMMON.items():
        if key in values and not isinstance(values[key], kind):
            remedy = {list: f"write {key}=[{str(values[key]).strip('[]')}]", int: REMEDIES["Integer"]}.get(
                kind, f"give a {kind.__name__}"
            )
            raise ParamsError(f"{key}: {values[key]!r} is not of type {kind.__name__}: {remedy}")
    _check_keys("", values, [*COMMON, *values["sets"]])
    if values.get("seed", 0) < 0:
        raise ParamsError(f"seed: {values['seed']} is negative")


def check_names(schema: type, values: dict[str, Any]) -> None:
    """ParamsError for a value that is not among the names of its setting; imports the modules that have the names."""
    section = section_of(schema)
    for each in fields(schema):
        names = each.metadata.get("names")
        if names is None or each.name not in values:
            continue
        try:
            known = names()
        except ModuleNotFoundError:  # the stage says which package it needs
            continue
        value = values[each.name]
        texts = list(map(str, value if isinstance(value, list | dict) else [value]))  # YAML reads 12 as a number
        if twice := [text for text in dict.fromkeys(texts) if texts.count(text) > 1]:
            raise ParamsError(f"{section}.{each.name} names {', '.join(twice)} twice")
        for text in texts:
            try:
                if callable(known):
                    known(text)
                elif text not in known:
                    raise ValueError(f"unknown name {text!r}: {nearest(text, list(known))}")
            except ValueError as error:
                raise ParamsError(f"{section}.{each.name}: {error}") from None


def nearest(name: str, options: list[str], where: str = "") -> str:
    """`did you mean NAME?`, what to use for a name that went, or all options; where: comes before the name."""
    if hint := went_of(f"{where}{name}"):
        return hint
    matches = difflib.get_close_matches(name, options, n=1, cutoff=0.5)
    return f"did you mean {where}{matches[0]}?" if matches else f"known: {', '.join(dict.fromkeys(options))}"


def _check_bounds(schema: type, values: dict[str, Any]) -> None:
    """ParamsError for a number outside the bounds of its setting."""
    for each in fields(schema):
        value, rules = values.get(each.name), each.metadata
        where = f"{section_of(schema)}.{each.name}"
        if each.name == "size" and isinstance(value, list) and len(value) != 2:
            raise ParamsError(f"{where}: {value} must be [rows, columns]")
        least, above, most = (rules.get(name) for name in ("least", "above", "most"))
        for number in _numbers(value):
            low = (least is None or number >= least) and (above is None or number > above)
            if not (low and (most is None or number <= most)):
                bounds = f"{least:g} or more" if above is None else f"above {above:g}"
                if most is not None:
                    bounds = f"between {least if above is None else above:g} and {most:g}"
                raise ParamsError(f"{where}: {number:g} must be {bounds}")


def _numbers(value: Any) -> Iterator[float]:
    if isinstance(value, int | float) and not isinstance(value, bool):
        yield value
    for part in value.values() if isinstance(value, dict) else value if isinstance(value, list) else ():
        yield from _numbers(part)


def _check_keys(where: str, values: dict[str, Any], keys: list[Any]) -> None:
    for key in values:
        if key not in keys:
            prefix = f"{where}." if where else ""
            raise ParamsError(f"unknown setting {prefix}{key}: {nearest(key, keys, prefix)}")


def begins_with(sections: dict[str, Any], stage: str, dataset: str) -> str:
    """The path whose change makes a first stage run again: the set's files, or its settings where they are fetched.

    The stage weights reads where people look, which an archive has beside its meshes.
    """
    folder = sections["meshes" if stage in ("meshes", "weights") else "recorded"].get("folder")
    return str(Path(folder).expanduser()) if folder else f"conf/data/{dataset}.yaml"


def _check_start(params: dict[str, Any], stage: str, dataset: str) -> None:
    """Raises ParamsError where a stage reads another path than DVC watches: changes there would give old results."""
    watched = params["graph"][stage]
    if isinstance(watched, dict) and dataset in watched:
        read = begins_with(params[dataset], stage, dataset)
        if read != watched[dataset]:
            raise ParamsError(
                f"{stage} would read {read}, but graph.{stage}.{dataset} is {watched[dataset]}, which DVC watches: "
                "run `python -m stages.compose` with your settings, or set both"
            )


def conf_folder() -> Path:
    """The folder conf/ of the clone."""
    return Path(__file__).parents[2] / "conf"


def check_clone(root: Path = Path(".")) -> None:
    """Raises ValueError where the folder is not a clone of the project; commands ask before they write anything."""
    if not (root / "dvc.yaml").exists():
        raise ValueError(f"no {root / 'dvc.yaml'}: run it in a clone of the project")


PUBLISHED = "reports"


@dataclass(frozen=True)
class Workspace:
    """Everything that a stage reads or writes lies below `root`; what belongs to a data set lies below its name.

    root: the folder that holds params.yaml. dataset: a set that params.yaml names, empty for what is about all sets.
    """

    root: Path
    dataset: str = ""

    @property
    def data(self) -> Path:
        """data/SET: a folder for each stage."""
        return self.root / "data" / self.dataset

    @property
    def reports(self) -> Path:
        """The folder of tables, figures, measurements and metrics: that of the published ones, or the run's own."""
        return self.root / self.params.get("out", PUBLISHED)

    @property
    def published(self) -> Path:
        """The folder of the published results, which git keeps; only the published configuration writes there."""
        return self.root / PUBLISHED

    @property
    def measurements(self) -> Path:
        """measurements/SET below `reports`: a table of rows for each stage."""
        return self.reports / "measurements" / self.dataset

    @property
    def metrics(self) -> Path:
        """metrics/SET below `reports`: a file of a few numbers for each stage."""
        return self.reports / "metrics" / self.dataset

    @property
    def build(self) -> Path:
        """The files that may be deleted at any time: the cache of objects, unfinished runs."""
        return self.root / "build"

    @cached_property
    def params(self) -> dict[str, Any]:
        """The whole params.yaml; ParamsError where there is none, it is of version 1, or lacks the common sections."""
        path = self.root / FILE
        if not path.exists():
            raise ParamsError(f"there is no {path}: change to the repository root, or run `python -m stages.compose`")
        values = load_params(path)
        check_common(values)
        if any(map(went_of, values["graph"])):
            raise ParamsError(f"{path} is of version 1: run `python -m stages.compose` with your settings")
        return values

    @property
    def seed(self) -> int:
        """The seed of all random numbers; an item's name joins it."""
        return self.params["seed"]

    @property
    def parallel(self) -> dict[str, Any]:
        """How items run in parallel: backend and workers."""
        return self.params.get("parallel", {})

    @property
    def sets(self) -> list[str]:
        """The data sets that are switched on, in order."""
        return list(self.params["sets"])

    def on(self, dataset: str) -> "Workspace":
        """The same root, another data set."""
        return Workspace(self.root, dataset)

    def settings(self, schema: type[Settings]) -> Settings:
        """The settings of one stage as an instance of its schema: `workspace.settings(stages.lod.Params)`.

        Raises ParamsError for a section that is absent, a key that the schema does not have, a wrong type, or a value
        that is not among the names of its setting.
        """
        section = section_of(schema)
        if self.dataset and self.dataset not in self.sets:
            hint = went_of(self.dataset) or f"{FILE} names {', '.join(self.sets)}"
            raise ParamsError(f"{self.dataset} is not switched on; {hint}")
        values = self.params.get(self.dataset, {}) if self.dataset else self.params
        if section not in values:
            where, remedy = section, "run `python -m stages.compose` anew"
            if self.dataset:
                where = f"{self.dataset}.{section}"
                remedy += f", with {section} among the stages of conf/data/{self.dataset}.yaml"
            raise ParamsError(f"{self.root / FILE} has no section {where}: {remedy}")
        settings = check_section(schema, values[section])
        check_names(schema, values[section])
        return settings


def workspace_of_arguments(doc: str | None, stage: str) -> Workspace:
    """The workspace that the command line of a stage names: `python -m stages.lod household`.

    Answers --help with the stage's docstring, and lets errors of input and settings end in one line. A stage has no
    other setting on its command line: they live in params.yaml. Without a set, the stage runs on the only one that it
    is switched on for.
    """
    first, _, rest = (doc or "").partition("\n")
    parser = argparse.ArgumentParser(
        prog=f"python -m stages.{stage}",
        description=first,
        epilog=rest,
        formatter_class=argparse.RawDescriptionHelpFormatter,
    )
    help_text = "a data set of params.yaml; runs that are not published write to their folder `out`, not to reports/"
    parser.add_argument("dataset", nargs="?", default="", help=help_text)
    parser.add_argument("--root", type=Path, default=Path("."), help="the folder of params.yaml (default: this one)")
    errors_in_one_line(stage)
    options = parser.parse_args()
    check_clone(options.root)
    workspace = Workspace(options.root)
    if stage not in workspace.params["graph"]:
        if options.dataset:
            raise ValueError(f"this stage is about all sets that params.yaml names: leave {options.dataset} out")
        return workspace
    dataset = options.dataset or _only_set(workspace, stage)
    _check_start(workspace.params, stage, dataset)
    return workspace.on(dataset)


def _only_set(workspace: Workspace, stage: str) -> str:
    sets = list(workspace.params["graph"][stage])
    if len(sets) != 1:
        choice = f"one of {', '.join(sets)}" if sets else "none is switched on: see `python -m stages.compose --help`"
        raise ValueError(f"name the data set: {choice}")
    return sets[0]

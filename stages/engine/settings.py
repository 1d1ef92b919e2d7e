"""Settings of the stages (params.yaml, checked against the typed schema of each section), and the workspace of a run.

The workspace has the repository root, its settings, and the data set that a stage runs on.
"""

import argparse
import difflib
import importlib
from collections.abc import Iterator
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import Any, TypeVar, get_type_hints

import numpy as np
from omegaconf import OmegaConf
from omegaconf.errors import OmegaConfBaseException
from yaml import YAMLError

from haptic_glance.base.errors import errors_in_one_line

FILE = Path("params.yaml")
COMMON = {"profile": str, "out": str, "seed": int, "parallel": dict, "sets": list, "graph": dict, "report": dict}

ABOVE_0 = np.nextafter(0, 1)
RANGES = {  # the last part of a setting's name: the least and the greatest of its numbers, in every section
    **dict.fromkeys(
        ("azimuths", "batch", "cells", "coarse_cells", "combinations", "copies", "count", "draws", "epochs", "frames",
         "hybrid_pictures", "image_epochs", "most", "new_object_touches", "normal_epochs", "parallels", "repetitions",
         "samples", "screen", "search_epochs", "simulated", "size", "steps", "touches", "trainings", "views",
         "viewer_count", "viewer_faces"), (1, np.inf)
    ),
    **dict.fromkeys(("drawn", "hold", "limit", "real", "rings", "slack", "smoothing"), (0, np.inf)),
    **dict.fromkeys(
        ("distances", "factors", "finetuned_rates", "frozen_rates", "hybrid_rate", "near", "penalties", "pitch",
         "pitches", "radius", "rate", "rates", "tolerance", "width"), (ABOVE_0, np.inf)
    ),
    **dict.fromkeys(("confidences", "momentum", "train_share", "validation_share"), (0, 1)),
    "folds": (2, np.inf), "angle": (ABOVE_0, 180),
}  # fmt: skip

NAMES = {  # section: {setting: MODULE:NAME of the names that its values have, or of a function that refuses others}
    "attention_checks": {"views": "stages.attention_checks.__main__:VIEWS"},
    "classification": {"classifiers": "haptic_glance.know.classifiers:CLASSIFIERS"},
    "coarse_imprints": {"variants": "stages.coarse_imprints.__main__:VARIANTS"},
    "conspicuity": {
        "background": "haptic_glance.look.channels.cropped_view:BACKGROUNDS",
        "channels": "haptic_glance.look.channels.channels:MAPS",
        "formulas": "haptic_glance.look.channels.printed:FORMULAS",
        "symmetry": "haptic_glance.look.channels.channels:SYMMETRIES",
    },
    "exploration": {"methods": "haptic_glance.look.points.methods:method_named"},
    "fixation": {
        "methods": "stages.fixation.backbone:method_named",
        "projection": "stages.fixation.places:PROJECTIONS",
    },
    "imprints": {
        "contact": "haptic_glance.touch.quasi_tangent:SENSORS",
        "methods": "haptic_glance.look.points.methods:method_named",
    },
    "lod": {
        "backend": "haptic_glance.lod.simplify:BACKENDS",
        "methods": "haptic_glance.lod.task:variant",
        "targets": "haptic_glance.lod.export:face_count",
        "viewpoints": "haptic_glance.look.views.viewpoints:VIEWPOINTS",
    },
    "meshes": {"colours": "haptic_glance.mesh.materials:COLOURS", "source": "stages.meshes.sources:SOURCES"},
    "salient_points": {
        "methods": "haptic_glance.look.points.methods:method_named",
        "selection": "haptic_glance.look.points.options:SELECTIONS",
    },
    "sensor_size": {
        "classifiers": "stages.sensor_size.protocol:CLASSIFIERS",
        "extents": "stages.sensor_size.protocol:EXTENTS",
    },
    "simulated_to_real": {"simulations": "stages.simulated_to_real.__main__:SIMULATIONS"},
    "stability": {
        "methods": "haptic_glance.look.points.methods:method_named",
        "perturbations": "haptic_glance.disturb.objects:PERTURBATIONS",
        "severities": "haptic_glance.disturb.objects:PERTURBATIONS",
    },
    "touch_stability": {
        "classifiers": "haptic_glance.know.classifiers:CLASSIFIERS",
        "denoisers": "stages.touch_stability.denoisers:DENOISERS",
        "severities": "haptic_glance.disturb.touches:TOUCH_PERTURBATIONS",
    },
    "transfer": {
        "hybrid_severities": "haptic_glance.disturb.picture:KNOWN",
        "networks": "haptic_glance.deep.network:NETWORKS",
        "severities": "haptic_glance.disturb.imprint:KNOWN",
        "splits": "stages.transfer.plan:SPLITS",
        "uncontrolled": "haptic_glance.deep.network:NETWORKS",
        "weights": "haptic_glance.deep.network:WEIGHTS",
    },
    "views": {
        "background": "haptic_glance.look.views.view:BACKGROUNDS",
        "viewpoints": "haptic_glance.look.views.viewpoints:VIEWPOINTS",
    },
    "weights": {"method": "stages.weights.training:CHOICES", "svm": "stages.weights.training:PIXELS"},
}
REMEDIES = {"Integer": "give a whole number", "Float": "give a number", "bool": "write true or false",
            "ListConfig": "write a list in brackets", "subclass of str": "write such a name in quotes"}  # fmt: skip
Settings = TypeVar("Settings")


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


def schema_of(section: str) -> type:
    """The typed schema of a section: the dataclass `Params` of stages/SECTION/__init__.py."""
    return importlib.import_module(f"stages.{section}").Params


def check_section(schema: type[Settings], values: Any) -> Settings:
    """Checks the values of a section against its schema and returns them as an instance of it."""
    section = section_of(schema)
    if not isinstance(values, dict):
        raise ParamsError(f"{section}: {values!r} is not a section of settings")
    typed = OmegaConf.structured(schema)
    defaults: Any = OmegaConf.to_container(typed, throw_on_missing=False)
    _check_keys(section, values, list(defaults))
    _check_texts(schema, values)
    try:
        merged = OmegaConf.merge(typed, values)
        _check_ranges(section, OmegaConf.to_container(merged))  # type: ignore[arg-type]  # a dict; `nan` may be a name
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


def check_names(section: str, values: dict[str, Any]) -> None:
    """ParamsError for a value that is not among the NAMES of its setting; imports the modules that have the names."""
    for key, place in NAMES.get(section, {}).items():
        if key not in values:
            continue
        module, _, name = place.partition(":")
        try:
            known = getattr(importlib.import_module(module), name)
        except ModuleNotFoundError:  # the stage says which package it needs
            continue
        parts = values[key] if isinstance(values[key], list | dict) else [values[key]]
        names = list(map(str, parts))  # YAML reads 12 as a number
        if twice := [value for value in dict.fromkeys(names) if names.count(value) > 1]:
            raise ParamsError(f"{section}.{key} names {', '.join(twice)} twice")
        for value in names:
            try:
                if callable(known):
                    known(value)
                elif value not in known:
                    raise ValueError(f"unknown name {value!r}: {nearest(value, list(known))}")
            except ValueError as error:
                raise ParamsError(f"{section}.{key}: {error}") from None


def nearest(name: str, options: list[str], where: str = "") -> str:
    """`did you mean NAME?`, or all options where none resembles the name; where: comes before the nearest one."""
    matches = difflib.get_close_matches(name, options, n=1, cutoff=0.5)
    return f"did you mean {where}{matches[0]}?" if matches else f"known: {', '.join(dict.fromkeys(options))}"


def _check_ranges(where: str, values: dict[str, Any]) -> None:
    """ParamsError for a number outside the range of its setting; numbers may stand in lists, or one a name."""
    for key, value in values.items():
        if isinstance(value, dict) and key not in RANGES:
            _check_ranges(f"{where}.{key}", value)
            continue
        if key == "size" and isinstance(value, list) and len(value) != 2:
            raise ParamsError(f"{where}.{key}: {value} must be [rows, columns]")
        lowest, highest = RANGES.get(key, (-np.inf, np.inf))
        for number in _numbers(value):
            if not lowest <= number <= highest:
                low = "above 0" if lowest == ABOVE_0 else f"{lowest:g} or more"
                bounds = low if highest == np.inf else f"between {0 if lowest == ABOVE_0 else lowest:g} and {highest:g}"
                raise ParamsError(f"{where}.{key}: {number:g} must be {bounds}")


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
        """The files that may be deleted at any time: digests of code, the cache of objects, unfinished runs."""
        return self.root / "build"

    @cached_property
    def params(self) -> dict[str, Any]:
        """The whole params.yaml; ParamsError where there is none or it lacks the common sections."""
        path = self.root / FILE
        if not path.exists():
            raise ParamsError(f"there is no {path}: change to the repository root, or run `python -m stages.compose`")
        values = load_params(path)
        check_common(values)
        return values

    @property
    def seed(self) -> int:
        """The seed of all random numbers; an item's name joins it."""
        return self.params["seed"]

    @property
    def parallel(self) -> dict[str, Any]:
        """How items run side by side: backend and workers."""
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
            raise ParamsError(f"{self.dataset} is not switched on; {FILE} names {', '.join(self.sets)}")
        values = self.params.get(self.dataset, {}) if self.dataset else self.params
        if section not in values:
            where, remedy = section, "run `python -m stages.compose` anew"
            if self.dataset:
                where = f"{self.dataset}.{section}"
                remedy += f", with {section} among the stages of conf/data/{self.dataset}.yaml"
            raise ParamsError(f"{self.root / FILE} has no section {where}: {remedy}")
        settings = check_section(schema, values[section])
        check_names(section, values[section])
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

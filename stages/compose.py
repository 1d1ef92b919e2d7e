"""Composes conf/ into params.yaml: `python -m stages.compose [group=option] [section.key=value] ...`

Examples: `python -m stages.compose profile=smoke`, `python -m stages.compose sets=[folder] meshes.folder=~/scans`,
`python -m stages.compose sets=[household,gaze] gaze.lod.rings=2`. A setting holds for every set; with a set's name
before it, for that set alone. The pipeline reads params.yaml alone. Without arguments, the command restores the
published configuration, whose results are in reports/. Every other choice writes to its own folder below runs/, where
git ignores all files but headlines.json; out=FOLDER names another folder.
"""

import argparse
import difflib
import os
import re
import sys
from collections.abc import Sequence
from functools import cache
from pathlib import Path
from typing import Any

import hydra
from hydra.core.config_store import ConfigStore
from hydra.core.override_parser.overrides_parser import OverridesParser
from hydra.errors import HydraException
from omegaconf import DictConfig, OmegaConf
from omegaconf.errors import OmegaConfBaseException

from haptic_glance.base.errors import errors_in_one_line
from haptic_glance.base.files import write_text
from stages.engine.code import stage_names
from stages.engine.gone import went_of
from stages.engine.parallel import BACKENDS
from stages.engine.settings import (
    FILE,
    PUBLISHED,
    ParamsError,
    begins_with,
    check_clone,
    check_common,
    check_names,
    check_section,
    conf_folder,
    defaults_of,
    nearest,
)
from stages.pipeline import STAGES, schema_of

OPEN = ("classification.sets", "meshes.classes", "transfer.networks")  # sections whose keys a person may add to
CONF = conf_folder()
SHARED = ("profile", "out", "seed", "parallel", "sets", "report")  # what is said once, not for each set
TREE = ("benchmarks", "conf", "data", "docs", "haptic_glance", "samples", "stages", "tests")  # of this project
RUNS = "runs"  # below it are the results of every configuration but the published one
READ_TOO = {  # sections that a stage also reads
    "touch_stability": ["classification"],
    "simulated_to_real": ["recorded"],
    "recorded_networks": ["recorded"],
}


def compose(overrides: Sequence[str] = ()) -> dict[str, Any]:
    """The content of params.yaml: the shared settings, the graph, and for each set the sections of its stages.

    overrides: Hydra's `group=option` and `section.key=value`, or `SET.section.key=value`. The graph names for each
    stage the sets that it runs on; for stages that begin with files, what tells DVC that these have changed. Raises
    ParamsError that names the nearest right name, and for a set whose files are not there.
    """
    _check_names(overrides)
    overrides = [quoted(override, sweeps=False) for override in overrides]
    general = [override for override in overrides if not _set_of(override)]
    common = composed(general)
    values = {key: common[key] for key in SHARED}
    values["graph"] = {stage: [] for stage in stage_names() if stage != "report"}
    check_section(schema_of("report"), values["report"])
    check_common(values)
    _check_run(values)
    for override in overrides:
        if (dataset := _set_of(override)) not in ("", *values["sets"]):
            set_list = ",".join([*values["sets"], dataset])
            raise ParamsError(f"{override}: {dataset} is not switched on: add 'sets=[{set_list}]'")
    for dataset in common["sets"]:
        special = [override.partition(".")[2] for override in overrides if _set_of(override) == dataset]
        config = composed([f"data={dataset}", *general, *special])
        values[dataset] = _sections(config, dataset)
        for override in (*general, *special):  # the names in conf/ exist
            section, _, key = override.lstrip("+~").partition("=")[0].partition(".")
            if key in values[dataset].get(section, {}):
                check_names(schema_of(section), {key: values[dataset][section][key]})
        if any(word in override for override in overrides for word in ("methods", "channels")):
            check_maps(values[dataset])
        for stage in config["stages"]:
            values["graph"][stage].append(dataset)
        if not config["obtain"] and config["meshes"]["folder"]:
            raise ParamsError(f"{dataset} reads no meshes.folder: with several sets write SET.meshes.folder=...")
    values["graph"] = {
        stage: {name: begins_with(values[name], stage, name) for name in sets} if stage in STARTS else sets
        for stage, sets in values["graph"].items()
    }
    values["out"] = values["out"] or (PUBLISHED if not overrides or _is_published(values) else own_folder(overrides))
    return values


def own_folder(overrides: Sequence[str]) -> str:
    """The folder of a run's results: runs/ and the names of its profile, experiment and sets, or `own` without any."""
    options = dict(override.split("=", 1) for override in overrides if "=" in override)
    words = [word for key in ("profile", "experiment", "sets") for word in re.findall(r"\w+", options.get(key, ""))]
    return f"{RUNS}/{'-'.join(words) or 'own'}"


def _is_published(values: dict[str, Any]) -> bool:
    """Whether settings are those of the published configuration; how objects run in parallel does not matter."""
    common, free = composed([]), {"parallel": None, "out": None}
    if any(values[key] != common[key] for key in ("profile", "sets")):  # before each set is composed again
        return False
    return values | free == compose() | free


STARTS = (
    "meshes",
    "weights",
    "recorded",
    "simulated_to_real",
    "recorded_networks",
)  # they read files that no stage has made


def absent(values: dict[str, Any]) -> dict[str, str]:
    """{set: where its files should be} of the switched-on sets whose files are not there."""
    places = {name: path for stage in STARTS for name, path in values["graph"].get(stage, {}).items()}
    return {name: path for name, path in places.items() if not Path(path).expanduser().exists()}


def groups() -> dict[str, list[str]]:
    """{group: its options} of conf/, whose claims are no group."""
    folders = sorted(path for path in CONF.iterdir() if path.is_dir() and path.name != "claims")
    return {folder.name: sorted(path.stem for path in folder.glob("*.yaml")) for folder in folders}


def composed(overrides: Sequence[str]) -> dict[str, Any]:
    """One composition by Hydra, as plain dicts; ParamsError that names the nearest right name of an unknown setting."""
    _check_options(overrides)
    try:
        config = _config(tuple(overrides))
    except (HydraException, OmegaConfBaseException) as error:
        raise ParamsError(_explain(overrides, error)) from None
    return OmegaConf.to_container(config)  # type: ignore[return-value]  # the root of a config is a dict


@cache
def store_defaults() -> None:
    """Tells Hydra the defaults of all stages: conf/config.yaml begins with them."""
    defaults = {name: defaults_of(stage.Params) for name, stage in STAGES.items()}
    ConfigStore.instance().store("stages", defaults, package="_global_")


@cache  # Hydra takes a third of a second, and one call of `compose` asks for the published settings three times
def _config(overrides: tuple[str, ...]) -> DictConfig:
    store_defaults()
    with hydra.initialize_config_dir(str(CONF), version_base=None):
        config = hydra.compose("config", list(overrides))
    OmegaConf.resolve(config)
    return config


def _sections(config: dict[str, Any], dataset: str) -> dict[str, Any]:
    """The sections that the stages of one set read, each checked against its schema."""
    stages = config["stages"]
    known = [name for name in stage_names() if name != "report"]  # the report is about all sets
    if not stages or not set(stages) <= set(known):
        raise ParamsError(f"{dataset}: stages={stages} must name stages: {', '.join(known)}")
    if config["obtain"] and not any(config.get(stage, {}).get("folder") for stage in (*STARTS, "recorded")):
        raise ParamsError(f"{dataset} needs its files: {config['obtain']}")
    names = dict.fromkeys(section for stage in stages for section in [stage, *READ_TOO.get(stage, [])])
    sections = {section: config.get(section, {}) for section in names}
    for section, values in sections.items():
        check_section(schema_of(section), values)
    return sections


def _check_names(overrides: Sequence[str]) -> None:
    """Raises ParamsError for an override without a name, and for one that adds to no section."""
    for override in overrides:
        name = override.partition("=")[0].lstrip("+~")
        if not name:
            raise ParamsError(f"{override!r} has no name: write group=option or section.key=value")
        if override.startswith("+") and not _set_of(name) and name.partition(".")[0] not in composed([]):
            raise ParamsError(f"unknown setting {override}: {nearest(name, list(composed([])))}")


def _check_run(values: dict[str, Any]) -> None:
    """Raises ParamsError for sets, workers or a folder of results that no run can have."""
    sets, workers = values["sets"], values["parallel"].get("workers", -1)
    backend = values["parallel"].get("backend", BACKENDS[0])
    if not sets:
        raise ParamsError(f"sets=[] names no set: write sets=[household], or others of {', '.join(groups()['data'])}")
    if twice := [name for name in dict.fromkeys(sets) if sets.count(name) > 1]:
        raise ParamsError(f"sets=[{','.join(sets)}] names {', '.join(twice)} twice")
    if unknown := [str(name) for name in sets if name not in groups()["data"]]:
        raise ParamsError(f"sets: unknown set {unknown[0]}: {nearest(unknown[0], groups()['data'])}")
    if not (isinstance(workers, int) and (workers == -1 or workers >= 1)):
        raise ParamsError(f"parallel.workers={workers} must be 1 or more, or -1 for one a core")
    out = Path(os.path.normpath(values["out"]))
    if values["out"] and (out.is_file() or not out.name or out.parts[0] in TREE):
        raise ParamsError(f"out={out} is no folder for results: write out=runs/NAME")
    if backend not in BACKENDS:
        raise ParamsError(f"parallel.backend={backend} is none of {', '.join(BACKENDS)}")


def check_maps(sections: dict[str, Any]) -> None:
    """Raises ParamsError for a method of the salient points whose channels the stage conspicuity does not compute."""
    from haptic_glance.look.points.methods import method_named

    if "channels" not in sections.get("conspicuity", {}):
        return
    computed = sections["conspicuity"]["channels"]
    for name in sections.get("salient_points", {}).get("methods", []):
        if missing := [channel for channel in method_named(name).channels if channel not in computed]:
            raise ParamsError(
                f"{name} needs the channels {', '.join(missing)}: add them to conspicuity.channels, or leave it out of "
                "salient_points.methods"
            )


def _set_of(override: str) -> str:
    """The set that an override is for, empty where it is for all."""
    first = override.partition("=")[0].partition(".")[0]
    return first if first in groups()["data"] and "." in override.partition("=")[0] else ""


def quoted(override: str, sweeps: bool = True) -> str:
    """The override, its value in quotes where Hydra's grammar would stumble over it: paths, blanks, accents.

    In a list, each part that needs quotes gets its own. sweeps: whether `a,b` is several values, or one as in `0,1,1`.
    """
    if _is_parsed(override, sweeps):
        return override
    key, _, value = override.partition("=")
    if value.startswith("[") and value.endswith("]"):
        parts = (part.strip() for part in value[1:-1].split(","))
        return f"{key}=[{','.join(part if _is_parsed(f'name={part}') else _in_quotes(part) for part in parts)}]"
    return f"{key}={_in_quotes(value)}"


def _is_parsed(override: str, sweeps: bool = True) -> bool:
    try:
        parsed = OverridesParser.create().parse_override(override)
    except HydraException:
        return False
    return sweeps or not parsed.is_sweep_override()


def _in_quotes(value: str) -> str:
    escaped = value.replace('"', '\\"')
    return f'"{escaped}"'


def _check_options(overrides: Sequence[str]) -> None:
    """Raises ParamsError for an option that a group does not have; Hydra passes over an optional group's in silence.

    Also for an option or a setting that went.
    """
    options = groups()
    for override in overrides:
        name, _, value = override.partition("=")
        if hint := went_of(override) or went_of(name):
            raise ParamsError(hint)
        if name in options and value not in (*options[name], "null"):
            if "," in value:
                raise ParamsError(f"{override}: one option at a time; `python -m stages.sweep -m` takes a list")
            raise ParamsError(f"unknown option {override}: {nearest(value, options[name])}")


def _explain(overrides: Sequence[str], error: Exception) -> str:
    """The first override that names nothing known, and the nearest name; else what Hydra said."""
    config = composed([]) if overrides else {}
    keys = [*groups(), *_dotted(config)]
    for override in overrides:
        name = override.partition("=")[0]
        if name[0] not in "+~" and name not in keys:
            parent = name.rpartition(".")[0]
            if parent in OPEN:
                return f"{parent} has no {name.rpartition('.')[2]} yet: to add it, write +{override}"
            first, dot, rest = name.partition(".")
            match = difflib.get_close_matches(first, groups()["data"], n=1, cutoff=0.8) if rest in keys else []
            hint = f"did you mean {match[0]}.{rest}?" if match else nearest(name, keys if dot else [*groups(), *config])
            return f"unknown setting {name}: {hint}"
    if foreign := [name for name in (override.partition("=")[0] for override in overrides) if not name.isascii()]:
        return f"{foreign[0]}: the command line takes names of plain letters; values may have any"
    message = str(error).splitlines()[0]
    section = next((name for name in OPEN if f"'{name}'" in message), None)  # with a name that it does not have
    return message + (f" To add a name, write +{section}.NAME=..." if section else "")


def _dotted(values: dict[str, Any], prefix: str = "") -> list[str]:
    names = []
    for key, value in values.items():
        names.append(f"{prefix}{key}")
        if isinstance(value, dict):
            names += _dotted(value, f"{prefix}{key}.")
    return names


def main() -> None:
    """Composes and writes params.yaml; sets whose files are not there are named and left out."""
    parser = argparse.ArgumentParser(
        prog="python -m stages.compose", description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("overrides", nargs="*", help="group=option or section.key=value")
    errors_in_one_line("compose")
    overrides = parser.parse_args().overrides
    check_clone()
    values = compose(overrides)
    missing = absent(values)
    if len(missing) == len(values["sets"]) and not any(path.startswith("conf/") for path in missing.values()):
        raise ParamsError("; ".join(f"{name}: {path} is not there: {_obtain(name)}" for name, path in missing.items()))
    for dataset, path in missing.items():
        print(f"compose: {dataset} is left out, {path} is not there: {_obtain(dataset)}", file=sys.stderr)
        leave_out(values, dataset)
    places = {place for stage in STARTS for place in values["graph"].get(stage, {}).values()}
    for path in sorted(path for place in places for path in Path(place).expanduser().rglob("*")):
        if path.is_symlink() and not path.exists():
            raise ParamsError(f"{path} is a link to a file that is not there, which DVC cannot read: remove the link")
    write_text(FILE, OmegaConf.to_yaml(OmegaConf.create(values)))
    suffix = f" with {' '.join(overrides)}" if overrides else ""
    print(f"compose: {FILE} written{suffix}; results go to {values['out']}/")


def _obtain(dataset: str) -> str:
    return composed([f"data={dataset}"])["obtain"]


def leave_out(values: dict[str, Any], dataset: str) -> None:
    """Takes a set out of the graph; its rows of earlier runs stay where they are."""
    for sets in values["graph"].values():
        sets.pop(dataset) if isinstance(sets, dict) and dataset in sets else None
        sets.remove(dataset) if isinstance(sets, list) and dataset in sets else None
    values["sets"].remove(dataset)
    del values[dataset]


if __name__ == "__main__":
    main()

"""params.yaml, checked against the typed schema of each section."""

import difflib
import importlib
from functools import cache
from pathlib import Path

from omegaconf import OmegaConf
from omegaconf.errors import OmegaConfBaseException
from yaml import YAMLError

FILE = Path("params.yaml")
SECTIONS = (
    "meshes", "views", "conspicuity", "weights", "salient_points", "lod", "scene", "fixation", "imprints",
    "classification", "exploration", "touch_stability", "classes", "sensor_size", "contours", "sequences", "transfer",
    "stability", "report",
)  # fmt: skip
COMMON = {"profile": str, "seed": int, "parallel": dict}


class ParamsError(ValueError):
    """A setting that no schema knows, or of the wrong type; the message names the nearest right one."""


def load_params(path=FILE):
    """The whole params.yaml as plain dicts; {} where there is none."""
    path = Path(path)
    if not path.exists():
        return {}
    try:
        values = OmegaConf.to_container(OmegaConf.load(path))
    except (YAMLError, OmegaConfBaseException) as error:
        raise ParamsError(f"{path} is no YAML: {' '.join(str(error).split())}") from None
    if not isinstance(values, dict):
        raise ParamsError(f"{path} must hold sections, not a {type(values).__name__}")
    return values


def schema(section):
    """The typed schema of a section: the dataclass `Params` of stages/SECTION/schema.py."""
    return importlib.import_module(f"stages.{section}.schema").Params


@cache
def params(section, path=FILE):
    """The settings of one section of params.yaml, as an instance of its schema.

    Raises ParamsError for a key that the schema does not have, or a value of the wrong type.
    """
    if not Path(path).exists():
        raise ParamsError(f"no {path} here: run this in the repository root, or make it by `python -m stages.compose`")
    values = load_params(path)
    check_common(values)
    if section not in values:
        raise ParamsError(f"{path} has no section {section}: make it anew by `python -m stages.compose`")
    return check_section(section, values[section])


def check_section(section, values):
    """Checks a section's values against its schema and returns them as an instance of it."""
    if not isinstance(values, dict):
        raise ParamsError(f"{section}: {values!r} is no section of settings")
    typed = OmegaConf.structured(schema(section))
    _check_keys(section, values, OmegaConf.to_container(typed, throw_on_missing=False))
    try:
        return OmegaConf.to_object(OmegaConf.merge(typed, values))
    except OmegaConfBaseException as error:
        key = f"{section}.{error.full_key}" if error.full_key else section
        raise ParamsError(f"{key}: {str(error).splitlines()[0]}") from None


def check(values):
    """Checks a whole composed configuration; raises ParamsError at the first fault."""
    check_common(values)
    for section in SECTIONS:
        check_section(section, values.get(section, {}))


def check_common(values):
    """Checks the names of the sections and the settings that all stages share."""
    _check_keys("", values, dict.fromkeys((*COMMON, *SECTIONS)))
    for key, kind in COMMON.items():
        if key in values and not isinstance(values[key], kind):
            raise ParamsError(f"{key}: {values[key]!r} is no {kind.__name__}")
    if values.get("seed", 0) < 0:
        raise ParamsError(f"seed: {values['seed']} is negative")


def _check_keys(where, values, known):
    for key in values:
        if key not in known:
            name = f"{where}.{key}" if where else key
            near = difflib.get_close_matches(key, known, n=1, cutoff=0.5)
            hint = f"did you mean {where + '.' if where else ''}{near[0]}?" if near else f"known: {', '.join(known)}"
            raise ParamsError(f"unknown setting {name}: {hint}")

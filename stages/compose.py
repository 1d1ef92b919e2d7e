"""Composes conf/ into params.yaml: `python -m stages.compose [group=option] [section.key=value] ...`

Examples: `python -m stages.compose profile=smoke`, `python -m stages.compose data=folder meshes.folder=~/scans`.
The pipeline reads params.yaml alone; without arguments the defaults come back. `dvc exp run -S` composes likewise.
"""

import argparse
import difflib
import sys
from pathlib import Path

import hydra
from hydra.core.override_parser.overrides_parser import OverridesParser
from hydra.errors import HydraException
from omegaconf import OmegaConf
from omegaconf.errors import OmegaConfBaseException

from stages.kit.files import write_text
from stages.kit.params import FILE, ParamsError, check

OPEN = ("classification.sets",)  # sections whose keys a person may add to
CONF = Path(__file__).parents[1] / "conf"


def compose(overrides=()):
    """The composed configuration, checked against the schema of each section.

    overrides: Hydra's `group=option` and `section.key=value`. Raises ParamsError that names the nearest right name.
    """
    overrides = [_quoted(override) for override in overrides]
    _check_options(overrides)
    try:
        with hydra.initialize_config_dir(str(CONF), version_base=None):
            config = hydra.compose("config", overrides)
        OmegaConf.resolve(config)
    except (HydraException, OmegaConfBaseException) as error:
        raise ParamsError(_explain(overrides, error)) from None
    check(OmegaConf.to_container(config))
    return config


def groups():
    """{group: its options} of conf/."""
    folders = sorted(path for path in CONF.iterdir() if path.is_dir())
    return {folder.name: sorted(path.stem for path in folder.glob("*.yaml")) for folder in folders}


def _quoted(override):
    """The override, its value in quotes where Hydra's grammar would stumble over it: paths, blanks, accents."""
    try:
        OverridesParser.create().parse_override(override)
    except HydraException:
        key, _, value = override.partition("=")
        escaped = value.replace('"', '\\"')
        return f'{key}="{escaped}"'
    return override


def _check_options(overrides):
    """Raises ParamsError for an option that a group does not have; Hydra passes over an optional group's in silence."""
    known = groups()
    for override in overrides:
        name, _, value = override.partition("=")
        if name in known and value not in (*known[name], "null"):
            if "," in value:
                raise ParamsError(f"{override}: one option at a time; `python -m stages.sweep -m` takes a list")
            raise ParamsError(f"unknown option {override}: {_near(value, known[name])}")


def _explain(overrides, error):
    """The first override that names nothing known, and the nearest name; else what Hydra said."""
    keys = [*groups(), *_dotted(OmegaConf.to_container(compose()))] if overrides else []
    for override in overrides:
        name = override.partition("=")[0]
        if name[0] not in "+~" and name not in keys:
            parent = name.rpartition(".")[0]
            if parent in OPEN:
                return f"{parent} has no {name.rpartition('.')[2]} yet: to add it, write +{override}"
            return f"unknown setting {name}: {_near(name, keys)}"
    return str(error).splitlines()[0]


def _near(name, known):
    near = difflib.get_close_matches(name, known, n=1, cutoff=0.4)
    return f"did you mean {near[0]}?" if near else f"known: {', '.join(known)}"


def _dotted(values, prefix=""):
    names = []
    for key, value in values.items():
        names.append(f"{prefix}{key}")
        if isinstance(value, dict):
            names += _dotted(value, f"{prefix}{key}.")
    return names


def main():
    """Composes and writes params.yaml."""
    parser = argparse.ArgumentParser(
        prog="python -m stages.compose", description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("overrides", nargs="*", help="group=option or section.key=value")
    overrides = parser.parse_args().overrides
    try:
        text = OmegaConf.to_yaml(compose(overrides))
    except ParamsError as error:
        sys.exit(f"compose: {error}")
    write_text(FILE, text)
    print(f"compose: {FILE} written" + (f" with {' '.join(overrides)}" if overrides else ""))


if __name__ == "__main__":
    main()

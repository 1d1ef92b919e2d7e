"""Composes conf/ into params.yaml: `python -m stages.compose [group=option] [section.key=value] ...`

Examples: `python -m stages.compose profile=smoke`, `python -m stages.compose data=folder meshes.folder=~/scans`.
The pipeline reads params.yaml alone; without arguments the defaults come back. `dvc exp run -S` composes likewise.
"""

import argparse
import difflib
import sys
from pathlib import Path

import hydra
from hydra.errors import HydraException
from omegaconf import OmegaConf
from omegaconf.errors import OmegaConfBaseException

from stages.kit.files import write_text
from stages.kit.params import FILE, ParamsError, check

CONF = Path(__file__).parents[1] / "conf"


def compose(overrides=()):
    """The composed configuration, checked against the schema of each section.

    overrides: Hydra's `group=option` and `section.key=value`. Raises ParamsError that names the nearest right name.
    """
    overrides = list(overrides)
    try:
        with hydra.initialize_config_dir(str(CONF), version_base=None):
            config = hydra.compose("config", overrides)
        OmegaConf.resolve(config)
    except (HydraException, OmegaConfBaseException) as error:
        raise ParamsError(_explain(overrides, error)) from None
    check(OmegaConf.to_container(config))
    return config


def _explain(overrides, error):
    """The first override that names nothing known, and the nearest name; else what Hydra said."""
    known = {"": sorted(path.name for path in CONF.iterdir() if path.is_dir())}
    known |= {group: sorted(path.stem for path in (CONF / group).glob("*.yaml")) for group in known[""]}
    keys = _dotted(OmegaConf.to_container(OmegaConf.load(CONF / "config.yaml")))
    for override in overrides:
        name, _, value = override.lstrip("+~").partition("=")
        if name in known[""]:
            options = known[name]
            if value not in options:
                return f"unknown option {override}: {_near(value, options)}"
        elif name not in keys:
            return f"unknown setting {name}: {_near(name, [*known[''], *keys])}"
    return str(error).splitlines()[0]


def _near(name, known):
    near = difflib.get_close_matches(name, known, n=1, cutoff=0.4)
    return f"did you mean {near[0]}?" if near else f"known: {', '.join(known)}"


def _dotted(values, prefix=""):
    names = []
    for key, value in values.items():
        if key == "defaults":
            continue
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

"""Where a run works: the repository root, its settings, and the data set that a stage runs on."""

import argparse
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import Any, TypeVar

from haptic_glance.base.errors import errors_in_one_line

from .params import FILE, ParamsError, check_common, check_section, load_params, section_of

Settings = TypeVar("Settings")
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
        """What may be deleted at any time: digests of code, the cache of objects, unfinished runs."""
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
        """The settings of one stage as an instance of its schema: `workspace.settings(stages.lod.schema.Params)`.

        Raises ParamsError for a section that is absent, a key that the schema does not have, or a wrong type.
        """
        section = section_of(schema)
        if self.dataset and self.dataset not in self.sets:
            raise ParamsError(f"{self.dataset} is not switched on; {FILE} names {', '.join(self.sets)}")
        values = self.params.get(self.dataset, {}) if self.dataset else self.params
        if section not in values:
            where = f"{self.dataset}.{section}" if self.dataset else section
            raise ParamsError(f"{self.root / FILE} has no section {where}: run `python -m stages.compose` anew")
        return check_section(schema, values[section])


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
    parser.add_argument("dataset", nargs="?", default="", help="a data set that params.yaml names")
    parser.add_argument("--root", type=Path, default=Path("."), help="the folder of params.yaml (default: this one)")
    given = parser.parse_args()
    errors_in_one_line(stage)
    workspace = Workspace(given.root)
    if stage not in workspace.params["graph"]:
        return workspace  # a stage about all sets
    return workspace.on(given.dataset or _only_set(workspace, stage))


def _only_set(workspace: Workspace, stage: str) -> str:
    known = list(workspace.params["graph"][stage])
    if len(known) != 1:
        choice = f"one of {', '.join(known)}" if known else "none is switched on: see `python -m stages.compose --help`"
        raise ValueError(f"name the data set: {choice}")
    return known[0]

"""Rows of measurements by stage and data set, as pandas frames; what is missing is NotRun, never a crash."""

from collections.abc import Callable, Hashable, Iterable, Mapping, Sequence, Sized
from functools import cached_property
from pathlib import Path
from typing import Any, TypeVar

import pandas as pd

from haptic_glance.base.files import files_below, object_files, read_arrays, read_mesh, read_table
from haptic_glance.base.timing import WALL
from haptic_glance.mesh.mesh import Mesh
from stages.engine.measurements import Measurements, Missing
from stages.engine.rows import SUFFIX
from stages.engine.settings import Workspace, conf_folder, load_params

from .commands import command

Found = TypeVar("Found", bound=Sized)
BENCH = "bench"
OWN_FOLDER = "own"  # in place of a stage: of what only a folder of one's own has, or what it never has
NUMBERS = {"four": 4, "six": 6}  # names of groups that tell how many objects they hold


class NotRun(Missing):
    """A measurement that is absent; the message says what is missing and, where a run would help, the command."""

    def __init__(self, message: str, stage: str, runnable: bool = True, dataset: str = "") -> None:
        run = command(conf_folder(), stage, [dataset]) if dataset else f"dvc repro {stage}"
        super().__init__(f"{message}: run `{run}`" if runnable else message)
        self.stage, self.runnable = stage, runnable


class NoData(NotRun):
    """The folder data/SET/STAGE is absent, as in a fresh clone."""


def require_rows(found: Found, message: str, stage: str, runnable: bool = True) -> Found:
    """Returns what was found; raises NotRun of `message` where it is empty."""
    if not len(found):
        raise NotRun(message, stage, runnable)
    return found


def require_file(path: Path, message: str, stage: str, runnable: bool = True, dataset: str = "") -> Path:
    """The path of a file; NotRun of `message` where it is not there."""
    if not path.exists():
        raise NotRun(message, stage, runnable, dataset)
    return path


class ByMethod(dict):
    """The results of a stage by method; NotRun for a method without results."""

    def __init__(self, stage: str, results: Mapping[str, Any]) -> None:
        super().__init__(results)
        self.stage = stage

    def __missing__(self, method: str) -> Any:
        raise NotRun(f"{method} is not among the methods of {self.stage}", self.stage, runnable=False)

    def those_of(self, methods: Iterable[str]) -> list[str]:
        """The methods that were run, in the order given; NotRun where there is none."""
        names = [method for method in methods if method in self]
        return names or [self[method] for method in methods]


def clock_of(rows: pd.DataFrame) -> str:
    """The clock of the seconds of some rows: processor time of a named machine, or wall time of older rows.

    If rows have both clocks, the clock is wall time, the less precise one.
    """
    timed = rows[rows["seconds"].notna()] if "seconds" in rows else rows
    clocks = timed.get("clock", pd.Series(dtype=str)).dropna()
    return clocks.iloc[0] if len(clocks) and len(clocks) == len(timed) else WALL


class Results:
    """The rows that the stages measured, and the files that they left in data/.

    Rows of every set that was ever measured are read by the same methods; those that are switched on come first.
    settings: the report's section of params.yaml.
    """

    def __init__(self, workspace: Workspace, settings: Any) -> None:
        self.workspace, self.settings = workspace, settings
        self.data, self.reports = workspace.root / "data", workspace.reports
        self.out = workspace.build / "partial/report"  # where the report is made before it takes its place
        self.sets = workspace.sets  # the names of the data sets that are switched on, in order
        self.read: set[str] = set()  # the data sets that the present item was read from

    @cached_property
    def measurements(self) -> Measurements:
        """The rows below `reports`."""
        return Measurements(self.reports)

    @classmethod
    def published(cls, workspace: Workspace, settings: Any) -> "Results":
        """The published results of a root, whatever its params.yaml switches on."""
        results = cls(workspace, settings)
        results.reports, results.sets = workspace.published, load_params(conf_folder() / "config.yaml")["sets"]
        return results

    def rows(self, stage: str, dataset: str | None = None, **where: object) -> pd.DataFrame:
        """Rows of a stage on one set, filtered: `metric="accuracy"`, a list of accepted values, or None for no value.

        dataset: None for the first of `datasets(stage)`. Raises NotRun when the rows are absent, lack the column, or
        none is left; with the stage's own note on why it left them out, where there is one.
        """
        return self._rows(self.measurements.rows, stage, dataset, where)

    def measured(self, stage: str, dataset: str | None = None, **where: object) -> pd.DataFrame:
        """As `rows`, only those that have a value; NotRun where there is none."""
        return self._rows(self.measurements.measured, stage, dataset, where)

    def _rows(
        self, read: Callable[..., pd.DataFrame], stage: str, dataset: str | None, where: Mapping[str, object]
    ) -> pd.DataFrame:
        dataset = self._first(stage, dataset)
        self.read.add(dataset)
        if self.own_meshes and dataset not in self.sets:
            raise NotRun(f"{dataset} is not switched on", f"{stage}@{dataset}", runnable=False)
        try:
            return read(stage, dataset, **where)
        except Missing as missing:
            absent = not self.measurements.path(stage, dataset).exists()
            raise NotRun(str(missing), stage, absent and dataset in self.sets, dataset) from None

    def clock(self, stage: str, dataset: str | None = None) -> str:
        """The `clock_of` a stage's rows."""
        return clock_of(self.rows(stage, dataset))

    def notes(self, stage: str, dataset: str | None = None, **where: object) -> list[str]:
        """Why rows of a stage have no value, each reason one time; an empty cell of a row stands for any value."""
        return self.measurements.notes(stage, self._first(stage, dataset), where)

    def left_out(self, stage: str, dataset: str | None = None, **where: object) -> str:
        """`notes` as sentences for a table's prose, a line each."""
        return "\n".join(f"Not run: {note}." for note in self.notes(stage, dataset, **where))

    def _first(self, stage: str, dataset: str | None) -> str:
        return dataset or require_rows(self.datasets(stage), f"no measurements of {stage}", stage)[0]

    def cached(self, key: Hashable, work: Callable[[], Any]) -> Any:
        """The result of some work on the rows, computed at the first call."""
        return self.measurements.cached(key, work)

    def bench(self, name: str) -> pd.DataFrame:
        """Rows of reports/bench/NAME.csv (or .csv.gz): what `make bench` measured; times are ratios to a named peer."""
        if self.own_meshes:
            raise NotRun("benchmarks are not about a folder of one's own", BENCH, runnable=False)
        path = self.workspace.published / "bench" / f"{name}.csv"
        path = path if path.exists() else path.with_name(f"{path.name}.gz")
        require_file(path, f"no bench/{name}.csv: `make bench` writes it", BENCH, runnable=False)
        return self.cached(path, lambda: read_table(path))

    def thesis(self, name: str) -> pd.DataFrame:
        """One of the thesis's own tables, data/reference/thesis/NAME.csv."""
        return read_table(self.data / "reference/thesis" / f"{name}.csv")

    def datasets(self, stage: str) -> list[str]:
        """The sets that have rows of a stage, `in_order`."""
        return self.in_order(self._measured.get(stage, set()))

    @property
    def stages(self) -> list[str]:
        """Names of the stages that have rows of any set, in alphabetical order."""
        return sorted(self._measured)

    @cached_property
    def _measured(self) -> dict[str, set[str]]:
        """{stage: the sets that have rows of it}."""
        sets_by_stage: dict[str, set[str]] = {}
        for path in (self.reports / "measurements").glob(f"*/*{SUFFIX}"):
            sets_by_stage.setdefault(path.name.partition(".")[0], set()).add(path.parent.name)
        return sets_by_stage

    def printed(self, dataset: str, stage: str) -> str | None:
        """The set that follows a protocol as printed, where it has rows of a stage; else None, the first that has."""
        return dataset if dataset in self.datasets(stage) and not self.own_meshes else None

    def in_order(self, names: set[str]) -> list[str]:
        """Names of data sets: those that are switched on, then the others by the alphabet, but for one's own meshes."""
        other_sets = set() if self.own_meshes else names - set(self.sets)
        return [name for name in self.sets if name in names] + sorted(other_sets)

    @property
    def own_meshes(self) -> bool:
        """Whether the first set that is switched on is a folder of a person's own meshes."""
        meshes = self.workspace.params.get(self.sets[0], {}).get("meshes", {}) if self.sets else {}
        return meshes.get("source") == "folder"

    def concerns(self, missing: NotRun) -> bool:
        """Whether what is missing is of this run: with a folder of one's own, of a stage that ran on the sets that are
        switched on."""
        return bool(self.datasets(missing.stage)) if self.own_meshes else missing.stage != OWN_FOLDER

    def folder(self, stage: str, dataset: str | None = None) -> Path:
        """data/SET/STAGE; NotRun when it is not there. dataset: None for the first set that has it."""
        datasets = self.in_order({path.parent.name for path in self.data.glob(f"*/{stage}") if path.is_dir()})
        if dataset not in datasets and (dataset or not datasets):
            raise NoData(f"no data/{dataset or 'SET'}/{stage}", stage)
        self.read.add(dataset or datasets[0])
        return self.data / (dataset or datasets[0]) / stage

    def file(self, stage: str, name: str, dataset: str | None = None) -> Path:
        """data/SET/STAGE/NAME, a file that a stage left; NotRun where it is not there."""
        path = self.folder(stage, dataset) / name
        return require_file(path, f"no {name} in data/{path.parent.parent.name}/{stage}", stage)

    def by_method(
        self, stage: str, read: Callable[[Path], Mapping[str, Any]], name: str, dataset: str | None = None
    ) -> ByMethod:
        """Reads the results by method from the file that a stage wrote for one object."""
        return ByMethod(stage, read(self.file(stage, f"{name}.npz", dataset)))

    def table(self, stage: str, name: str, dataset: str | None = None) -> pd.DataFrame:
        """A side table of a stage, data/SET/STAGE/NAME."""
        return read_table(self.file(stage, name, dataset))

    @cached_property
    def objects(self) -> list[str]:
        """Names of all objects with a mesh in the first set that has meshes, in alphabetical order."""
        return require_rows(object_files(self.folder("meshes")), "no meshes", "meshes")

    def mesh(self, name: str, dataset: str | None = None) -> Mesh:
        """The original mesh of an object."""
        return read_mesh(self.file("meshes", f"{name}.npz", dataset))

    def choose(self, preferred: Sequence[str], count: int, stage: str = "salient_points") -> list[str]:
        """Up to `count` objects that `stage` has data for: the preferred ones first, then by the alphabet."""
        folder = self.folder(stage)
        names = [name for name in self.objects if (folder / f"{name}.npz").exists() or files_below(folder / name)]
        require_rows(names, f"no objects in {stage}", stage)
        return sorted(names, key=lambda name: [*preferred, name].index(name))[:count]

    def classes(self, group: str, dataset: str | None = None) -> int:
        """How many objects a group of the classification held; in a fresh clone, without data/, as its name says."""
        try:
            paths = sorted(self.folder("classification", dataset).glob(f"{group}.*.npz"))
        except NotRun:
            if group in NUMBERS:
                return NUMBERS[group]
            raise
        first = require_rows(paths, f"no {group}.*.npz in data/classification", "classification")[0]
        return len(read_arrays(first)["objects"])

    def group_text(self, group: str, dataset: str | None = None) -> str:
        """A group in words: "six objects", or "4 objects (group six)" where the name does not tell the number.

        Where neither data/ nor the name tells it: "group seven".
        """
        try:
            count = self.classes(group, dataset)
        except NotRun:
            return f"group {group}"
        return f"{group} objects" if count == NUMBERS.get(group) else f"{count} objects (group {group})"

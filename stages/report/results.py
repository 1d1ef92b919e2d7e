"""Measurements, set by set, beside the thesis's; a missing measurement is NotRun, never a crash."""

from collections.abc import Callable, Hashable, Iterable, Mapping, Sequence, Sized
from functools import cached_property
from pathlib import Path
from typing import Any, TypeVar

import numpy as np
import pandas as pd

from haptic_glance.base.files import files_below, object_files, read_arrays, read_mesh, read_table
from haptic_glance.base.timing import WALL
from haptic_glance.look.camera import Viewpoint
from haptic_glance.look.weights import read_learned_weights
from haptic_glance.mesh.mesh import Mesh
from stages.conspicuity.measure import read_maps
from stages.engine.rows import SUFFIX, read_rows
from stages.engine.settings import Workspace, conf_folder, load_params
from stages.imprints.imprints import read_imprints
from stages.salient_points.measure import read_points, read_saliency, read_strong_points

from . import Params

Findings = TypeVar("Findings", bound=Sized)
Answer = TypeVar("Answer")
# Sets with the settings of a section of the thesis.
SECTION_3_1, SECTION_3_2, SECTION_4_2 = "household_3_1", "gaze_3_2", "household_4_2"
SETS_3_1 = SECTION_3_1, "princeton_3_1"  # the protocol of T3.1 on objects of our own and on published ones
SETS_3_1_FOUR = tuple(f"{name}_four" for name in SETS_3_1)  # from the four principal viewpoints of T3.1.2
MENDED_3_2 = "gaze_3_2_mended"  # T3.2 with mended formulas
GREY_3_1 = "gaze_3_1"  # T3.1 on grey meshes with human gaze
SETS_4_2 = "household_4_2_sets", "princeton_4_2_sets", "catalogue_4_2_sets"  # random sets of six objects
SUMS_4_2 = "household_4_2_sums", "princeton_4_2_sums"
GAZED = "gaze", "gaze_clouds"  # sets with recorded human gaze; no object is in both
COLOURED = "furniture_coloured"  # the set whose objects have several hues
ON_GREY, ON_WHITE, ON_BLACK = "household_on_grey", "household_on_white", "gaze_on_black"  # other backgrounds
BENCH = "bench"
OWN_FOLDER = "own"  # in place of a stage: of what only a folder of one's own has, or what it never has
NUMBERS = {"four": 4, "six": 6}  # names of groups that tell how many objects they hold

DATASETS = {
    SECTION_3_1: "household as in T3.1", SETS_3_1[1]: "psb as in T3.1",
    SETS_3_1_FOUR[0]: "household as in T3.1, four viewpoints", SETS_3_1_FOUR[1]: "psb as in T3.1, four viewpoints",
    GREY_3_1: "meshes with human gaze as in T3.1",
    SECTION_3_2: "meshes with human gaze as in T3.2", MENDED_3_2: "meshes with human gaze as in T3.2, formulas mended",
    SECTION_4_2: "household as in T4.2", SETS_4_2[0]: "random sets of household shapes as in T4.2",
    SETS_4_2[1]: "random sets of psb as in T4.2", SETS_4_2[2]: "random sets of furniture as in T4.2",
    SUMS_4_2[0]: "random sets of household shapes as in T4.2, sums of maps",
    SUMS_4_2[1]: "random sets of psb as in T4.2, sums of maps", COLOURED: "furniture in colour",
    ON_BLACK: "the same with the black background filtered", ON_GREY: "on grey", ON_WHITE: "on white",
    "gaze": "meshes with human gaze", "gaze_clouds": "point clouds with human gaze", "princeton": "psb",
    "princeton_touched": "psb, 8 classes of 6 objects", "princeton_hands": "psb, several arrays or touches",
    "princeton_4_3_sets": "random sets of psb as in T4.3",
    "princeton_eight": "psb, the thesis's 8 classes", "princeton_six": "psb, the thesis's 6 classes",
    "furniture_splits": "furniture, 20 splits",
    "pressure_images": "recorded pressure array", "biotac_grasps": "recorded fingertips",
    "touch_events": "recorded events of a fingertip",
    "household_denoised": "household, denoised", "princeton_denoised": "psb, denoised",
    "furniture_denoised": "furniture, denoised", "furniture_hands": "furniture, several arrays or touches",
    "princeton_other_hands": "psb's other 11 classes, several arrays or touches",
    "schunk": "recorded hand with arrays",
}  # fmt: skip


def dataset_text(name: str) -> str:
    """A data set in words."""
    return DATASETS.get(name, name)


class NotRun(Exception):
    """A measurement that is absent; the message says what is missing and, where a run would help, of which stage."""

    def __init__(self, message: str, stage: str, runnable: bool = True) -> None:
        super().__init__(f"{message}: run `dvc repro {stage}`" if runnable else message)
        self.stage, self.runnable = stage, runnable


class NoData(NotRun):
    """The folder data/SET/STAGE is absent, as in a fresh clone."""


def some(findings: Findings, message: str, stage: str, runnable: bool = True) -> Findings:
    """Returns the findings; raises NotRun of `message` where there are none."""
    if not len(findings):
        raise NotRun(message, stage, runnable)
    return findings


def there(path: Path, message: str, stage: str, runnable: bool = True) -> Path:
    """The path of a file; NotRun of `message` where it is not there."""
    if not path.exists():
        raise NotRun(message, stage, runnable)
    return path


class ByMethod(dict):
    """The results of a stage by method; NotRun for a method without results."""

    def __init__(self, stage: str, findings: dict[str, np.ndarray]) -> None:
        super().__init__(findings)
        self.stage = stage

    def __missing__(self, method: str) -> np.ndarray:
        raise NotRun(f"{method} is not among the methods of {self.stage}", self.stage, runnable=False)

    def those_of(self, methods: Iterable[str]) -> list[str]:
        """The methods that were run, in the order given; NotRun where there is none."""
        names = [method for method in methods if method in self]
        return names or [self[method] for method in methods]


RECENT = 128  # answers that are kept: the two sides of a claim are asked for again and again


def clock_of(rows: pd.DataFrame) -> str:
    """The clock of the seconds of a stage's rows: processor time of a named machine, or wall time of older rows.

    If rows have both clocks, the clock is wall time, the less precise one.
    """
    timed = rows[rows["seconds"].notna()] if "seconds" in rows else rows
    clocks = timed.get("clock", pd.Series(dtype=str)).dropna()
    if len(clocks) and len(clocks) == len(timed):
        return clocks.iloc[0]
    return WALL


class Results:
    """Everything that the report reads: rows of measurements, and what the stages left in data/.

    Rows of every set that was ever measured are read by the same methods; those that are switched on come first.
    settings: the report's section of params.yaml.
    """

    def __init__(self, workspace: Workspace, settings: Params) -> None:
        self.workspace, self.settings = workspace, settings
        self.data, self.reports = workspace.root / "data", workspace.reports
        self.out = workspace.build / "partial/report"  # where the report is made before it takes its place
        self.sets = workspace.sets  # the names of the data sets that are switched on, in order
        self.read: set[str] = set()  # the data sets that were read since `forget`
        self.sources: dict[str, list[pd.DataFrame]] = {}  # SET/STAGE or bench/NAME -> rows that were read since then
        self._known: dict[Hashable, Any] = {}
        self._recent: dict[Hashable, Any] = {}  # the answers to the last queries, oldest first

    def unread(self) -> "Results":
        """The same results, of which nothing was read yet."""
        results = Results(self.workspace, self.settings)
        results.reports, results.sets, results.out = self.reports, self.sets, self.out
        return results

    def forget(self) -> None:
        """Begins anew to note what is read."""
        self.read.clear()
        self.sources.clear()
        self._recent.clear()  # or an answer to an older query would not be noted

    @classmethod
    def published(cls, workspace: Workspace, settings: Params) -> "Results":
        """The published results of a root, whatever its params.yaml switches on."""
        results = cls(workspace, settings)
        results.reports, results.sets = workspace.published, load_params(conf_folder() / "config.yaml")["sets"]
        return results

    def datasets(self, stage: str) -> list[str]:
        """The sets that have rows of a stage, `in_order`."""
        return self.in_order(self._measured.get(stage, set()))

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

    @property
    def stages(self) -> list[str]:
        """Names of the stages that have rows of any set, in alphabetical order."""
        return sorted(self._measured)

    def rows(self, stage: str, dataset: str | None = None, **where: object) -> pd.DataFrame:
        """Rows of a stage on one set, filtered: `metric="accuracy"`, a list of accepted values, or None for no value.

        dataset: None for the first of `datasets(stage)`. Raises NotRun when the rows are absent, lack the column, or
        none is left; with the stage's own note on why it left them out, where there is one.
        """
        dataset = self._first(stage, dataset)
        query = stage, dataset, *((column, value is None, *listed(value)) for column, value in where.items())
        frame = self.recently(query, lambda: self._filtered(stage, dataset, where)).copy(deep=False)
        self.read.add(dataset)
        self.sources.setdefault(f"{dataset}/{stage}", []).append(frame)
        return frame

    def _filtered(self, stage: str, dataset: str, where: Mapping[str, object]) -> pd.DataFrame:
        """The rows of `rows`; each column's values are compared one time, not its cells."""
        frame = self._read(stage, dataset)
        positions: np.ndarray | None = None
        for column, value in where.items():
            if column in frame:
                if positions is None:
                    positions = self._positions(stage, dataset, column, value)
                else:
                    positions = positions[self._accepted(stage, dataset, column, value, positions)]
                if len(positions):
                    continue
            notes = self.notes(stage, dataset, **where)
            if notes:
                raise NotRun("; ".join(notes[:2]), stage, runnable=False)
            if column not in frame:
                raise NotRun(f"no column {column} in the rows of {stage}", stage)
            raise NotRun(f"{column} {either(value)} is not among those that {stage} measured", stage, runnable=False)
        return frame if positions is None else frame.iloc[positions]

    def measured(self, stage: str, dataset: str | None = None, **where: object) -> pd.DataFrame:
        """As `rows`, only those that have a value; NotRun where there is none."""
        frame = self.rows(stage, dataset, **where)
        valued = frame["value"].notna()
        frame = frame if valued.all() else frame[valued]
        if frame.empty:
            notes = self.notes(stage, dataset, **where) or [f"{stage} has rows of this, but no value"]
            raise NotRun("; ".join(notes[:2]), stage, runnable=False)
        return frame

    def clock(self, stage: str, dataset: str | None = None) -> str:
        """The `clock_of` a stage's rows."""
        return clock_of(self._read(stage, dataset))

    def notes(self, stage: str, dataset: str | None = None, **where: object) -> list[str]:
        """Why rows of a stage have no value, each reason one time; an empty cell of a row stands for any value."""
        dataset = self._first(stage, dataset)
        frame = self._read(stage, dataset)
        if "note" not in frame or "value" not in frame:
            return []
        has_note = (frame["value"].isna() & frame["note"].notna()).to_numpy()
        for column, value in where.items():
            if column in frame:
                empty = self._accepted(stage, dataset, column, None)
                has_note = has_note & (self._accepted(stage, dataset, column, value) | empty)
        return list(dict.fromkeys(frame.loc[has_note, "note"]))

    def left_out(self, stage: str, dataset: str | None = None, **where: object) -> str:
        """`notes` as sentences for a table's prose, a line each."""
        return "\n".join(f"Not run: {note}." for note in self.notes(stage, dataset, **where))

    def _positions(self, stage: str, dataset: str, column: str, value: object) -> np.ndarray:
        """(k,) the positions of the rows that `_accepted` accepts; the rows of a column are compared one time."""
        query = "positions", stage, dataset, column, value is None, *listed(value)
        return self.once(query, lambda: np.flatnonzero(self._accepted(stage, dataset, column, value)))

    def _accepted(
        self, stage: str, dataset: str, column: str, value: object, among: np.ndarray | slice = slice(None)
    ) -> np.ndarray:
        """(n,) bool: which rows of a stage on one set have a wanted value in a column; compares each value one time.

        among: positions of the rows, all by default.
        """
        codes, values = self.once(
            ("values", stage, dataset, column), lambda: pd.factorize(self._read(stage, dataset)[column])
        )

        def accepted() -> np.ndarray:
            wanted = np.zeros(len(values), dtype=bool) if value is None else values.isin(listed(value))
            return np.append(wanted, value is None)  # the code of an empty cell is -1

        return self.once(("accepted", stage, dataset, column, value is None, *listed(value)), accepted)[codes[among]]

    def _first(self, stage: str, dataset: str | None) -> str:
        return dataset or some(self.datasets(stage), f"no measurements of {stage}", stage)[0]

    def _read(self, stage: str, dataset: str | None) -> pd.DataFrame:
        dataset = self._first(stage, dataset)
        if self.own_meshes and dataset not in self.sets:
            raise NotRun(f"{dataset} is not switched on", f"{stage}@{dataset}", runnable=False)
        path = self.reports / "measurements" / dataset / f"{stage}{SUFFIX}"
        there(path, f"no measurements of {stage} on {dataset}", stage, dataset in self.sets)
        return self.once(path, lambda: read_rows(path))

    def once(self, name: Hashable, work: Callable[[], Any]) -> Any:
        """The result of some work on the rows, computed at the first call."""
        if name not in self._known:
            self._known[name] = work()
        return self._known[name]

    def recently(self, query: Hashable, work: Callable[[], Answer]) -> Answer:
        """The result of some work on the rows, computed anew once RECENT others were asked for."""
        if query not in self._recent:
            self._recent[query] = work()
            if len(self._recent) > RECENT:
                del self._recent[next(iter(self._recent))]
        return self._recent[query]

    def bench(self, name: str) -> pd.DataFrame:
        """Rows of reports/bench/NAME.csv (or .csv.gz): what `make bench` measured; times are ratios to a named peer."""
        if self.own_meshes:
            raise NotRun("benchmarks are not about a folder of one's own", "bench", runnable=False)
        message = f"no bench/{name}.csv: `make bench` writes it"
        path = there(self.bench_path(name), message, BENCH, runnable=False)
        rows = self.once(path, lambda: read_table(path))
        self.sources.setdefault(f"{BENCH}/{name}", []).append(rows)
        return rows

    def bench_path(self, name: str) -> Path:
        """reports/bench/NAME.csv, or .csv.gz where the table is compressed."""
        path = self.workspace.published / "bench" / f"{name}.csv"
        return path if path.exists() else path.with_name(f"{path.name}.gz")

    def thesis(self, name: str) -> pd.DataFrame:
        """One of the thesis's own tables, data/reference/thesis/NAME.csv."""
        return read_table(self.data / "reference/thesis" / f"{name}.csv")

    def classes(self, group: str, dataset: str | None = None) -> int:
        """How many objects a group of the classification held; in a fresh clone, without data/, as its name says."""
        try:
            paths = sorted(self.folder("classification", dataset).glob(f"{group}.*.npz"))
        except NotRun:
            if group in NUMBERS:
                return NUMBERS[group]
            raise
        first = some(paths, f"no {group}.*.npz in data/classification", "classification")[0]
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

    def folder(self, stage: str, dataset: str | None = None) -> Path:
        """data/SET/STAGE; NotRun when it is not there. dataset: None for the first set that has it."""
        datasets = self.in_order({path.parent.name for path in self.data.glob(f"*/{stage}") if path.is_dir()})
        if dataset not in datasets and (dataset or not datasets):
            raise NoData(f"no data/{dataset or 'SET'}/{stage}", stage)
        self.read.add(dataset or datasets[0])
        return self.data / (dataset or datasets[0]) / stage

    def table(self, stage: str, name: str, dataset: str | None = None) -> pd.DataFrame:
        """A side table of a stage, data/SET/STAGE/NAME."""
        return read_table(there(self.folder(stage, dataset) / name, f"no {stage}/{name}", stage))

    @property
    def own_meshes(self) -> bool:
        """Whether the first set that is switched on is a folder of a person's own meshes."""
        meshes = self.workspace.params.get(self.sets[0], {}).get("meshes", {}) if self.sets else {}
        return meshes.get("source") == "folder"

    def concerns(self, missing: NotRun) -> bool:
        """Whether what is missing is of this run: with a folder of one's own, of a stage that ran on the sets that are
        switched on."""
        return bool(self.datasets(missing.stage)) if self.own_meshes else missing.stage != OWN_FOLDER

    @cached_property
    def objects(self) -> list[str]:
        """Names of all objects with a mesh in the first set that has meshes, in alphabetical order."""
        return some(object_files(self.folder("meshes")), "no meshes", "meshes")

    def choose(self, preferred: Sequence[str], count: int, stage: str = "salient_points") -> list[str]:
        """Up to `count` objects that `stage` has data for: the preferred ones first, then by the alphabet."""
        folder = self.folder(stage)
        names = [name for name in self.objects if (folder / f"{name}.npz").exists() or files_below(folder / name)]
        some(names, f"no objects in {stage}", stage)
        return sorted(names, key=lambda name: [*preferred, name].index(name))[:count]

    def mesh(self, name: str, dataset: str | None = None) -> Mesh:
        """The original mesh of an object."""
        return read_mesh(self._path("meshes", name, dataset))

    def points(self, name: str, dataset: str | None = None) -> ByMethod:
        """dict method -> (k,) vertex ids, most salient first."""
        return ByMethod("salient_points", read_points(self._path("salient_points", name, dataset)))

    def strong_points(self, name: str) -> ByMethod:
        """dict method -> (k',) vertex ids, the leading points that the simplification keeps."""
        return ByMethod("salient_points", read_strong_points(self._path("salient_points", name, None)))

    def saliency(self, name: str, dataset: str | None = None) -> ByMethod:
        """dict method -> (n,) saliency in 0..1 per vertex."""
        return ByMethod("salient_points", read_saliency(self._path("salient_points", name, dataset)))

    def imprints(self, name: str, dataset: str | None = None) -> ByMethod:
        """dict method -> (k, rows, cols) imprints in 0..1."""
        by_method = read_imprints(self._path("imprints", name, dataset))
        return ByMethod("imprints", {method: touches.images for method, touches in by_method.items()})

    def maps(
        self, name: str, channels: Sequence[str] | None = None, dataset: str | None = None
    ) -> tuple[np.ndarray, np.ndarray, list[Viewpoint], list[str]]:
        """(maps (v, channels, h, w) f4, mask (v, h, w) boolean, viewpoints, channels) of an object.

        channels: the channels, in this order; NotRun where one was not computed. None: those that were.
        """
        maps, mask, viewpoints, map_channels = read_maps(self._path("conspicuity", name, dataset))
        if channels is None:
            return maps, mask, viewpoints, map_channels
        missing = [channel for channel in channels if channel not in map_channels]
        if missing:
            raise NotRun(f"no maps of {', '.join(missing)}", "conspicuity", runnable=False)
        return maps[:, [map_channels.index(channel) for channel in channels]], mask, viewpoints, list(channels)

    def ground_truth(self, name: str, dataset: str | None = None) -> dict[str, np.ndarray]:
        """Arrays of data/SET/weights/ground_truth/NAME.npz: density, points and more (stages.weights.training)."""
        path = self.folder("weights", dataset) / "ground_truth" / f"{name}.npz"
        message = f"no weights/ground_truth/{name}.npz: no ground truth of {name}, or not run"
        return read_arrays(there(path, message, "weights"))

    def learned(self, name: str, mesh: Mesh, dataset: str | None = None):
        """The weights that may be applied to this object: a haptic_glance.look.weights.LearnedWeights."""
        path = self.folder("weights", dataset) / "weights.csv"
        return read_learned_weights(there(path, "no weights/weights.csv", "weights").parent, name, mesh)

    def with_ground_truth(self, preferred: Sequence[str], count: int) -> list[str]:
        """Up to `count` objects that have ground truth and salient points: the preferred ones first."""
        truths = {path.stem for path in (self.folder("weights") / "ground_truth").glob("*.npz")}
        some(truths, "no object has ground truth", "weights")
        names = [name for name in self.choose(preferred, len(self.objects)) if name in truths]
        return some(names, "no object with ground truth has salient points", "salient_points")[:count]

    def lods(self, name: str, method: str) -> list[tuple[str, Mesh]]:
        """Simplified meshes of one method, most faces first: list of (target, Mesh)."""
        paths = [path for path in files_below(self.folder("lod") / name) if path.match(f"{method}_*.npz")]
        message = f"lod/{name} has no mesh by {method}: lod.methods lacks the method, or it reached no face count"
        some(paths, message, "lod", runnable=False)
        levels = [(path.stem.removeprefix(f"{method}_").replace("pct", "%"), read_mesh(path)) for path in paths]
        return sorted(levels, key=lambda item: (-len(item[1].faces), item[0]))

    def in_order(self, names: set[str]) -> list[str]:
        """Names of data sets: those that are switched on, then the others by the alphabet, but for one's own meshes."""
        other_sets = set() if self.own_meshes else names - set(self.sets)
        return [name for name in self.sets if name in names] + sorted(other_sets)

    def _path(self, stage: str, name: str, dataset: str | None) -> Path:
        path = self.folder(stage, dataset) / f"{name}.npz"
        return there(path, f"no {path.name} in data/{path.parent.parent.name}/{stage}", stage)


def listed(value: object) -> list:
    """One value or several, as a list."""
    return list(value) if isinstance(value, list | tuple | set | frozenset) else [value]


def either(value: object) -> str:
    """One value or several, in words: `knn or svm`."""
    return " or ".join(map(str, listed(value)))

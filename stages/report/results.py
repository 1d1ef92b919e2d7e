"""What a run has measured, beside what the thesis says; a missing measurement is NotRun, never a crash."""

import copy
from functools import cached_property
from pathlib import Path

import pandas as pd

from stages.conspicuity.storage import read_maps
from stages.imprints import read_imprints
from stages.kit.files import read_arrays, read_mesh, read_table
from stages.salient_points import read_points, read_saliency, read_strong_points
from stages.weights import learned_for

NUMBERS = {"four": 4, "six": 6}  # names of sets that tell how many objects they hold
# Stages whose rows are about sets of objects.
OF_SETS = ("classification", "exploration", "touch_stability")


class NotRun(Exception):
    """A measurement that is absent; the message says what is missing and, where a run would help, of which stage."""

    def __init__(self, what, stage, runnable=True):
        super().__init__(f"{what}: run `dvc repro {stage}`" if runnable else what)
        self.stage = stage


class ByMethod(dict):
    """What a stage found by each method; one that it did not run is NotRun."""

    def __init__(self, stage, found):
        super().__init__(found)
        self.stage = stage

    def __missing__(self, method):
        raise NotRun(f"{method} is not among the methods of {self.stage}", self.stage, runnable=False)

    def those_of(self, methods):
        """The methods that were run, in the order given; NotRun where there is none."""
        found = [method for method in methods if method in self]
        return found or [self[method] for method in methods]


class Results:
    """Everything the report reads, below one repository root. settings: the report's section of params.yaml."""

    def __init__(self, settings, root="."):
        self.settings = settings
        self.data = Path(root) / "data"
        self.reports = Path(root) / "reports"
        self._tables = {}

    def measurements(self, stage, **where):
        """Rows of reports/measurements/STAGE.csv, filtered: `metric="accuracy"` or a list of accepted values.

        Raises NotRun when the file is absent, lacks the column, or no row is left; with the stage's own note on why it
        left them out, where there is one.
        """
        frame, notes = self._read(stage), self.notes(stage, **where)
        for column, wanted in where.items():
            if column in frame:
                frame = frame[frame[column].isin(_listed(wanted))]
            elif not notes:
                raise NotRun(f"no column {column} in {stage}.csv", stage)
            if notes and (column not in frame or frame.empty):
                raise NotRun("; ".join(notes[:2]), stage, runnable=False)
            if frame.empty:
                kind = "set" if column == "object" and stage in OF_SETS else column
                what = f"{kind} {' or '.join(map(str, _listed(wanted)))} is not among those that {stage} measured"
                raise NotRun(what, stage, runnable=False)
        return frame

    def measured(self, stage, **where):
        """As `measurements`, only the rows that have a value; NotRun where there is none."""
        frame = self.measurements(stage, **where).dropna(subset=["value"])
        if frame.empty:
            notes = self.notes(stage, **where) or [f"{stage} has rows of this, but no value"]
            raise NotRun("; ".join(notes[:2]), stage, runnable=False)
        return frame

    def notes(self, stage, **where):
        """Why rows of a stage have no value, each reason once; an empty cell of a row stands for whatever is wanted."""
        frame = self._read(stage)
        if "note" not in frame or "value" not in frame:
            return []
        frame = frame[frame["value"].isna() & frame["note"].notna()]
        for column, wanted in where.items():
            if column in frame:
                frame = frame[frame[column].isin(_listed(wanted)) | frame[column].isna()]
        return list(dict.fromkeys(frame["note"]))

    def attention(self, name):
        """Rows of reports/attention/NAME.csv: measured once, on the meshes with human gaze."""
        why = f"no attention/{name}.csv: `make gaze` measures it where the meshes with gaze are"
        return self._once(self.reports / "attention" / f"{name}.csv", why, "gaze")

    def simplification(self, data):
        """Rows of reports/simplification/DATA.csv: the lod stage's, measured once on another data set."""
        why = f"no simplification/{data}.csv: `make detectors` measures it where the meshes of {data} are"
        return self._once(self.reports / "simplification" / f"{data}.csv", why, "lod")

    def bench(self, name):
        """Rows of reports/bench/NAME.csv: what `make bench` measured; times are ratios to a named peer."""
        return self._once(self.reports / "bench" / f"{name}.csv", f"no bench/{name}.csv: `make bench` writes it", "lod")

    def touch(self, name):
        """Rows of reports/touch/NAME.csv: measured once, on recorded touches or on another data set."""
        why = f"no touch/{name}.csv: `make touch` measures it where those data are"
        return self._once(self.reports / "touch" / f"{name}.csv", why, "classification")

    def transfer(self, name):
        """Rows of reports/transfer/NAME.csv: networks, measured once on recorded touches or on another data set."""
        why = f"no transfer/{name}.csv: `make transfer` measures it where those data are"
        return self._once(self.reports / "transfer" / f"{name}.csv", why, "transfer")

    def instead(self, stage, rows):
        """These results with other rows of one stage, such as those measured once on another data set.

        rows: a frame with the columns of that stage's measurements. Side tables and data/ stay this run's.
        """
        other = copy.copy(self)
        other._tables = self._tables | {stage: rows}
        return other

    def fixation(self, name):
        """Rows of reports/fixation/NAME.csv: where networks look, measured once on the meshes with human gaze."""
        why = f"no fixation/{name}.csv: `make fixation` measures it where the meshes with gaze are"
        return self._once(self.reports / "fixation" / f"{name}.csv", why, "fixation")

    def _once(self, path, why, stage):
        """A table that no stage of this run writes; NotRun with `why` where it is absent."""
        if path not in self._tables:
            if not path.exists():
                raise NotRun(why, stage, runnable=False)
            self._tables[path] = read_table(path)
        return self._tables[path]

    def classes(self, name):
        """How many objects a set of the classification held."""
        paths = sorted((self.data / "classification").glob(f"{name}.*.npz"))
        if not paths:
            raise NotRun(f"no {name}.*.npz in data/classification", "classification")
        return len(read_arrays(paths[0])["objects"])

    def set_text(self, name):
        """A set in words: "six objects", or "4 objects (set six)" where the name does not tell the number."""
        count = self.classes(name)
        return f"{name} objects" if count == NUMBERS.get(name) else f"{count} objects (set {name})"

    def _read(self, stage):
        path = self.reports / "measurements" / f"{stage}.csv"
        if stage not in self._tables:
            if not path.exists():
                raise NotRun(f"no measurements/{path.name}", stage)
            self._tables[stage] = read_table(path)
        return self._tables[stage]

    @property
    def measured_stages(self):
        """Names of the stages that have measurements, in alphabetical order."""
        return sorted(path.stem for path in (self.reports / "measurements").glob("*.csv"))

    def thesis(self, name):
        """One of the thesis's own tables, data/reference/thesis/NAME.csv."""
        path = self.data / "reference/thesis" / f"{name}.csv"
        if not path.exists():
            raise FileNotFoundError(f"{path} is part of the repository: restore it with `git checkout {path}`")
        return read_table(path)

    def table(self, stage, name):
        """A side table of a stage, data/STAGE/NAME."""
        path = self.data / stage / name
        if not path.exists():
            raise NotRun(f"no {stage}/{name}", stage)
        return pd.read_csv(path)

    @cached_property
    def objects(self):
        """Names of all objects with a mesh, in alphabetical order."""
        names = sorted(path.stem for path in (self.data / "meshes").glob("*.npz"))
        if not names:
            raise NotRun("no meshes", "meshes")
        return names

    def choose(self, preferred, count, stage="salient_points"):
        """Up to `count` objects that `stage` has data for: the preferred ones first, then by the alphabet."""
        folder = self.data / stage
        ready = [name for name in self.objects if (folder / f"{name}.npz").exists() or (folder / name).is_dir()]
        if not ready:
            raise NotRun(f"no data/{stage}", stage)
        first = [name for name in preferred if name in ready]
        return (first + [name for name in ready if name not in first])[:count]

    def mesh(self, name):
        """The original mesh of an object."""
        return read_mesh(self._path("meshes", name))

    def points(self, name):
        """dict method -> (k,) vertex ids, most salient first."""
        return ByMethod("salient_points", read_points(self._path("salient_points", name)))

    def strong_points(self, name):
        """dict method -> (k',) vertex ids, the leading points that the simplification keeps."""
        return ByMethod("salient_points", read_strong_points(self._path("salient_points", name)))

    def saliency(self, name):
        """dict method -> (n,) saliency in 0..1 a vertex."""
        return ByMethod("salient_points", read_saliency(self._path("salient_points", name)))

    def imprints(self, name):
        """dict method -> (k, rows, cols) imprints in 0..1."""
        found = read_imprints(self._path("imprints", name))
        return ByMethod("imprints", {method: touches.images for method, touches in found.items()})

    def maps(self, name, wanted=None):
        """(maps (v, channels, h, w) f4, mask (v, h, w) boolean, viewpoints, channels) of an object.

        wanted: the channels, in this order; NotRun where one was not computed. None: those that were.
        """
        maps, mask, viewpoints, stored = read_maps(self._path("conspicuity", name))
        if wanted is None:
            return maps, mask, viewpoints, stored
        missing = [channel for channel in wanted if channel not in stored]
        if missing:
            raise NotRun(f"no maps of {', '.join(missing)}", "conspicuity", runnable=False)
        return maps[:, [stored.index(channel) for channel in wanted]], mask, viewpoints, list(wanted)

    def lesson(self, name):
        """Arrays of data/weights/lessons/NAME.npz: density, points and more (stages.weights.lessons)."""
        path = self.data / "weights/lessons" / f"{name}.npz"
        if not path.exists():
            raise NotRun(f"no weights/lessons/{name}.npz: no ground truth of {name}, or not run", "weights")
        return read_arrays(path)

    def learned(self, name, mesh):
        """What the weights stage learned, as it may be applied to this object: a stages.weights.Learned."""
        if not (self.data / "weights/weights.csv").exists():
            raise NotRun("no weights/weights.csv", "weights")
        return learned_for(self.data / "weights", name, mesh)

    def taught(self, preferred, count):
        """Up to `count` objects that have ground truth and salient points: the preferred ones first."""
        lessons = sorted(path.stem for path in (self.data / "weights/lessons").glob("*.npz"))
        if not lessons:
            raise NotRun("no object has ground truth", "weights")
        ready = set(lessons)
        found = [name for name in self.choose(preferred, len(self.objects)) if name in ready]
        if not found:
            raise NotRun("no object with ground truth has salient points", "salient_points")
        return found[:count]

    def lods(self, name, method):
        """Simplified meshes of one method, most faces first: list of (target, Mesh)."""
        paths = (self.data / "lod" / name).glob(f"{method}_*.npz")
        found = [(path.stem.removeprefix(f"{method}_").replace("pct", "%"), read_mesh(path)) for path in paths]
        if not found:
            raise NotRun(f"no data/lod/{name}/{method}_*.npz", "lod")
        return sorted(found, key=lambda item: (-len(item[1].faces), item[0]))

    def _path(self, stage, name):
        path = self.data / stage / f"{name}.npz"
        if not path.exists():
            raise NotRun(f"no {path.name} in data/{stage}", stage)
        return path


def _listed(wanted):
    return wanted if isinstance(wanted, list) else [wanted]
